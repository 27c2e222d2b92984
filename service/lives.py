"""Idle lives of live faces: of each the keyframe that comes next, by ticks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from engine import Keyframe, ticks


@dataclass
class Life:
    """What a face does by itself, as far as it is still to come.

    Attributes:
        begun: Tick at which it began.
        following: The next keyframe.
        later: Those after it, without end.
    """

    begun: int
    following: Keyframe
    later: Iterator[Keyframe]

    @property
    def due(self) -> int:
        """The tick of the next keyframe."""
        return self.begun + ticks(self.following.time)


class Lives:
    """The idle lives of the faces of one simulator."""

    def __init__(self) -> None:
        self._lives: dict[str, Life] = {}
        self._paused: dict[str, Life] = {}

    @property
    def empty(self) -> bool:
        """True while no face has one that goes on."""
        return not self._lives

    def __contains__(self, face: str) -> bool:
        """Tell whether a face has one that goes on."""
        return face in self._lives

    def begin(self, face: str, keyframes: Iterator[Keyframe], now: int) -> None:
        """Have a face live by keyframes at their times from the tick `now` on; none has no life."""
        self.leave(face, now)
        first = next(keyframes, None)
        if first is not None:
            self._lives[face] = Life(now, first, keyframes)

    def due(self, now: int) -> Iterator[tuple[str, Keyframe]]:
        """Yield what is due at the tick `now`, of each face in order of time."""
        for face, life in list(self._lives.items()):
            while life.due <= now and face in self._lives:
                yield face, life.following
                following = next(life.later, None)
                if following is None:
                    del self._lives[face]
                else:
                    life.following = following

    def leave(self, face: str, now: int) -> Life | None:
        """Take a face's life out, if it has one, as begun so many ticks before `now`."""
        life = self._lives.pop(face, None)
        if life is not None:
            life.begun -= now
        return life or self._paused.pop(face, None)

    def pause(self, face: str, now: int) -> bool:
        """Have a face's life wait; return whether it has one that went on."""
        life = self.leave(face, now) if face in self else None
        if life is not None:
            self._paused[face] = life
        return life is not None

    def resume(self, face: str, now: int) -> None:
        """Have a life that waits go on where it stopped."""
        if face in self._paused:
            self.carry_on(face, self._paused.pop(face), now)

    def carry_on(self, face: str, life: Life | None, now: int) -> None:
        """Have a life that was taken out go on from the tick `now`."""
        if life is not None:
            life.begun += now
            self._lives[face] = life
