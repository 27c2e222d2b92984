"""Brief faint expressions: here and gone within half a second, of part of the face.

Micro-expressions last from 1/25 s to half a second, with an onset of at most 0.26 s (Ekman and
Friesen 1969; Yan et al. 2013); most move one part of the face, and few people notice them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ..facs import split_side
from ..timeline import Keyframe, ticks
from .chance import Chance
from .saying import said

INTERVAL = (11.0, 0.6, 4.0, 60.0)
"""Seconds from one to the next at a rate of 1: median, spread, least, most. Ours."""
INTENSITY = (0.15, 0.4)
"""A to B."""
ONSET, APEX, OFFSET = (0.07, 0.13), (0.04, 0.12), (0.12, 0.2)
"""Seconds, least and most: a quarter to just under half a second in all."""
FLASHES: tuple[tuple[tuple[str, ...], float], ...] = (
    (("AU1", "AU2"), 3.0),
    (("AU1",), 1.5),
    (("AU4",), 2.0),
    (("AU7",), 1.0),
    (("AU12",), 2.0),
    (("L12",), 1.0),
    (("R12",), 1.0),
    (("L14",), 0.7),
    (("R14",), 0.7),
    (("AU15",), 1.0),
    (("AU17",), 1.5),
    (("AU24",), 1.5),
)
"""Units that act together, and how often. Ours: the brow's and the mouth's most usual motions."""


def flash_keyframes(seed: int, rate: float, units: Collection[str]) -> Iterator[Keyframe]:
    """Yield brief expressions, without end.

    Args:
        seed: Of the life.
        rate: Times their usual number; 0 has none.
        units: Those of the rig; what it does not have is left out.
    """
    choices = [each for each in FLASHES if all(split_side(key)[0] in units for key in each[0])]
    chance, tick = Chance(seed, "flashes"), 0
    while rate > 0.0 and choices:
        tick += ticks(chance.log_normal(*INTERVAL) / rate)
        strength = chance.between(*INTENSITY)
        played = dict.fromkeys(chance.one_of(choices), strength)
        onset, apex, offset = (ticks(chance.between(*part)) for part in (ONSET, APEX, OFFSET))
        yield said(tick, onset, units=played)
        yield said(tick + onset + apex, offset, units=dict.fromkeys(played, 0.0))
