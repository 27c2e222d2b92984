"""Idle life as clients ask for it, made what the engine plays."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from itertools import takewhile

from engine import Idle, Keyframe, Rig, Timeline, idle_keyframes

from .bodies import IdleLife, NewClip

_SEED_OF_CLIPS = 0
"""Seed of a clip that names none: the same clip has the same bits."""


def idle_of(asked: IdleLife | None, *, seed: int | None = None) -> Idle | None:
    """Return the idle life that is asked for, if any.

    Args:
        asked: By whom.
        seed: Taken where the client names none; without either it is drawn.
    """
    if asked is None:
        return None
    parts = asked.model_dump(include={"blinks", "gaze", "head", "micro"})
    given = seed if asked.seed is None else asked.seed
    return Idle(seed=secrets.randbits(32) if given is None else given, **parts)


def lived(idle: Idle, rig: Rig) -> Iterator[Keyframe]:
    """Yield what a life plays on `rig`, in order of time, without end."""
    return idle_keyframes(idle, rig.action_units)


def seed_of(clip: NewClip) -> int | None:
    """Return the seed of a clip's idle life, if it has any."""
    idle = idle_of(clip.idle, seed=_SEED_OF_CLIPS)
    return None if idle is None else idle.seed


def with_life(timeline: Timeline, clip: NewClip, rig: Rig) -> Timeline:
    """Return the timeline of a clip with the idle life that it asks for beside what it tells."""
    idle = idle_of(clip.idle, seed=_SEED_OF_CLIPS)
    if idle is None:
        return timeline
    played = takewhile(lambda each: each.time < timeline.duration, lived(idle, rig))
    return Timeline((*timeline.keyframes, *played), timeline.duration)
