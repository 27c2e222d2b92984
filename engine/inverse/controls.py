"""What the inverse may move: muscles or action units, and the jaw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..channels import JAW, LIMITS
from ..errors import InvalidValue, UnknownName
from ..held import unit_key
from ..muscle import AirPressure, LidMuscle, Muscle
from ..rig import MAX_ACTIVATION, Rig, least_activation
from ..timeline import Keyframe
from .response import JAW_SCALE, Response


@dataclass(frozen=True, eq=False)
class Controls:
    """What is searched: muscles or units, and the jaw, each in units of its own full scale.

    Attributes:
        rig: Whose.
        muscles: Names of muscles, or of none.
        units: Keys of units, or of none.
        jaw: Axes of the jaw.
        lower, upper: Bounds in full scales, shape (c,).
    """

    rig: Rig
    muscles: tuple[str, ...]
    units: tuple[str, ...]
    jaw: tuple[str, ...]
    lower: FloatArray
    upper: FloatArray

    def keyframe(self, values: FloatArray, fade: float) -> Keyframe:
        """Return the command of `values`, in full scales, shape (c,)."""
        m = len(self.muscles) + len(self.units)
        drive = {
            name: float(v) for name, v in zip((*self.muscles, *self.units), values, strict=False)
        }
        jaw = {
            axis: float(v) * JAW_SCALE[axis] for axis, v in zip(self.jaw, values[m:], strict=True)
        }
        if self.muscles:
            return Keyframe(muscles=drive, jaw=jaw, fade=fade, replace=True)
        return Keyframe(action_units=drive, jaw=jaw, fade=fade, replace=True)

    def fields(self, response: Response) -> FloatArray:
        """Return the surface's response to each control, mm a full scale, shape (c, s, 3)."""
        names, count = self.rig.muscle_names, len(self.rig.muscles)
        rows = [response.fields[names.index(name)] for name in self.muscles]
        for key in self.units:
            vector = self.rig.contraction({key: 0.5}) / 0.5
            rows.append(np.tensordot(vector[: count + len(JAW)], response.fields, axes=1))
        rows += [response.fields[count + JAW.index(axis)] * JAW_SCALE[axis] for axis in self.jaw]
        return np.array(rows)


def controls_of(
    rig: Rig, muscles: Sequence[str] | None, units: Sequence[str] | None, *, jaw: bool
) -> Controls:
    """Return what may be searched.

    Raises:
        UnknownName: For a muscle or unit that the rig does not have.
        InvalidValue: If both muscles and units are given, or nothing is left.
    """
    if muscles is not None and units is not None:
        raise InvalidValue("give muscles or action units to be used, not both")
    names: tuple[str, ...] = ()
    keys: tuple[str, ...] = ()
    if units is not None:
        keys = tuple(
            dict.fromkeys(unit_key(u.name, side) for u, side in map(rig.resolve_unit, units))
        )
    elif muscles is None:
        # Air is no muscle; it helps where it is named.
        names = tuple(m.name for m in rig.muscles if not isinstance(m, AirPressure))
    else:
        known = {name.partition(".")[0] for name in rig.muscle_names} | set(rig.muscle_names)
        for given in muscles:
            if given not in known:
                raise UnknownName("muscle", given, known)
        chosen = set(muscles)
        names = tuple(n for n in rig.muscle_names if {n, n.partition(".")[0]} & chosen)
    turned = {place for key in keys for place in rig.resolve_unit(key)[0].pose}
    axes = tuple(axis for axis in JAW if jaw and f"jaw.{axis}" not in turned)
    if not names and not keys and not axes:
        raise InvalidValue("no muscle, action unit or jaw may be used; nothing can move")
    bounds = [_bounds(rig.muscle(name)) for name in names]
    bounds += [(0.0, 1.0)] * len(keys)
    for axis in axes:
        low, high = LIMITS["jaw", axis]
        # Teeth that meet go no farther together.
        bounds.append(((0.0 if axis == "pitch" else low) / JAW_SCALE[axis], high / JAW_SCALE[axis]))
    lower, upper = np.array(bounds).T
    return Controls(rig, names, keys, axes, lower, upper)


def _bounds(muscle: Muscle) -> tuple[float, float]:
    """Return the least and greatest activation: lids relax, and turn no farther than closed."""
    if isinstance(muscle, LidMuscle):
        return -1.0, 1.0
    return max(least_activation(muscle), -1.0), MAX_ACTIVATION
