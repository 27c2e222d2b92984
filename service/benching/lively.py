"""A face in lively motion: it lives, talks, feels and moves its head, the same each time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import takewhile

from engine import (
    Idle,
    Keyframe,
    Model,
    Rig,
    Simulator,
    Timeline,
    cues_of,
    idle_keyframes,
    speech_keyframes,
    ticks,
)

from ..protocol import SurfaceFrame, surface_frame

_SEED = 2001
_VISEMES = "DD aa sil PP E RR ou sil SS ih kk aa nn TH E FF oh CH ih PP aa sil".split()
_VISEME_SECONDS = 0.09
"""Eleven a second, as quick as people talk."""
_EMOTIONS = ("happiness", "surprise", "anger", "sadness", "fear", "disgust")
_EMOTION_SECONDS = 2.5
"""From one emotion to the next, without a rest between."""
_HEAD = ((12.0, 4.0, 3.0), (-10.0, -6.0, -4.0), (4.0, 8.0, -2.0))
_HEAD_SECONDS = 0.8


def lively(rig: Rig, seconds: float) -> Timeline:
    """Return idle life, speech without a pause, emotions in turn and a head that turns.

    Args:
        rig: Who performs.
        seconds: How long.
    """
    spoken = int(seconds / _VISEME_SECONDS)
    cues, end = cues_of(
        [
            {"viseme": _VISEMES[number % len(_VISEMES)], "duration": _VISEME_SECONDS}
            for number in range(spoken)
        ]
    )
    life = idle_keyframes(Idle(seed=_SEED), rig.action_units)
    keyframes = [
        *takewhile(lambda each: each.time < seconds, life),
        *speech_keyframes(cues, end),
        *_turns(seconds),
    ]
    return Timeline(tuple(sorted(keyframes, key=lambda each: each.time)), seconds)


def lively_frames(rig: Rig, seconds: float) -> list[SurfaceFrame]:
    """Return what viewers are told of that motion, one frame a tick from its first.

    Args:
        rig: Who performs.
        seconds: How long.
    """
    simulator = Simulator(rig, model=Model.for_rig(rig, integrator="verlet"), threads=1)
    simulator.add("face")
    due: dict[int, list[Keyframe]] = {}
    for keyframe in lively(rig, seconds).keyframes:
        due.setdefault(ticks(keyframe.time), []).append(keyframe)
    frames = []
    for tick in range(ticks(seconds)):
        for keyframe in due.get(tick, ()):
            simulator.apply("face", keyframe)
        simulator.step()
        frames.append(surface_frame(simulator.frame("face"), rig.jaw))
    return frames


def _turns(seconds: float) -> Iterator[Keyframe]:
    """Yield emotions with their own onsets, and where the head goes."""
    for turn in range(int(seconds / _EMOTION_SECONDS)):
        emotion = (_EMOTIONS[turn % len(_EMOTIONS)], 0.9)
        yield Keyframe(time=turn * _EMOTION_SECONDS, layer="emotion", emotion=emotion, fade=None)
    for turn in range(int(seconds / _HEAD_SECONDS)):
        angles = dict(zip(("yaw", "pitch", "roll"), _HEAD[turn % len(_HEAD)], strict=True))
        yield Keyframe(time=turn * _HEAD_SECONDS, head=angles, fade=_HEAD_SECONDS)
