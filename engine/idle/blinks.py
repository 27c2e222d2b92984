"""Blinks: when they come, and how the lids go.

At rest and in conversation people blink some 15 to 25 times a minute (Bentivoglio et al. 1997); the
times between, 5.2 s and a deviation of 3.1, are skewed far to the right (Invest. Ophthalmol. Vis.
Sci. 52, 2011, 3419). Some come in pairs, some do not close the eye (Ousler et al. 2014), and some
go with a glance (Evinger et al. 1994). A lid comes down in about 0.1 s and goes up in 0.2 s and
more (VanderWerf et al. 2003).
"""

from __future__ import annotations

from collections.abc import Iterator

from ..timeline import Keyframe, ticks
from .chance import Chance
from .saccades import Shift
from .saying import said

BLINK = "AU45"
INTERVAL = (3.6, 0.45, 2.0, 10.0)
"""Seconds from one blink to the next: median, spread, least, most. Ours, for a mean of 4."""
PAIRED = 0.1
"""How many blinks have a second one after them."""
PAIR_TICKS = (22, 28)
"""Ticks from the first of a pair to the second, least and most: 0.37 to 0.47 s."""
PARTIAL = 0.15
"""How many do not close the eye. Ours, few, for they look odd where they are many."""
PARTIAL_DEPTH = (0.6, 0.85)
WITH_GLANCE = 0.35
"""How many glances have a blink with them, of those that go far and come late enough."""
FAR_GLANCE = 7.0
"""Degrees. Ours: the living share of glances of that size is 0.2 to 0.5 by the person."""
CLOSING_TICKS = 5
"""83 ms."""
SHUT_TICKS = 2
OPENING_TICKS = (13, 15)
"""217 to 250 ms."""


def onsets(seed: int, rate: float, all_shifts: Iterator[Shift]) -> Iterator[int]:
    """Yield the ticks at which blinks begin, the second ones of pairs left out, without end.

    Args:
        seed: Of the life.
        rate: Times their usual number; 0 has none.
        all_shifts: Of the gaze.
    """
    chance, last = Chance(seed, "blinks"), 0
    shift = next(all_shifts, None)
    while rate > 0.0:
        due = last + ticks(chance.log_normal(*INTERVAL) / rate)
        earliest = last + ticks(INTERVAL[2] / rate)
        while shift is not None and shift.tick < due:
            far = shift.tick >= earliest and shift.size >= FAR_GLANCE
            if far and chance.happens(WITH_GLANCE):
                due = shift.tick
            shift = next(all_shifts, None)
        yield due
        last = due


def blink_keyframes(seed: int, rate: float, all_shifts: Iterator[Shift]) -> Iterator[Keyframe]:
    """Yield what the lids do; see `onsets`."""
    chance = Chance(seed, "lids")
    for onset in onsets(seed, rate, all_shifts):
        yield from _blink(chance, onset)
        if chance.happens(PAIRED):
            yield from _blink(chance, onset + round(chance.between(*PAIR_TICKS)))


def _blink(chance: Chance, onset: int) -> Iterator[Keyframe]:
    depth = chance.between(*PARTIAL_DEPTH) if chance.happens(PARTIAL) else 1.0
    yield said(onset, CLOSING_TICKS, units={BLINK: depth})
    opening = round(chance.between(*OPENING_TICKS))
    yield said(onset + CLOSING_TICKS + SHUT_TICKS, opening, units={BLINK: 0.0})
