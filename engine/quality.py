"""How well the tissue behaves: folds, roughness, symmetry, stillness, settling, path dependence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .channels import JAW, LIMITS
from .frame import Frame
from .rig import MAX_ACTIVATION, Rig
from .settling import settled
from .simulator import Simulator
from .timeline import TICKS_PER_SECOND, Keyframe
from .tissue.layers import sheet_of

HIDDEN_REGIONS = (
    "scalp",
    "neck",
    "nostril",
    "mouth_inner",
    "lid_inner",
    "lid_margin",
    "lip_inner",
    "columella",
)
"""Skin that is folded at rest or cannot be seen; left out of the count of folds."""
SETTLED = 0.05
"""A landmark has settled when it stays within this share of its way."""
UNMOVED_MM = 1e-3
"""A face of which no point has gone farther has not moved: numbers of 32 bits round to less."""


@dataclass(frozen=True)
class Quality:
    """Figures of one expression, a second after a step from rest.

    Attributes:
        folded: Triangles of the drawn skin turned by more than 90 degrees.
        roughness: rms of u minus its one-ring mean over rms u, epidermis.
        asymmetry: Greatest difference of left and right, mm.
        residual_speed: Greatest speed of a node of the epidermis, mm/s.
        settling: Time until every node of the epidermis stays within 0.3 mm of its end, s.
        settling_share: Time until the node that moves farthest stays within 5 % of its way, s.
        path: Greatest difference, mm, between this history and one that overshoots.
    """

    folded: int
    roughness: float
    asymmetry: float
    residual_speed: float
    settling: float
    settling_share: float
    path: float


def visible_triangles(rig: Rig) -> BoolArray:
    """Return which triangles of the drawn skin can be seen, shape (t,)."""
    drawn = rig.head.drawn
    hidden = np.array([any(h in name for h in HIDDEN_REGIONS) for name in drawn.region_names])
    return np.asarray(~hidden[drawn.regions][drawn.triangles].any(axis=1))


def folded_triangles(rig: Rig, displacements: FloatArray) -> IntArray:
    """Return the visible triangles whose normal turned by more than 90 degrees, shape (k,)."""
    drawn = rig.head.drawn
    moved = drawn.deform(displacements, rig.head.eyes)
    turned = (_normals(drawn.vertices, drawn.triangles) * _normals(moved, drawn.triangles)).sum(1)
    return np.flatnonzero((turned < 0.0) & visible_triangles(rig))


def roughness(rig: Rig, displacements: FloatArray) -> float:
    """Return rms of u minus its one-ring mean over rms u, area-weighted, over free nodes."""
    sheet = sheet_of(rig.head)
    u = displacements[: rig.head.sheet_count]
    weight = sheet.node_area * ~rig.head.fixed
    bend = sheet.neighbor_mean @ u - u
    if np.abs(u).max() < UNMOVED_MM:
        return 0.0
    size = float((weight * (u**2).sum(1)).sum())
    return float(np.sqrt((weight * (bend**2).sum(1)).sum() / size)) if size > 0.0 else 0.0


def asymmetry(rig: Rig, displacements: FloatArray) -> float:
    """Return the greatest difference between a point's motion and its mirror image's, mm."""
    mirror = rig.head.mirror
    paired = mirror >= 0
    other = displacements[np.where(paired, mirror, 0)] * np.array([-1.0, 1.0, 1.0])
    return float(np.abs((displacements - other)[paired]).max())


def judge(rig: Rig, keyframes: Sequence[Keyframe]) -> list[Quality]:
    """Return the figures of each expression; all faces run side by side, as live ones do."""
    straight = _histories(rig, keyframes)
    overshot = _ends(rig, keyframes, overshoot=1.6)
    slow = _ends(rig, keyframes, overshoot=None)
    result = []
    for (history, speed), over, late in zip(straight, overshot, slow, strict=True):
        end = history[-1]
        result.append(
            Quality(
                folded=len(folded_triangles(rig, end)),
                roughness=roughness(rig, end),
                asymmetry=asymmetry(rig, end),
                residual_speed=speed,
                settling=_settling(np.linalg.norm(history - end, axis=2).max(1) > 0.3),
                settling_share=_settling_share(history),
                path=float(np.linalg.norm(over - late, axis=1).max()),
            )
        )
    return result


def _histories(rig: Rig, keyframes: Sequence[Keyframe]) -> list[tuple[FloatArray, float]]:
    """Return every face's displacements over a second, (60, s, 3), and its last top speed."""
    history: list[list[FloatArray]] = [[] for _ in keyframes]

    def remember(faces: Sequence[Frame]) -> None:
        for past, frame in zip(history, faces, strict=True):
            past.append(frame.displacements)

    settled(rig, keyframes, watch=remember)
    return [
        (
            np.array(past),
            float(np.linalg.norm(past[-1] - past[-2], axis=1).max()) * TICKS_PER_SECOND,
        )
        for past in history
    ]


def _ends(rig: Rig, keyframes: Sequence[Keyframe], *, overshoot: float | None) -> list[FloatArray]:
    """Return where each face rests after an overshoot, or after a slow ramp of a second."""
    simulator = Simulator(rig, model=rig.model.live)
    for index, keyframe in enumerate(keyframes):
        simulator.add(str(index))
        first = _scaled(rig, keyframe, overshoot or 1.0)
        simulator.apply(str(index), _timed(first, 0.05 if overshoot else 1.0))
    for tick in range(int(1.8 * TICKS_PER_SECOND)):
        if overshoot and tick == int(0.3 * TICKS_PER_SECOND):
            for index, keyframe in enumerate(keyframes):
                simulator.apply(str(index), _timed(_scaled(rig, keyframe, 1.0), 0.01))
        simulator.step()
    return [simulator.frame(str(i)).displacements for i in range(len(keyframes))]


def _scaled(rig: Rig, keyframe: Keyframe, factor: float) -> Keyframe:
    """Return the expression as raw muscles and jaw, times `factor`."""
    units = dict(keyframe.action_units)
    if keyframe.emotion is not None:
        label, intensity = keyframe.emotion
        units = {t.key: t.intensity * intensity for t in rig.resolve_emotion(label).terms}
    vector = rig.contraction(units) * factor
    muscles = {
        name: float(np.clip(value, -MAX_ACTIVATION, MAX_ACTIVATION))
        for name, value in zip(rig.muscle_names, vector, strict=False)
        if value != 0.0
    }
    jaw = {
        axis: float(np.clip(vector[rig.channels.index("jaw", axis)], *LIMITS["jaw", axis]))
        for axis in JAW
    }
    return Keyframe(muscles=muscles, jaw=jaw, replace=True)


def _timed(keyframe: Keyframe, fade: float) -> Keyframe:
    return Keyframe(muscles=keyframe.muscles, jaw=keyframe.jaw, fade=fade, replace=True)


def _settling(away: BoolArray) -> float:
    late = np.flatnonzero(away)
    return float(late[-1] + 1) / TICKS_PER_SECOND if len(late) else 0.0


def _settling_share(history: FloatArray) -> float:
    way = np.linalg.norm(history[-1], axis=1)
    farthest = int(way.argmax())
    if way[farthest] < UNMOVED_MM:
        return 0.0
    gap = np.linalg.norm(history[:, farthest] - history[-1, farthest], axis=1)
    return _settling(gap > SETTLED * way[farthest])


def _normals(vertices: FloatArray, triangles: IntArray) -> FloatArray:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a))
