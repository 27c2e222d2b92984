"""What each action unit looks like on a rig: its settled field at steps of intensity, by side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..assembly import Assembly, compile_rig
from ..cache import Arrays, cached_arrays, content_key
from ..rig import Model, Rig
from ..settling import Progress, settled
from ..sources import ENGINE_HASH
from ..timeline import Keyframe

STEPS = (0.5, 1.0)
"""Intensities at which each unit is settled; between them its field is interpolated."""
SETTLE_SECONDS = 0.75
FADE = 0.1
ARRIVED_MM = 0.02
"""Motion in a tick under which a unit has settled: what is left of its way is 0.1 mm at most."""
STILL_MM = 0.3
"""A unit that moves no point farther than this at full intensity cannot be measured."""


@dataclass(frozen=True, eq=False)
class UnitBasis:
    """Displacement fields of the units that move a rig's tissue.

    Attributes:
        units: Their names.
        fields: Displacement of the sheet at each of `STEPS`, mm, shape (steps, units, n, 3).
        left, right: The same of one side alone; zeros for units that have no sides.
        one_sided: Which units act on one side only (AU46), the left one in `fields`, (units,).
    """

    units: tuple[str, ...]
    fields: FloatArray
    left: FloatArray
    right: FloatArray
    one_sided: BoolArray


def per_intensity(steps: FloatArray, intensity: float) -> FloatArray:
    """Return a unit's field at an intensity over that intensity, mm, shape (n, 3).

    Beyond the steps it goes on as it is at the nearest one.

    Args:
        steps: Its field at each of `STEPS`, mm, shape (steps, n, 3).
        intensity: 0..1.
    """
    shares = [field / step for field, step in zip(steps, STEPS, strict=True)]
    if intensity <= STEPS[0]:
        return np.asarray(shares[0])
    for index in range(1, len(STEPS)):
        if intensity <= STEPS[index]:
            share = (intensity - STEPS[index - 1]) / (STEPS[index] - STEPS[index - 1])
            return np.asarray(shares[index - 1] + share * (shares[index] - shares[index - 1]))
    return np.asarray(shares[-1])


def unit_basis(
    rig: Rig,
    model: Model | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> UnitBasis:
    """Return the fields of every unit of `rig` that moves its tissue.

    Kept on disk under the rig's id: it takes as long as some hundred faces take to settle. Where
    the two sides of the face are alike, the right one is the left one's mirror image.

    Args:
        rig: Whose units.
        model: Forms of the physics; the rig's own, as live faces run them, if None.
        threads: Faces stepped at a time; None takes one a core.
        progress: Told the share of the work done, 0 to 1; may raise to stop it.
    """
    names, model = _moving_tissue(rig), model or rig.model.live
    key = content_key(rig.id, model, STEPS, SETTLE_SECONDS, ARRIVED_MM, ENGINE_HASH)
    arrays = cached_arrays("unit-fields", key, lambda: _settled(rig, model, threads, progress))
    fields, left, right = (arrays[name].astype(np.float64) for name in ("fields", "left", "right"))
    moving = np.linalg.norm(fields[-1], axis=2).max(axis=1) > STILL_MM
    units = tuple(name for name, moves in zip(names, moving, strict=True) if moves)
    one_sided = np.array([rig.action_units[name].one_sided for name in units], dtype=bool)
    return UnitBasis(units, fields[:, moving], left[:, moving], right[:, moving], one_sided)


def _settled(rig: Rig, model: Model, threads: int | None, progress: Progress | None) -> Arrays:
    """Return each unit's field at each step, and of its sides, settled side by side."""
    names = _moving_tissue(rig)
    mirror = _mirror(compile_rig(rig, model))
    sided = [name for name in names if _has_sides(rig, name)]
    sides = "L" if mirror is not None else "LR"
    faces = [(name, step) for step in STEPS for name in names]
    faces += [
        (f"{side}{name.removeprefix('AU')}", step)
        for step in STEPS
        for side in sides
        for name in sided
    ]
    frames = settled(
        rig,
        [Keyframe(action_units={key: step}, fade=FADE) for key, step in faces],
        SETTLE_SECONDS,
        model=model,
        threads=threads,
        still_mm=ARRIVED_MM,
        progress=progress,
    )
    n, many = rig.head.sheet_count, len(names)
    ends = [frame.displacements[:n] for frame in frames]
    half = {side: np.zeros((len(STEPS), many, n, 3)) for side in "LR"}
    for (key, step), end in list(zip(faces, ends, strict=True))[len(STEPS) * many :]:
        half[key[0]][STEPS.index(step), names.index(f"AU{key[1:]}")] = end
    if mirror is not None:
        half["R"] = half["L"][:, :, mirror] * np.array([-1.0, 1.0, 1.0])
    both = np.array(ends[: len(STEPS) * many]).reshape(len(STEPS), many, n, 3)
    return {"fields": both, "left": half["L"], "right": half["R"]}


def _moving_tissue(rig: Rig) -> tuple[str, ...]:
    """Return the units that have muscles or move the jaw: not those of gaze, head and tongue."""
    return tuple(
        name
        for name, unit in rig.action_units.items()
        if unit.muscles or any(place.startswith("jaw.") for place in unit.pose)
    )


def _has_sides(rig: Rig, name: str) -> bool:
    """Return whether a unit has a muscle on either side, and a name that takes one."""
    stems = rig.action_units[name].muscles
    paired = any(f"{stem}.L" in rig.muscle_names for stem in stems)
    return paired and name.removeprefix("AU").isdigit()


def _mirror(assembly: Assembly) -> IntArray | None:
    """Return each node's mirror image, if the two sides of the face are made alike."""
    rig, n = assembly.rig, assembly.tissue.node_count
    mirror = rig.head.mirror[:n]
    if (mirror < 0).any():
        return None
    stacked = np.concatenate([mirror + layer * n for layer in range(3)])
    flip = np.array([[-1.0], [1.0], [1.0]])
    arrays = assembly.tissue.arrays
    names = rig.muscle_names
    other = [names.index(_other_side(name)) for name in names if _other_side(name) in names]
    if len(other) != len(names):
        return None
    alike = (
        (arrays.rest[:, stacked] * flip, arrays.rest),
        (arrays.inverse_mass[stacked], arrays.inverse_mass),
        (arrays.anchors.tangential[mirror], arrays.anchors.tangential),
        (assembly.basis[other][:, :, mirror] * flip, assembly.basis),
    )
    same = all(np.allclose(one, two, rtol=1e-6, atol=1e-6) for one, two in alike)
    angles = assembly.lid_angles
    return mirror if same and np.allclose(angles[other][:, ::-1], angles) else None


def _other_side(name: str) -> str:
    stem, _, side = name.partition(".")
    return f"{stem}.{'R' if side == 'L' else 'L'}" if side else name
