"""What live faces cost here, as measured, and whether there is room for one more."""

from __future__ import annotations

import math

from engine import Simulator

from .errors import AtCapacity

TICK_SECONDS = 1.0 / Simulator.TICKS_PER_SECOND
_SMOOTHING = 1.0 / 120.0
"""Weight of the newest tick in the smoothed cost: it follows within two seconds of ticks."""
_RETRY_SECONDS = 5
"""After which a refused client may ask again: a face that is let go rests within a second or two,
and the cost has followed by then."""


class Load:
    """The smoothed cost of an awake face, and what more of them would take of a tick.

    Faces are stepped `threads` at a time, so a tick lasts as many rounds as there are such
    handfuls. The cost is that of one round: measured on this machine, with whatever else it does,
    and not a constant.
    """

    def __init__(self, *, threads: int, share: float) -> None:
        """Start without a measurement: the first faces are let in, and measured.

        Args:
            threads: Faces stepped at a time.
            share: Of a tick, that awake faces may take before new ones are refused.
        """
        self.threads = threads
        self.share = share
        self.face_seconds = 0.0
        self.tick_seconds = 0.0

    def note(self, seconds: float, awake: int) -> None:
        """Take in a tick.

        Args:
            seconds: That it took.
            awake: Faces that were stepped in it.
        """
        if awake == 0:
            return
        # Cut at a tick: more is refused all the same, and what held a machine up for seconds once
        # must not be remembered for minutes.
        face = min(seconds / self._rounds(awake), TICK_SECONDS)
        tick = min(seconds, TICK_SECONDS * awake)
        known = self.face_seconds > 0.0
        self.face_seconds += (face - self.face_seconds) * (_SMOOTHING if known else 1.0)
        self.tick_seconds += (tick - self.tick_seconds) * (_SMOOTHING if known else 1.0)

    def share_of(self, awake: int) -> float:
        """Return the share of a tick that so many awake faces take, 1 being all of it."""
        return self._rounds(awake) * self.face_seconds / TICK_SECONDS

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

    def _rounds(self, awake: int) -> int:
        return math.ceil(awake / self.threads)
