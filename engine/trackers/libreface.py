"""LibreFace's table of a video (Chang et al. 2024): intensities 0 to 5 and detections.

Its pitch is positive upwards and its yaw to the right of the picture, the person's left, as its
`detect_mediapipe_image` draws the nose; roll is taken to turn with the clock in the picture. Its
gaze is told in degrees in the camera's axes (`vector_to_angles`): right in the picture and down.
"""

from __future__ import annotations

import re

import numpy as np

from ..arrays import FloatArray
from .angles import sight_of, turns_of
from .columns import Columns
from .layout import Layout, TimeColumn, Turn, UnitColumn

FULL = 5.0
_INTENSITY = re.compile(r"au_(\d+)_intensity")
_DETECTED = re.compile(r"au_(\d+)")


def libreface_layout(columns: Columns) -> Layout | None:
    """Return what a header with LibreFace's names means, None where it has none of them."""
    found = {name: int(match[1]) for name in columns if (match := _INTENSITY.fullmatch(name))}
    if not found:
        return None
    milliseconds = columns.find("frame_time_in_ms")
    return Layout(
        tracker="LibreFace",
        version=f"{len(found)} intensities",
        units=tuple(UnitColumn(str(columns.find(n)), f"AU{number}") for n, number in found.items()),
        full=FULL,
        time=None if milliseconds is None else TimeColumn(milliseconds, "milliseconds"),
        frame=columns.find("frame_idx"),
        head=_head(columns),
        gaze=_gaze(columns),
        ignored={
            str(columns.find(name)): "a detection, 0 or 1, is no intensity"
            for name in columns
            if _DETECTED.fullmatch(name)
        },
    )


def _head(columns: Columns) -> Turn | None:
    names = tuple(n for name in ("yaw", "pitch", "roll") if (n := columns.find(name)) is not None)
    return Turn(names, turns_of) if len(names) == 3 else None


def _gaze(columns: Columns) -> Turn | None:
    yaw, pitch = columns.find("gaze_yaw"), columns.find("gaze_pitch")
    if yaw is None or pitch is None:
        return None
    return Turn((yaw, pitch), _sight, in_space=True)


def _sight(degrees: FloatArray) -> FloatArray:
    yaw, pitch = np.radians(degrees).T
    return sight_of(yaw, -pitch)
