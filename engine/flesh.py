"""How flesh bears an expression: elements turned over, volume, folds, stillness, and its past."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from .arrays import FloatArray, IntArray
from .cover import showing
from .quality import asymmetry, folded_triangles, roughness, visible_triangles
from .rig import Model, Rig
from .simulator import Simulator
from .timeline import TICKS_PER_SECOND, Keyframe
from .tissue.layers import Sheet, prism_volumes, sheet_of

MIX_UNITS = (2, 6)
"""Fewest action units of a random mix, and one more than the most."""
MIX_INTENSITY = (0.2, 1.0)
RIGID_REGIONS = ("gaze", "head")
"""Groups of action units that move no tissue."""
HISTORY_SECONDS = 0.6
"""How long a random expression is held before the one that is looked at."""


@dataclass(frozen=True)
class Flesh:
    """Figures of one expression, a second after a step from rest.

    Attributes:
        inverted: Elements between two layers whose signed volume is 0 or less.
        least_share: Least volume of an element as a share of its volume at rest.
        volume: Change of the volume between epidermis and hypodermis, as a share.
        regions: The same by region of the skin.
        folds: Visible triangles of the drawn skin turned by more than 90 degrees, by region.
        roughness: rms of u minus its one-ring mean over rms u, over the tissue's nodes.
        drawn_roughness: The same over the visible vertices of the drawn skin.
        asymmetry: Greatest difference of left and right, mm.
        speed: Greatest speed of a node over the last tick, mm/s.
        through: Vertices of teeth, gums, tongue and eyeballs that stand before the skin, by part.
    """

    inverted: int
    least_share: float
    volume: float
    regions: Mapping[str, float]
    folds: Mapping[str, int]
    roughness: float
    drawn_roughness: float
    asymmetry: float
    speed: float
    through: Mapping[str, int]


def random_mixes(rig: Rig, count: int, seed: int) -> list[Keyframe]:
    """Return `count` mixes of two to five action units that move tissue, at intensities 0.2-1."""
    rng = np.random.default_rng(seed)
    names = [n for n, unit in rig.action_units.items() if unit.region not in RIGID_REGIONS]
    mixes = []
    for _ in range(count):
        chosen = rng.choice(len(names), size=rng.integers(*MIX_UNITS), replace=False)
        units = {names[i]: float(rng.uniform(*MIX_INTENSITY)) for i in chosen}
        mixes.append(Keyframe(action_units=units))
    return mixes


def examine(
    rig: Rig,
    keyframes: Sequence[Keyframe],
    *,
    seconds: float = 1.0,
    model: Model | None = None,
) -> list[Flesh]:
    """Return the figures of each expression; all faces run side by side.

    Args:
        rig: Whose faces.
        keyframes: One a face, applied to the face at rest.
        seconds: After which they are looked at.
        model: Forms of the physics; the rig's own if None.
    """
    simulator = Simulator(rig, model=model)
    names = [str(index) for index in range(len(keyframes))]
    for name, keyframe in zip(names, keyframes, strict=True):
        simulator.add(name)
        simulator.apply(name, keyframe)
    for _ in range(round(seconds * TICKS_PER_SECOND) - 1):
        simulator.step()
    # What two contacts hold between them has a velocity that they take away every substep: how
    # fast a node is, is how far it goes.
    earlier = {name: simulator.snapshot(name).x for name in names}
    simulator.step()
    sheet, smooth = sheet_of(rig.head), _ring_mean(rig)
    rest = simulator.assembly.tissue.arrays.rest
    regions = _element_regions(sheet)
    result = []
    for name in names:
        snapshot = simulator.snapshot(name)
        displacements = snapshot.frame.displacements
        before, after = element_volumes(rest, sheet), element_volumes(snapshot.x, sheet)
        change = after.sum(axis=0) - before.sum(axis=0)
        result.append(
            Flesh(
                inverted=int((after <= 0.0).sum()),
                least_share=float((after / before).min()),
                volume=float(change.sum() / before.sum()),
                regions={
                    region: float(change[of].sum() / before[:, of].sum())
                    for region, of in regions.items()
                },
                folds=_folds(rig, displacements),
                roughness=roughness(rig, displacements),
                drawn_roughness=_drawn_roughness(rig, displacements, smooth),
                asymmetry=asymmetry(rig, displacements),
                speed=float(np.linalg.norm(snapshot.x - earlier[name], axis=0).max())
                * TICKS_PER_SECOND,
                through=showing(rig, snapshot.frame),
            )
        )
    return result


def path_dependence(
    rig: Rig,
    keyframes: Sequence[Keyframe],
    *,
    histories: int = 10,
    seed: int = 1,
    model: Model | None = None,
) -> list[float]:
    """Return how far each expression's rest depends on what went before, mm.

    Each is taken up once from rest and once from each of `histories` random mixes; the figure is
    the greatest distance of any point from where the face that came from rest has it. `model` is as
    for `examine`.
    """
    pasts = [None, *random_mixes(rig, histories, seed)]
    simulator = Simulator(rig, model=model)
    for index in range(len(keyframes)):
        for number, past in enumerate(pasts):
            name = f"{index} {number}"
            simulator.add(name)
            if past is not None:
                simulator.apply(name, past)
    for _ in range(round(HISTORY_SECONDS * TICKS_PER_SECOND)):
        simulator.step()
    for index, keyframe in enumerate(keyframes):
        taken = Keyframe(
            action_units=keyframe.action_units, emotion=keyframe.emotion, fade=0.2, replace=True
        )
        for number in range(len(pasts)):
            simulator.apply(f"{index} {number}", taken)
    for _ in range(round(1.6 * TICKS_PER_SECOND)):
        simulator.step()
    result = []
    for index in range(len(keyframes)):
        ends = [simulator.frame(f"{index} {n}").displacements for n in range(len(pasts))]
        result.append(max(float(np.linalg.norm(end - ends[0], axis=1).max()) for end in ends))
    return result


def jolts(
    rig: Rig,
    keyframes: Sequence[Keyframe],
    *,
    seconds: float = 2.0,
    model: Model | None = None,
) -> list[float]:
    """Return how abruptly each expression moves while it is taken up and let go slowly, mm a tick.

    The figure is the greatest change of any visible point's step from one tick to the next:
    contact that sets in or lets go with a pop shows there, a smooth motion does not. `model` is as
    for `examine`.
    """
    simulator = Simulator(rig, model=model)
    names = [str(index) for index in range(len(keyframes))]
    moves = [
        [replace(keyframe, fade=seconds) for keyframe in keyframes],
        [Keyframe(fade=seconds, replace=True)] * len(keyframes),
    ]
    worst = np.zeros(len(names))
    seen = _seen(rig)
    for name in names:
        simulator.add(name)
    places = [[simulator.frame(name).displacements] * 2 for name in names]
    for move in moves:
        for name, keyframe in zip(names, move, strict=True):
            simulator.apply(name, keyframe)
        for _ in range(round((seconds + 0.2) * TICKS_PER_SECOND)):
            simulator.step()
            for index, name in enumerate(names):
                now = simulator.frame(name).displacements
                before, last = places[index]
                change = np.linalg.norm((now - 2.0 * last + before)[seen], axis=1).max()
                worst[index] = max(worst[index], float(change))
                places[index] = [last, now]
    return [float(value) for value in worst]


def _seen(rig: Rig) -> IntArray:
    """Return the tissue points that are not only of the inner side of a lip, shape (k,)."""
    head = rig.head
    outside = np.array(["inner" not in region for region in head.polygon_regions])
    return np.unique(head.polygons[outside][head.polygons[outside] >= 0])


def element_volumes(x: FloatArray, sheet: Sheet) -> FloatArray:
    """Return the signed volume of the elements above and below the dermis, mm³, shape (2, e).

    Args:
        x: Node positions, mm, shape (3, nodes).
        sheet: The tissue's surface.
    """
    stack = np.ascontiguousarray(x.T).reshape(3, -1, 3)
    return np.stack([prism_volumes(stack[k], stack[k + 1], sheet.elements) for k in range(2)])


def _element_regions(sheet: Sheet) -> dict[str, IntArray]:
    """Return the elements of each region of the sheet, by the polygon they are a part of."""
    owner: dict[frozenset[int], str] = {}
    for polygon, region in zip(sheet.polygons, sheet.polygon_regions, strict=True):
        corners = [int(corner) for corner in polygon if corner >= 0]
        for left_out in range(len(corners) if len(corners) == 4 else 1):
            kept = corners if len(corners) == 3 else corners[:left_out] + corners[left_out + 1 :]
            owner[frozenset(kept)] = region
    found: dict[str, list[int]] = {}
    for index, element in enumerate(sheet.elements):
        region = owner[frozenset(int(corner) for corner in element)]
        found.setdefault(region, []).append(index)
    return {region: np.array(of) for region, of in sorted(found.items())}


def _folds(rig: Rig, displacements: FloatArray) -> dict[str, int]:
    drawn = rig.head.drawn
    corner = drawn.triangles[folded_triangles(rig, displacements), 0]
    return dict(Counter(drawn.region_names[region] for region in drawn.regions[corner]))


def _ring_mean(rig: Rig) -> sp.csr_array:
    """Return the mean over each visible drawn vertex's neighbours, sparse (d, d)."""
    drawn = rig.head.drawn
    seams = np.arange(len(drawn.vertices)) if drawn.seams is None else drawn.seams
    triangles = seams[drawn.triangles[visible_triangles(rig)]]
    ends = np.concatenate([triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    ends = np.unique(np.concatenate([ends, ends[:, ::-1]]), axis=0)
    count = len(seams)
    ring = sp.csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
    degree: FloatArray = np.asarray(ring.sum(axis=1)).ravel()
    return sp.csr_array(sp.diags_array(1.0 / np.maximum(degree, 1.0)) @ ring)


def _drawn_roughness(rig: Rig, displacements: FloatArray, mean: sp.csr_array) -> float:
    drawn = rig.head.drawn
    u = drawn.deform(displacements, rig.head.eyes) - drawn.vertices
    inside = np.diff(mean.indptr) > 0
    bend = (u - mean @ u)[inside]
    size = float((u[inside] ** 2).sum())
    return float(np.sqrt((bend**2).sum() / size)) if size > 0.0 else 0.0
