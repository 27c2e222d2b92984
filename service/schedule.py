"""Keyframes that are still to come: each waits for the tick at which it takes effect."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from engine import Keyframe, ticks

MOST_COMING = 50_000
"""Keyframes that wait for one face at most."""


class Schedule:
    """What waits for the faces of one simulator, by its ticks.

    A tick looks at the first of each face alone: an hour of speech takes no more of it than a word.
    """

    def __init__(self) -> None:
        self._coming: dict[str, deque[tuple[int, Keyframe]]] = {}

    @property
    def empty(self) -> bool:
        """True while nothing waits."""
        return not self._coming

    def plan(self, face: str, keyframes: Sequence[Keyframe], now: int) -> None:
        """Have keyframes wait, at their times from the tick `now` on.

        What the same owners still had to come in the same layers is dropped.
        """
        whose = {(keyframe.layer, keyframe.owner) for keyframe in keyframes}
        kept = [
            (tick, keyframe)
            for tick, keyframe in self._coming.get(face, ())
            if (keyframe.layer, keyframe.owner) not in whose
        ]
        self.carry_on(face, [*kept, *((now + ticks(each.time), each) for each in keyframes)], 0)

    def coming(self, face: str) -> int:
        """Return how many wait for a face."""
        return len(self._coming.get(face, ()))

    def due(self, now: int) -> list[tuple[str, Keyframe]]:
        """Take out what is due at the tick `now`, of each face in order of time."""
        found = []
        for face, waiting in list(self._coming.items()):
            while waiting and waiting[0][0] <= now:
                found.append((face, waiting.popleft()[1]))
            if not waiting:
                del self._coming[face]
        return found

    def leave(self, face: str, now: int) -> list[tuple[int, Keyframe]]:
        """Take out all that waits for a face, with the ticks that are left from `now`."""
        return [(tick - now, keyframe) for tick, keyframe in self._coming.pop(face, ())]

    def carry_on(self, face: str, waiting: Sequence[tuple[int, Keyframe]], now: int) -> None:
        """Have keyframes wait in place of what does, each its ticks from `now` on."""
        if waiting:
            in_order = sorted(waiting, key=lambda each: each[0])
            self._coming[face] = deque((now + tick, keyframe) for tick, keyframe in in_order)
        else:
            self._coming.pop(face, None)
