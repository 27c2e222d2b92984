"""Turns and lines of sight of trackers, as this project has them.

Here x is the face's own left, y up, z out of the face; yaw turns left, pitch up, roll to the left
shoulder, composed from the outside in (`engine.gltf.pose`). A camera that looks at the face has x
to the right of its picture, which is the face's left, y down and z away from it: half a turn about
x lies between the two.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

HALF_TURN = np.diag([1.0, -1.0, -1.0])
"""From the camera's axes to the face's, and back."""


def turns_of(angles: FloatArray) -> FloatArray:
    """Return rotations, shape (n, 3, 3), of yaw, pitch and roll [degrees], shape (n, 3)."""
    from scipy.spatial.transform import Rotation  # Here: a start does without.

    signed = angles * np.array([1.0, -1.0, -1.0])
    return np.asarray(Rotation.from_euler("YXZ", signed, degrees=True).as_matrix())


def angles_of(turns: FloatArray) -> FloatArray:
    """Return yaw, pitch and roll [degrees], shape (n, 3), of rotations, shape (n, 3, 3).

    Of a head that looks straight up or down, the yaw is told as roll or roll as yaw.
    """
    forward = turns[:, :, 2]
    yaw = np.arctan2(forward[:, 0], forward[:, 2])
    pitch = np.arcsin(np.clip(forward[:, 1], -1.0, 1.0))
    roll = np.arctan2(-turns[:, 1, 0], turns[:, 1, 1])
    return np.asarray(np.degrees(np.stack([yaw, pitch, roll], axis=1)))


def sight_of(yaw: FloatArray, pitch: FloatArray) -> FloatArray:
    """Return lines of sight, shape (n, 3), of yaw to the left and pitch up [radians]."""
    level = np.cos(pitch)
    return np.stack([np.sin(yaw) * level, np.sin(pitch), np.cos(yaw) * level], axis=1)


def gaze_angles(sights: FloatArray) -> FloatArray:
    """Return yaw and pitch [degrees], shape (n, 2), of lines of sight, shape (n, 3)."""
    x, y, z = sights.T
    angles = np.stack([np.arctan2(x, z), np.arctan2(y, np.hypot(x, z))], axis=1)
    return np.asarray(np.degrees(angles))


def seen_from(turns: FloatArray, sights: FloatArray) -> FloatArray:
    """Return lines of sight in space, shape (n, 3), as the turned head has them."""
    return np.asarray(np.einsum("nji,nj->ni", turns, sights))
