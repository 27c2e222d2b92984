"""A whole idle life: how much of each part, and all that it does in order of time."""

from __future__ import annotations

import heapq
import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, fields
from itertools import tee

from ..errors import InvalidValue
from ..timeline import Keyframe
from .blinks import BLINK, blink_keyframes
from .flashes import flash_keyframes
from .saccades import gaze_keyframes, shifts
from .saying import IDLE, LAYER
from .sway import head_keyframes

MOST_LIFE = 2.0
"""Most of each part, times the usual."""
LEAST_LIFE = 0.01
"""Below it a part has none: what comes once in a year would have to be sought through all that
comes before, without end for a number that is nearly 0."""
LETS_GO_OF_LIFE = 0.5
"""Seconds over which a life that ends lets go of the face."""
_SEEDS = 2**32


@dataclass(frozen=True)
class Idle:
    """What idle life a face has.

    Attributes:
        seed: Chooses when and where, 0 to 2^32 - 1.
        blinks: How many, times the usual; as of the rest, less than 0.01 is none and 2 the most.
        gaze: How far the eyes go.
        head: How far the head sways, and how much of a glance it takes.
        micro: How many brief expressions.
    """

    seed: int = 0
    blinks: float = 1.0
    gaze: float = 1.0
    head: float = 1.0
    micro: float = 0.3

    def __post_init__(self) -> None:
        if not 0 <= self.seed < _SEEDS:
            raise InvalidValue(f"seed is {self.seed!r}; expected a whole number from 0 to 2^32 - 1")
        for part in fields(self)[1:]:
            value = getattr(self, part.name)
            if not (math.isfinite(value) and 0.0 <= value <= MOST_LIFE):
                raise InvalidValue(f"{part.name} is {value!r}; expected 0 to {MOST_LIFE:g}")


def idle_keyframes(idle: Idle, units: Collection[str]) -> Iterator[Keyframe]:
    """Yield all that a life does, in order of time from its beginning at 0 s, without end.

    It is the same for the same arguments, whatever the face does meanwhile.

    Args:
        idle: Which life.
        units: Names of the rig's action units: what needs others is left out.
    """
    blinks, gaze, head, micro = (
        amount if amount >= LEAST_LIFE else 0.0
        for amount in (idle.blinks, idle.gaze, idle.head, idle.micro)
    )
    for_eyes, for_head, for_lids = tee(shifts(idle.seed, gaze, head), 3)
    parts = [
        gaze_keyframes(for_eyes),
        head_keyframes(idle.seed, head, for_head),
        flash_keyframes(idle.seed, micro, units),
    ]
    if BLINK in units:
        parts.append(blink_keyframes(idle.seed, blinks, for_lids))
    return heapq.merge(*parts, key=lambda keyframe: keyframe.time)


def end_of_life() -> Keyframe:
    """Return the command with which a life that ends lets go of all that it holds."""
    return Keyframe(layer=LAYER, owner=IDLE, fade=LETS_GO_OF_LIFE, replace=True)
