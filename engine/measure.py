"""How far each action unit moves its landmark, against what human faces do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from .arrays import FloatArray
from .frame import Pose
from .rig import Model, Rig
from .settling import settled
from .timeline import Keyframe

INNER_BROW, OUTER_BROW = "E4_2.L", "E4_6.L"
UPPER_LID, LOWER_LID = "E1_4.L", "E1_12.L"
CHEEK, ALA, CHIN = "C5_2.L", "A7.L", "C4_10"
CORNER = "M1_5.L"
UPPER_LIP, LOWER_LIP = "M1_1.L", "M1_9.L"
LIP_TOP, LIP_BOTTOM = "M0_0", "M0_10"
FURROW, HOLLOW = "M4_4.L", "C5_6.L"
OUT_OF_CHEEK = (0.75, 0.0, 0.66)
"""Outwards at the hollow of the cheek."""


@dataclass(frozen=True)
class Landmark:
    """One figure of one action unit.

    Attributes:
        unit: "AU12".
        what: What is measured, in words.
        low, high: Range of human motion at full intensity; our estimates.
        measure: From a face, its points asked by name, to the figure; positive in the unit's
            direction.
        calibrates: Whether the unit's curve is fitted to this figure.
        full: Figure at intensity 1 that it is fitted to; None leaves the choice of a place in the
            range to the calibration.
        scale: What the figures are in: "mm", or "°" for eyes and head.
    """

    unit: str
    what: str
    low: float
    high: float
    measure: Callable[[Face], float]
    calibrates: bool = True
    full: float | None = None
    scale: str = "mm"


@dataclass(frozen=True)
class Measured:
    """A landmark's figure on one face."""

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
    """A displaced surface, asked by point name, and its pose."""

    rig: Rig
    displacements: FloatArray
    pose: Pose = field(default_factory=Pose)

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

    def narrowing(self) -> float:
        """Return by how much the left eye's opening shrank, mm."""
        return -self.opening(UPPER_LID, LOWER_LID)

    def lips_forward(self) -> float:
        """Return how far the red of the lips moved forward at its middle, mm."""
        return float(self.u(UPPER_LIP)[2] + self.u(LOWER_LIP)[2]) / 2.0

    def along(self, name: str, *direction: float) -> float:
        """Return a point's motion along the unit vector `direction`, mm."""
        return float(self.u(name) @ np.array(direction))

    def towards(self, name: str, *direction: float) -> float:
        """Return the length of a point's motion, negative if it goes against `direction`."""
        u = self.u(name)
        return float(np.copysign(np.linalg.norm(u), u @ np.array(direction)))


def _turn(
    unit: str, what: str, low: float, high: float, angle: Callable[[Pose], float]
) -> Landmark:
    """Return the figure of a unit that turns head or eyes by an angle."""
    return Landmark(unit, what, low, high, lambda f: angle(f.pose), False, scale="°")


