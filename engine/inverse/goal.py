"""Where landmarks are wanted: targets as arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import InvalidValue, UnknownName
from ..landmarks import named_point
from ..rig import Rig

FARTHEST_TARGET_MM = 80.0


@dataclass(frozen=True, eq=False)
class Goal:
    """Targets as arrays.

    Attributes:
        names: Of the landmarks, length t.
        points: Surface points, shape (t,).
        wanted: Displacements, mm; NaN where open, shape (t, 3).
        weights: Of each landmark, shape (t,).
    """

    names: tuple[str, ...]
    points: IntArray
    wanted: FloatArray
    weights: FloatArray

    @property
    def known(self) -> BoolArray:
        """Which axes were asked for, shape (t, 3)."""
        return np.asarray(~np.isnan(self.wanted))

    def residuals(self, displacements: FloatArray) -> FloatArray:
        """Return weighted misfits of the asked axes, mm, shape (k,), of a surface (s, 3)."""
        misfit = displacements[self.points] - self.wanted
        return np.asarray((np.sqrt(self.weights)[:, None] * misfit)[self.known])

    def slopes(self, fields: FloatArray) -> FloatArray:
        """Return weighted slopes, shape (k, c), of surface fields, shape (c, s, 3)."""
        picked = np.sqrt(self.weights)[:, None] * fields[:, self.points]
        return np.asarray(picked[:, self.known].T)


def goal_of(
    rig: Rig, targets: Mapping[str, Sequence[float | None]], weights: Mapping[str, float]
) -> Goal:
    """Return targets as arrays.

    Raises:
        UnknownName: For a landmark that the head does not have, or a weight without target.
        InvalidValue: For no targets, or numbers that cannot be.
    """
    if not targets:
        raise InvalidValue("targets are empty; expected displacements by landmark, mm")
    for name in weights:
        if name not in targets:
            raise UnknownName("target", name, targets)
    wanted = []
    for name, place in targets.items():
        if len(place) != 3:
            raise InvalidValue(f"target {name} has {len(place)} entries; expected x, y and z, mm")
        for value in place:
            if value is not None:
                check_number(f"target {name}", value, -FARTHEST_TARGET_MM, FARTHEST_TARGET_MM)
        wanted.append([math.nan if value is None else float(value) for value in place])
    for name, weight in weights.items():
        check_number(f"weight of {name}", weight, 0.0, 1000.0)
    goal = Goal(
        names=tuple(targets),
        points=np.array([named_point(rig.head, name) for name in targets]),
        wanted=np.array(wanted),
        weights=np.array([float(weights.get(name, 1.0)) for name in targets]),
    )
    if not (goal.known & (goal.weights > 0.0)[:, None]).any():
        raise InvalidValue("no target has both an axis and a weight; nothing is asked for")
    return goal


def check_number(name: str, value: float, low: float, high: float) -> None:
    """Check that a number is one, and within its range.

    Raises:
        InvalidValue: If not.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InvalidValue(f"{name} is {value!r}; expected a finite number")
    if not low <= value <= high:
        raise InvalidValue(f"{name} is {value:g}; it must lie between {low:g} and {high:g}")
