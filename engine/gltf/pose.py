"""Jaw, gaze and head pose as rotations and translations of the scene's pivots.

Positive yaw turns to the face's left, positive pitch up, positive roll to the left shoulder;
x is the face's left, y up, z forward, so yaw is a right-handed turn about y, and pitch and roll are
left-handed turns about x and z. They compose as yaw, pitch, roll from the outside in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..frame import Pose
from ..head.head import Head
from ..jaw import JawHinge
from .scene import EYE_NODES, NECK_PIVOT


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """A rigid motion about a pivot: x' = rotation (x - origin) + origin + shift, mm."""

    rotation: FloatArray
    origin: FloatArray
    shift: FloatArray

    def move(self, points: FloatArray) -> FloatArray:
        """Return `points` [mm], shape (k, 3), moved."""
        return (points - self.origin) @ self.rotation.T + self.origin + self.shift

    def turn(self, vectors: FloatArray) -> FloatArray:
        """Return `vectors`, shape (k, 3), turned."""
        return vectors @ self.rotation.T

    @property
    def still(self) -> bool:
        """Whether nothing moves at all."""
        return not self.shift.any() and bool(np.array_equal(self.rotation, np.eye(3)))


def quaternions(rotations: Sequence[FloatArray]) -> FloatArray:
    """Return rotations, shape (3, 3) each, as x, y, z, w with w >= 0, shape (n, 4)."""
    from scipy.spatial.transform import Rotation  # Here: a start does without.

    return np.asarray(Rotation.from_matrix(np.stack(rotations)).as_quat(canonical=True))


def turned(yaw: float, pitch: float, roll: float = 0.0) -> FloatArray:
    """Return the rotation, shape (3, 3), of a gaze or a head, degrees."""
    from scipy.spatial.transform import Rotation  # Here: a start does without.

    if not (yaw or pitch or roll):
        return np.eye(3)
    angles = [yaw, -pitch, -roll]
    return np.asarray(Rotation.from_euler("YXZ", angles, degrees=True).as_matrix())


def motions(head: Head, jaw: JawHinge, pose: Pose) -> dict[str, RigidMotion]:
    """Return the motion of each pivot relative to its parent, by the pivot's name."""
    still = np.zeros(3)
    rotation, shift = jaw.transform(pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)
    moved = {
        "head": RigidMotion(turned(*pose.head), NECK_PIVOT, np.array([0.0, 0.0, pose.head_thrust])),
        "skull": RigidMotion(np.eye(3), still, still),
        "jaw": RigidMotion(rotation, np.array(jaw.center), shift),
    }
    gazes = (pose.gaze_left, pose.gaze_right)
    for name, eye, gaze in zip(EYE_NODES, head.eyes, gazes, strict=False):
        moved[name] = RigidMotion(turned(*gaze), eye.center, still)
    return moved
