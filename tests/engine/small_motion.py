"""A hand-made performance of the small face: no simulator, every frame known."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from small_face import small_rig

from engine.frame import Pose


def pose(**changes: Any) -> Pose:
    """A pose at rest but for `changes`."""
    return Pose(**changes)


def small_frame(displacements: np.ndarray, **changes: Any) -> Any:
    """One frame of the small face."""
    return SimpleNamespace(tick=7, displacements=displacements, pose=pose(**changes))


def small_clip(frames: int = 40) -> Any:
    """A second or so of bumps that wander over the sheet, with jaw, eyes and head moving."""
    rig = small_rig()
    points = rig.head.points
    time = np.linspace(0, 1, frames)
    centers = np.stack([40 * np.sin(6 * time), -20 + 50 * time, np.full(frames, 90.0)], axis=1)
    distance = np.linalg.norm(points[None] - centers[:, None], axis=2)
    bump = 6 * np.sin(np.pi * time)[:, None] * np.exp(-((distance / 30) ** 2))
    displacements = bump[:, :, None] * np.array([0.3, 0.5, -0.8])
    poses = tuple(
        pose(
            jaw_pitch=20 * t,
            jaw_yaw=4 * t,
            jaw_thrust=2 * t,
            gaze_left=(10 * t, 5.0 * t),
            head=(30 * t, 10 * t, -8 * t),
        )
        for t in time
    )
    return SimpleNamespace(
        rig=rig,
        fps=30,
        displacements=displacements.astype("f4"),
        poses=poses,
        timeline=None,
        model=None,
    )
