"""How far each action unit moves its landmark, against what human faces do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray
from .rig import Model, Rig
from .simulator import Simulator
from .timeline import TICKS_PER_SECOND, Keyframe

INNER_BROW, OUTER_BROW = "E4_2.L", "E4_6.L"
UPPER_LID, LOWER_LID = "E1_4.L", "E1_12.L"
CHEEK, ALA, CHIN = "C5_2.L", "A7.L", "C4_10"
CORNER = "M1_5.L"
UPPER_LIP, LOWER_LIP = "M1_1.L", "M1_9.L"
LIP_TOP, LIP_BOTTOM = "M0_0", "M0_10"


@dataclass(frozen=True)
class Landmark:
    """One figure of one action unit.

    Attributes:
        unit: "AU12".
        what: What is measured, in words.
        low, high: Range of human motion at full intensity, mm; our estimates.
        measure: From rest points and displacements of the surface, both by name, to mm; positive
            in the unit's direction.
        calibrates: Whether the unit's curve is fitted to this figure.
        full: Figure at intensity 1 that it is fitted to; None leaves the choice of a place in the
            range to the calibration.
    """

    unit: str
    what: str
    low: float
    high: float
    measure: Callable[[Face], float]
    calibrates: bool = True
    full: float | None = None


@dataclass(frozen=True)
class Measured:
    """A landmark's figure on one face, mm."""

    landmark: Landmark
    value: float

    @property
    def direction_right(self) -> bool:
        """Whether it moved the way it should; a gap that must close counts when it narrows."""
        return self.value > 0.0 or self.landmark.low <= self.value <= self.landmark.high

    @property
    def in_range(self) -> bool:
        """Whether it lies within the human range."""
        return self.landmark.low <= self.value <= self.landmark.high


@dataclass(frozen=True, eq=False)
class Face:
    """A displaced surface, asked by point name."""

    rig: Rig
    displacements: FloatArray

    def u(self, name: str) -> FloatArray:
        """Return the displacement of a point, mm, shape (3,)."""
        return np.asarray(self.displacements[self.rig.head.point(name)])

    def at(self, name: str) -> FloatArray:
        """Return the place of a point, mm, shape (3,)."""
        return np.asarray(self.rig.head.points[self.rig.head.point(name)] + self.u(name))

    def gap(self, above: str, below: str) -> float:
        """Return the height of one point over another, mm."""
        return float(self.at(above)[1] - self.at(below)[1])

    def distance(self, one: str, other: str) -> float:
        """Return the distance of two points, mm."""
        return float(np.linalg.norm(self.at(one) - self.at(other)))

    def opening(self, above: str, below: str) -> float:
        """Return by how much the gap of two points grew, mm."""
        rest = Face(self.rig, np.zeros_like(self.displacements))
        return self.gap(above, below) - rest.gap(above, below)

    def towards(self, name: str, *direction: float) -> float:
        """Return the length of a point's motion, negative if it goes against `direction`."""
        u = self.u(name)
        return float(np.copysign(np.linalg.norm(u), u @ np.array(direction)))


LANDMARKS: tuple[Landmark, ...] = (
    Landmark("AU1", "inner brow up", 5, 8, lambda f: float(f.u(INNER_BROW)[1])),
    Landmark("AU2", "outer brow up", 5, 8, lambda f: float(f.u(OUTER_BROW)[1])),
    Landmark("AU4", "inner brow down", 4, 5, lambda f: -float(f.u(INNER_BROW)[1])),
    Landmark("AU4", "inner brow medial", 2, 3, lambda f: -float(f.u(INNER_BROW)[0]), False),
    Landmark("AU5", "upper lid up", 2, 3, lambda f: float(f.u(UPPER_LID)[1])),
    Landmark("AU6", "cheek up", 3, 5, lambda f: float(f.u(CHEEK)[1])),
    Landmark("AU6", "fissure narrows", 2, 3, lambda f: -f.opening(UPPER_LID, LOWER_LID), False),
    Landmark("AU7", "lower lid up", 1.5, 2.5, lambda f: float(f.u(LOWER_LID)[1])),
    Landmark("AU9", "ala up", 3, 5, lambda f: float(f.u(ALA)[1])),
    Landmark("AU10", "upper lip up", 5, 6, lambda f: float(f.u(UPPER_LIP)[1])),
    Landmark(
        "AU12",
        "corner up and out",
        8,
        12,
        lambda f: f.towards(CORNER, 0.5, 0.8, -0.3),
        full=11.0,
    ),
    Landmark("AU14", "corner in and back", 4, 6, lambda f: f.towards(CORNER, 0.0, 0.0, -1.0)),
    Landmark("AU15", "corner down", 6, 8, lambda f: -float(f.u(CORNER)[1])),
    Landmark("AU16", "lower lip down", 5, 7, lambda f: -float(f.u(LOWER_LIP)[1])),
    Landmark("AU17", "chin up", 4, 6, lambda f: float(f.u(CHIN)[1])),
    Landmark("AU18", "corners in", 5, 8, lambda f: -float(f.u(CORNER)[0]), full=5.1),
    Landmark("AU20", "corner back", 6, 8, lambda f: f.towards(CORNER, 0.7, 0.0, -0.7)),
    Landmark("AU23", "lips narrow", 1, 3, lambda f: -f.opening("M2_1.L", "M2_9.L")),
    Landmark("AU24", "lips pressed", 1, 3, lambda f: -f.opening("M2_1.L", "M2_9.L")),
    Landmark("AU25", "lip gap", 4, 6, lambda f: f.distance(LIP_TOP, LIP_BOTTOM)),
    Landmark("AU26", "lip gap", 15, 20, lambda f: f.distance(LIP_TOP, LIP_BOTTOM)),
    Landmark("AU27", "lip gap", 30, 36, lambda f: f.distance(LIP_TOP, LIP_BOTTOM), full=30.5),
    Landmark("AU43", "fissure left", -1, 0.1, lambda f: f.gap(UPPER_LID, LOWER_LID), False),
    Landmark("AU45", "fissure left", -1, 0.1, lambda f: f.gap(UPPER_LID, LOWER_LID), False),
)


def settle(
    rig: Rig, keyframes: Sequence[Keyframe], *, seconds: float = 1.0, model: Model | None = None
) -> list[Face]:
    """Return one face a keyframe, after `seconds` of simulation from rest."""
    simulator = Simulator(rig, model=model)
    for index, keyframe in enumerate(keyframes):
        simulator.add(str(index))
        simulator.apply(str(index), keyframe)
    for _ in range(round(seconds * TICKS_PER_SECOND)):
        simulator.step()
    return [Face(rig, simulator.frame(str(i)).displacements) for i in range(len(keyframes))]


def measure_units(rig: Rig, *, model: Model | None = None, seconds: float = 1.0) -> list[Measured]:
    """Return every landmark of the rig's action units at intensity 1, after `seconds`."""
    units = sorted({landmark.unit for landmark in LANDMARKS if landmark.unit in rig.action_units})
    keyframes = [Keyframe(action_units={unit: 1.0}) for unit in units]
    faces = settle(rig, keyframes, seconds=seconds, model=model)
    by_unit: Mapping[str, Face] = dict(zip(units, faces, strict=True))
    return [
        Measured(landmark, landmark.measure(by_unit[landmark.unit]))
        for landmark in LANDMARKS
        if landmark.unit in by_unit
    ]
