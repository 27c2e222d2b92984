"""What live faces cost here, as measured, and whether there is room for one more."""

from __future__ import annotations

import math
from dataclasses import dataclass

from engine import Simulator

from .errors import AtCapacity

TICK_SECONDS = 1.0 / Simulator.TICKS_PER_SECOND
_SMOOTHING = 1.0 / 120.0
"""Weight of the newest tick in smoothed times: they follow within two seconds of ticks."""
_TELLING_TICKS = 10
"""Ticks with so many faces awake that their time is believed after."""
_REMEMBERED_TICKS = 3600
"""Ticks after which a time that was not seen again is forgotten: what a minute was too slow for
may be tried again."""
_RETRY_SECONDS = 5
"""After which a refused client may ask again: a face that is let go rests within a second or two,
and the cost has followed by then."""


@dataclass
class _Seen:
    """Ticks with one number of faces awake: their smoothed time [s], how many, the last one."""

    seconds: float
    ticks: int
    last: int


class Load:
    """What ticks take by the number of faces that are awake, smoothed, and what more would take.

    Measured on this machine, with whatever else it does, and not a constant: where so many faces
    were awake lately, their time is known; else it is foretold from the nearest known one: each
    `threads` faces take as long as the first, or less where faces that were added took less.
    """

    def __init__(self, *, threads: int, share: float) -> None:
        """Start without a measurement: the first faces are let in, and measured.

        Args:
            threads: Faces stepped at a time.
            share: Of a tick, that awake faces may take before new ones are refused.
        """
        self.threads = threads
        self.share = share
        self.tick_seconds = 0.0
        self._seen: dict[int, _Seen] = {}
        self._growth: float | None = None
        self._tick = 0
        self._awake = 0

    @property
    def face_seconds(self) -> float:
        """Smoothed time of a tick over the faces awake in it [s]."""
        return self.tick_seconds / self._awake if self._awake else 0.0

    def note(self, seconds: float, awake: int) -> None:
        """Take in a tick.

        Args:
            seconds: That it took.
            awake: Faces that were stepped in it.
        """
        if awake == 0:
            return
        # Cut at two ticks: more is refused all the same, and what held a machine up for seconds
        # once must not be remembered for minutes.
        seconds = min(seconds, 2.0 * TICK_SECONDS)
        self._tick += 1
        self._awake = awake
        seen = self._seen.setdefault(awake, _Seen(seconds, 0, 0))
        # The first ones count alike, so that a single odd one does not stand for all.
        weight = max(_SMOOTHING, 1.0 / (seen.ticks + 1))
        seen.seconds += (seconds - seen.seconds) * weight
        seen.ticks, seen.last = seen.ticks + 1, self._tick
        self.tick_seconds = seen.seconds
        self._forget()
        self._learn(awake)

    def share_of(self, awake: int) -> float:
        """Return the share of a tick that so many awake faces take, 1 being all of it."""
        return self._seconds(awake) / TICK_SECONDS

    def admit(self, awake: int) -> None:
        """Let one more face in beside `awake` ones; the only one is always let in.

        Raises:
            AtCapacity: If the ticks would take more than the share that they may.
        """
        if awake == 0 or self.share_of(awake + 1) < self.share:
            return
        faces = "1 face is" if awake == 1 else f"{awake} faces are"
        raise AtCapacity(
            "at_capacity",
            f"{faces} awake, which takes {self.share_of(awake):.0%} of a tick; one more would "
            f"make it {self.share_of(awake + 1):.0%}, and it has to stay below {self.share:.0%} "
            "for faces to keep their rate: ask again when some have come to rest, close sessions "
            "that nobody needs, or give the service more cores",
            retry_after=_RETRY_SECONDS,
        )

    def _seconds(self, awake: int) -> float:
        """Return the time of a tick with so many faces awake [s], known or foretold."""
        known = self._known()
        if not known or awake == 0:
            return 0.0
        fewer = [count for count in known if count <= awake]
        if not fewer:
            return known[min(known)]
        nearest = max(fewer)
        foretold = known[nearest] * self._rounds(awake) / self._rounds(nearest)
        if self._growth is not None:
            foretold = min(foretold, known[nearest] + self._growth * (awake - nearest))
        # Never less than fewer faces take: what they do is newer where the machine got slower.
        return max(foretold, *(known[count] for count in fewer))

    def _learn(self, awake: int) -> None:
        """Note how the time of a tick grows with each face [s], where that is seen."""
        known = self._known()
        fewer = [count for count in known if count < awake]
        if awake not in known or not fewer:
            return
        least = min(fewer)
        self._growth = max(0.0, (known[awake] - known[least]) / (awake - least))

    def _known(self) -> dict[int, float]:
        return {n: seen.seconds for n, seen in self._seen.items() if seen.ticks >= _TELLING_TICKS}

    def _forget(self) -> None:
        since = self._tick - _REMEMBERED_TICKS
        for count in [count for count, seen in self._seen.items() if seen.last <= since]:
            del self._seen[count]

    def _rounds(self, awake: int) -> int:
        return math.ceil(awake / self.threads)