LANDMARKS: tuple[Landmark, ...] = (
    Landmark("AU1", "inner brow up", 5, 8, lambda f: float(f.u(INNER_BROW)[1]), full=7.0),
    Landmark("AU2", "outer brow up", 5, 8, lambda f: float(f.u(OUTER_BROW)[1]), full=7.0),
    Landmark("AU4", "inner brow down", 4, 5, lambda f: -float(f.u(INNER_BROW)[1]), full=4.5),
    Landmark("AU4", "inner brow medial", 2, 3, lambda f: -float(f.u(INNER_BROW)[0]), False),
    Landmark("AU5", "upper lid up", 2, 3, lambda f: float(f.u(UPPER_LID)[1])),
    Landmark("AU6", "cheek up", 3, 5, lambda f: float(f.u(CHEEK)[1])),
    Landmark("AU6", "fissure narrows", 2, 3, lambda f: f.narrowing(), False),
    Landmark("AU7", "lower lid up", 1.5, 2.5, lambda f: float(f.u(LOWER_LID)[1])),
    Landmark("AU9", "ala up", 3, 5, lambda f: float(f.u(ALA)[1]), full=4.3),
    Landmark("AU10", "upper lip up", 5, 6, lambda f: float(f.u(UPPER_LIP)[1])),
    Landmark("AU11", "furrow up and out", 2, 4, lambda f: f.towards(FURROW, 0.5, 0.8, 0.0)),
    Landmark(
        "AU12",
        "corner up and out",
        8,
        12,
        lambda f: f.towards(CORNER, 0.5, 0.8, -0.3),
        full=11.0,
    ),
    Landmark("AU13", "corner up", 4, 7, lambda f: float(f.u(CORNER)[1])),
    Landmark("AU14", "corner in and back", 4, 6, lambda f: f.towards(CORNER, 0.0, 0.0, -1.0)),
    Landmark("AU15", "corner down", 6, 8, lambda f: -float(f.u(CORNER)[1]), full=6.3),
    Landmark("AU16", "lower lip down", 5, 7, lambda f: -float(f.u(LOWER_LIP)[1]), full=6.2),
    Landmark("AU17", "chin up", 4, 6, lambda f: float(f.u(CHIN)[1]), full=5.1),
    Landmark("AU18", "corners in", 5, 8, lambda f: -float(f.u(CORNER)[0]), full=5.6),
    Landmark("AU19", "tongue out", 25, 45, lambda f: f.pose.tongue_thrust, False),
    Landmark("AU20", "corner back", 6, 8, lambda f: f.towards(CORNER, 0.7, 0.0, -0.7)),
    Landmark("AU22", "lips forward", 3, 6, lambda f: f.lips_forward()),
    Landmark("AU22", "lip gap", 4, 12, lambda f: f.distance(LIP_TOP, LIP_BOTTOM), False),
    Landmark("AU23", "lips narrow", 1, 3, lambda f: -f.opening("M2_1.L", "M2_9.L"), full=1.5),
    Landmark("AU23", "corners in", 0.5, 3, lambda f: -float(f.u(CORNER)[0]), False),
    Landmark("AU24", "lips pressed", 1, 3, lambda f: -f.opening("M2_1.L", "M2_9.L")),
    Landmark("AU25", "lip gap", 4, 6, lambda f: f.distance(LIP_TOP, LIP_BOTTOM)),
    Landmark("AU26", "lip gap", 15, 20, lambda f: f.distance(LIP_TOP, LIP_BOTTOM)),
    Landmark("AU27", "lip gap", 30, 36, lambda f: f.distance(LIP_TOP, LIP_BOTTOM), full=30.5),
    Landmark("AU28", "lips back", 3, 6, lambda f: -f.lips_forward(), full=4.6),
    Landmark("AU29", "chin forward", 4, 8, lambda f: float(f.u(CHIN)[2])),
    Landmark("AU30", "chin sideways", 6, 12, lambda f: float(f.u(CHIN)[0])),
    Landmark("AU33", "cheek out", 2, 8, lambda f: f.along(HOLLOW, *OUT_OF_CHEEK), full=4.5),
    Landmark("AU34", "cheek out", 6, 12, lambda f: f.along(HOLLOW, *OUT_OF_CHEEK)),
    Landmark("AU35", "cheek in", 1.5, 6, lambda f: -f.along(HOLLOW, *OUT_OF_CHEEK), full=4.2),
    Landmark("AU38", "ala out", 1, 2.5, lambda f: float(f.u(ALA)[0])),
    Landmark("AU39", "ala in", 0.8, 2, lambda f: -float(f.u(ALA)[0])),
    Landmark("AU41", "upper lid down", 3, 5, lambda f: -float(f.u(UPPER_LID)[1])),
    Landmark("AU42", "fissure narrows", 6, 8.5, lambda f: f.narrowing(), full=6.6),
    Landmark("AU43", "fissure left", -1, 0.1, lambda f: f.gap(UPPER_LID, LOWER_LID), False),
    Landmark("AU44", "fissure narrows", 5, 8, lambda f: f.narrowing()),
    Landmark("AU45", "fissure left", -1, 0.1, lambda f: f.gap(UPPER_LID, LOWER_LID), False),
    Landmark("AU46", "fissure left", -1, 0.1, lambda f: f.gap(UPPER_LID, LOWER_LID), False),
    _turn("AU51", "head to its left", 40, 80, lambda p: p.head[0]),
    _turn("AU52", "head to its right", 40, 80, lambda p: -p.head[0]),
    _turn("AU53", "head up", 25, 60, lambda p: p.head[1]),
    _turn("AU54", "head down", 25, 50, lambda p: -p.head[1]),
    _turn("AU55", "head to its left shoulder", 20, 45, lambda p: p.head[2]),
    _turn("AU56", "head to its right shoulder", 20, 45, lambda p: -p.head[2]),
    Landmark("AU57", "head forward", 20, 50, lambda f: f.pose.head_thrust, False),
    Landmark("AU58", "head back", 15, 35, lambda f: -f.pose.head_thrust, False),
    _turn("AU61", "eyes to its left", 25, 45, lambda p: min(p.gaze_left[0], p.gaze_right[0])),
    _turn("AU62", "eyes to its right", 25, 45, lambda p: -max(p.gaze_left[0], p.gaze_right[0])),
    _turn("AU63", "eyes up", 20, 35, lambda p: p.gaze_left[1]),
    _turn("AU64", "eyes down", 20, 45, lambda p: -p.gaze_left[1]),
    _turn("AU65", "eyes apart", 10, 30, lambda p: p.gaze_left[0] - p.gaze_right[0]),
    _turn("AU66", "eyes crossed", 30, 50, lambda p: p.gaze_right[0] - p.gaze_left[0]),
)


def settle(
    rig: Rig, keyframes: Sequence[Keyframe], *, seconds: float = 1.0, model: Model | None = None
) -> list[Face]:
    """Return one face a keyframe, after `seconds` of simulation from rest."""
    frames = settled(rig, keyframes, seconds, model=model)
    return [Face(rig, frame.displacements, frame.pose) for frame in frames]


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
