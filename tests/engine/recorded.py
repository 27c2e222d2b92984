"""A short real performance, recorded once however many tests look at it."""

from __future__ import annotations

from functools import lru_cache

from engine.clip import Clip, record
from engine.frame import Frame
from engine.rig import Rig, builtin_rig
from engine.simulator import Simulator
from engine.timeline import Keyframe, Timeline

FPS = 24
TIMELINE = Timeline(
    (
        Keyframe(time=0.0, action_units={"AU12": 0.9, "AU26": 0.7}, fade=0.15),
        Keyframe(time=0.1, gaze={"yaw": 12.0, "pitch": 4.0}, head={"yaw": -15.0, "roll": 5.0}),
        Keyframe(time=0.35, jaw={"yaw": 3.0}, action_units={"L4": 1.0}, fade=0.1),
        Keyframe(time=0.6, emotion=("surprise", 1.0), layer="emotion", fade=0.1, replace=True),
    ),
    duration=1.0,
)
"""Smile, open mouth, gaze, a turned head, a lopsided brow and jaw, surprise."""


@lru_cache(maxsize=1)
def standard_clip() -> Clip:
    """The performance on the standard rig."""
    return record(builtin_rig("standard"), TIMELINE, fps=FPS)


def live_frames(rig: Rig, timeline: Timeline) -> list[Frame]:
    """What a live session would show at every tick, the rest included."""
    simulator = Simulator(rig)
    simulator.add("live")
    frames = [simulator.frame("live")]
    coming = list(timeline.keyframes)
    for tick in range(round(timeline.duration * 60)):
        while coming and round(coming[0].time * 60) <= tick:
            assert simulator.apply("live", coming.pop(0)) == tick
        simulator.step()
        frames.append(simulator.frame("live"))
    return frames
