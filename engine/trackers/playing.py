"""From a track to a timeline: a keyframe a frame, each reached when its frame is due."""

from __future__ import annotations

from ..arrays import Float32Array
from ..channels import LIMITS
from ..timeline import Keyframe, Timeline
from .track import Track

OWNER = "tracker"
DIGITS = 4
"""Digits of an intensity that are kept; frames that do not differ in them are one."""
ANGLE_DIGITS = 2


def track_timeline(track: Track) -> Timeline:
    """Return the timeline that plays a track in the layer puppet.

    Each keyframe is sent a frame before it is due and fades over that frame: at 30 or 60 frames a
    second a face then moves in straight lines from one to the next, and is there in time. Each
    replaces the one before it. Frames that do not differ need none.
    """
    rate = track.rate
    keyframes = []
    before: Keyframe | None = None
    for index in range(len(track)):
        now = _keyframe(track, index)
        if before is not None and _alike(before, now):
            continue
        keyframes.append(now)
        before = now
    return Timeline(tuple(keyframes), max(track.duration, 1.0 / rate))


def _keyframe(track: Track, index: int) -> Keyframe:
    angles: dict[str, dict[str, float]] = {"head": {}, "gaze": {}}
    for (group, axis), value in zip(
        track.axes, _rounded(track.angles[index], ANGLE_DIGITS), strict=True
    ):
        least, most = LIMITS[group, axis]
        if value:
            angles[group][axis] = min(max(value, least), most)
    intensities = _rounded(track.intensities[index], DIGITS)
    first = index == 0
    return Keyframe(
        time=0.0 if first else (index - 1) / track.rate,
        owner=OWNER,
        action_units={k: v for k, v in zip(track.units, intensities, strict=True) if v},
        fade=0.0 if first else 1.0 / track.rate,
        replace=True,
        head=angles["head"],
        gaze=angles["gaze"],
    )


def _alike(before: Keyframe, now: Keyframe) -> bool:
    return (
        before.action_units == now.action_units
        and before.head == now.head
        and before.gaze == now.gaze
    )


def _rounded(values: Float32Array, digits: int) -> list[float]:
    return [round(float(value), digits) for value in values]
