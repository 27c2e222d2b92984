"""How a head is never quite still: it goes with the breath, drifts, and follows the eyes.

Breathing at rest is 12 to 18 a minute, out longer than in (Tobin et al. 1983), and rocks a head
that sits upright by fractions of a degree; under it lie slower drifts of posture. Each axis goes
from turning point to turning point, eased at both.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import tee

from ..timeline import Keyframe, ticks
from .chance import Chance
from .saccades import TURN_TICKS, Shift
from .saying import said

BREATH_IN = (1.4, 1.9)
BREATH_OUT = (1.9, 2.8)
"""Seconds, least and most: 13 to 18 breaths a minute."""
BREATH_DEGREES = (0.25, 0.3, 0.12, 0.5)
"""How far the head nods back with a breath: median, spread, least, most. Ours."""
LEVEL_DEGREES = 0.2
"""How far the level about which it breathes goes with each breath, a deviation. Ours."""
KEPT = 0.8
"""Share of the level that stays from breath to breath, so that it comes back."""
DRIFT_DEGREES = {"yaw": 0.7, "roll": 0.5}
"""Deviation of the drift to the sides. Ours, seen and not noticed."""
DRIFT_SECONDS = (3.0, 0.4, 1.6, 6.0)
"""From one turning point of a drift to the next: median, spread, least, most."""


@dataclass(frozen=True)
class Way:
    """A way of one axis: from when, for how many ticks, from where and to where, degrees."""

    begin: int
    over: int
    start: float
    to: float

    @property
    def end(self) -> int:
        """The tick at which it is over."""
        return self.begin + self.over

    def at(self, tick: int) -> float:
        """Return where it stands: an ease in and out, as that of keyframes."""
        done = min(max((tick - self.begin) / self.over, 0.0), 1.0)
        return self.start + (self.to - self.start) * done * done * (3.0 - 2.0 * done)


def head_keyframes(seed: int, size: float, all_shifts: Iterator[Shift]) -> Iterator[Keyframe]:
    """Yield what the head does, without end.

    Args:
        seed: Of the life.
        size: Times its usual size; 0 has none.
        all_shifts: Of the gaze, whose turns it takes.
    """
    if size == 0.0:
        return
    for_yaw, for_pitch = tee(shift for shift in all_shifts if shift.turn != shift.turned)
    yaw = _turned(_drift(seed, "yaw", size), ((each.tick, each.turn[0]) for each in for_yaw))
    pitch = _turned(_breath(seed, size), ((each.tick, each.turn[1]) for each in for_pitch))
    axes = [("yaw", yaw), ("pitch", pitch), ("roll", _drift(seed, "roll", size))]
    ways = heapq.merge(*(_named(*axis) for axis in axes), key=lambda each: each[0])
    for _, axis, way in ways:
        yield said(way.begin, way.over, head={axis: way.to})


def _named(axis: str, ways: Iterator[Way]) -> Iterator[tuple[int, str, Way]]:
    for way in ways:
        yield way.begin, axis, way


def _breath(seed: int, size: float) -> Iterator[Way]:
    chance, tick, level, at = Chance(seed, "breath"), 0, 0.0, 0.0
    while True:
        rise = chance.log_normal(*BREATH_DEGREES)
        for seconds, side in ((BREATH_IN, 0.5), (BREATH_OUT, -0.5)):
            way = Way(tick, ticks(chance.between(*seconds)), at, size * (level + side * rise))
            yield way
            tick, at = way.end, way.to
        level = KEPT * level + chance.normal(LEVEL_DEGREES)


def _drift(seed: int, axis: str, size: float) -> Iterator[Way]:
    chance, tick, at = Chance(seed, axis), 0, 0.0
    while True:
        over = ticks(chance.log_normal(*DRIFT_SECONDS))
        way = Way(tick, over, at, size * chance.normal(DRIFT_DEGREES[axis]))
        yield way
        tick, at = way.end, way.to


def _turned(sways: Iterator[Way], turns: Iterator[tuple[int, float]]) -> Iterator[Way]:
    """Yield sways about where the head is turned to, and the turns.

    Turns are farther apart than one takes, so that each is over before the next.
    """
    held, free = 0.0, 0
    turn = next(turns, None)
    for sway in sways:
        begin = max(sway.begin, free)
        while turn is not None and turn[0] < sway.end:
            tick, before, held = turn[0], held, turn[1]
            if tick > begin:  # What of the sway comes before the turn, which cuts it short.
                yield Way(begin, sway.end - begin, before + sway.at(begin), before + sway.to)
            begin = free = tick + TURN_TICKS
            yield Way(tick, TURN_TICKS, before + sway.at(tick), held + sway.at(free))
            turn = next(turns, None)
        if begin < sway.end:
            yield Way(begin, sway.end - begin, held + sway.at(begin), held + sway.to)
