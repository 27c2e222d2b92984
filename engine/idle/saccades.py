"""Where the eyes look: mostly at whoever is in front, and now and then away.

In conversation people look at their partner for most of the time, some three seconds at once, and
away for a second or so (Argyle and Cook 1976; Lee, Badler and Badler 2002). On the partner's face
the eyes go from eye to eye and sometimes to the mouth (Yarbus 1967), each fixation a few tenths of
a second to seconds (Rayner 1998). A saccade takes 21 ms and 2.2 ms a degree (the main sequence:
Bahill, Clark and Stark 1975; Carpenter 1988).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ..timeline import Keyframe, ticks
from .chance import Chance
from .saying import said

Place = tuple[float, float]
"""Yaw and pitch, degrees."""

PARTNER: tuple[tuple[Place, float], ...] = (
    ((1.6, 0.0), 0.44),
    ((-1.6, 0.0), 0.44),
    ((0.0, -3.6), 0.12),
)
"""The partner's eyes and mouth, and how often each is looked at. Ours,
for a face at about a metre. Both eyes stand at one height, so that the lids rest meanwhile."""
DIRECTIONS = (
    (0.0, 15.5),
    (45.0, 6.5),
    (90.0, 17.7),
    (135.0, 7.4),
    (180.0, 16.8),
    (225.0, 7.9),
    (270.0, 20.4),
    (315.0, 7.8),
)
"""Directions of glances, degrees from the face's left over up, and how often each is taken, by
Lee, Badler and Badler (2002), Table 1."""
LOOK = (3.0, 0.5, 1.2, 8.0)
"""Seconds that the partner is looked at: median, spread, least, most."""
FIXATION = (0.75, 0.5, 0.3, 3.0)
"""Seconds at one place of the partner's face."""
AWAY = (0.9, 0.45, 0.5, 2.5)
"""Seconds that a glance away stays at a place."""
GLANCE = (8.5, 0.35, 5.0, 16.0)
"""Degrees that a glance goes away."""
FLAT = 0.7
"""What upward and downward glances are shortened to: the eyes' range is less there."""
ON_AGAIN = 0.3
"""How often a glance away goes on to a second place, 2 to 4 degrees from the first."""
TURNS_FROM = 6.0
"""Degrees from which on the head turns too; it does little within some 15 degrees (Stahl 1999)."""
HEAD_SHARE = 0.25
"""Share of a glance that the head takes. Ours."""
TURN_TICKS = 24
"""Ticks that the head takes for it: 0.4 s. No two turns come closer than `AWAY`'s least."""


@dataclass(frozen=True)
class Shift:
    """The eyes go to another place.

    Attributes:
        tick: When.
        yaw, pitch: Where the line of sight goes, degrees left and up of straight ahead.
        size: How far that is, degrees.
        turn: Yaw and pitch at which the head is held then, degrees, beside its sway.
        turned: Those at which it was before.
    """

    tick: int
    yaw: float
    pitch: float
    size: float
    turn: Place
    turned: Place


def saccade_seconds(size: float) -> float:
    """Return how long a saccade of `size` degrees takes, s."""
    return 0.021 + 0.0022 * size


def shifts(seed: int, gaze: float, head: float) -> Iterator[Shift]:
    """Yield the shifts of gaze, without end.

    Args:
        seed: Of the life.
        gaze: Times their usual size; 0 has none.
        head: Times the usual part that the head takes.
    """
    chance, tick, at, turned = Chance(seed, "gaze"), 0, (0.0, 0.0), (0.0, 0.0)
    for stays, place, turns in _places(chance) if gaze > 0.0 else ():
        tick += ticks(stays)
        to = (gaze * place[0], gaze * place[1])
        if to == at:
            continue
        turn = turned
        if turns is not None:
            share = HEAD_SHARE * head if turns else 0.0
            turn = (share * to[0], share * to[1])
        yield Shift(tick, *to, math.dist(to, at), turn, turned)
        at, turned = to, turn


def gaze_keyframes(all_shifts: Iterator[Shift]) -> Iterator[Keyframe]:
    """Yield what the eyes do: a saccade, then, while the head follows, back by as much."""
    for shift in all_shifts:
        over = max(1, ticks(saccade_seconds(shift.size)))
        yield said(shift.tick, over, gaze=_eyes(shift, shift.turned))
        if shift.turn != shift.turned:
            yield said(shift.tick + over, TURN_TICKS, gaze=_eyes(shift, shift.turn))


def _eyes(shift: Shift, turn: Place) -> dict[str, float]:
    """Return how the eyes stand in a head that is turned: the line of sight less its turn."""
    return {"yaw": shift.yaw - turn[0], "pitch": shift.pitch - turn[1]}


def _places(chance: Chance) -> Iterator[tuple[float, Place, bool | None]]:
    """Yield how long the last place is looked at, s, the next, and whether the head turns there.

    It turns back where that is False, and stays as it is where that is None.
    """
    while True:
        first, left, stayed = True, chance.log_normal(*LOOK), 0.0
        while stayed < left:
            # From a glance away back to the partner first: that place's time is the glance's.
            stays = chance.log_normal(*(AWAY if first else FIXATION))
            yield stays, chance.one_of(PARTNER), False if first else None
            stayed, first = stayed + (0.0 if first else stays), False
        far = chance.log_normal(*GLANCE)
        place = _glance(chance, (0.0, 0.0), far)
        yield chance.log_normal(*FIXATION), place, far >= TURNS_FROM
        if chance.happens(ON_AGAIN):
            yield chance.log_normal(*AWAY), _glance(chance, place, chance.between(2.0, 4.0)), None


def _glance(chance: Chance, start: Place, far: float) -> Place:
    """Return the place `far` degrees from `start`, in one of the directions of glances."""
    angle = math.radians(chance.one_of(DIRECTIONS) + chance.between(-15.0, 15.0))
    return start[0] + far * math.cos(angle), start[1] + FLAT * far * math.sin(angle)
