"""The tail of a session's timeline: its last commands, and what was held where they begin.

It outlives the process: the store is given what came since the last commit, and what falls off
its beginning there too. Ticks are those of the face as it lives now; what it did before the service
started again lies before tick 0.
"""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from engine import EngineError, Keyframe, Rig, Writers

from .commands import held_from_json, held_to_json
from .runner import Move

MOST_KEPT = 8_000
"""Commands of a tail: two minutes, the longest clip as delivered, of one a tick."""
_CUT = 500
"""Commands that fall off before the store is told to forget them: it is a write for each cut."""


@dataclass(frozen=True)
class Resumed:
    """A face that begins anew, at rest, and goes to what is held: the service started again."""

    held: Sequence[Keyframe] = ()


@dataclass(frozen=True)
class Command:
    """One line of a session's timeline: what took effect at which tick.

    Attributes:
        tick: When.
        command: What.
        idle: Whether the face did it by itself.
    """

    tick: int
    command: Keyframe | Move | Resumed
    idle: bool = False


@dataclass(frozen=True)
class Piece:
    """What the store is given of a tail with one commit.

    Attributes:
        number: Of the piece; each is higher than the last.
        last: Tick of its last command, counted as the store does.
        write: Makes the commands plain data; not done on the event loop.
        begins: Tick at which the tail begins now, counted as the store does; None where it still
            begins as the store knows.
        before: What was held there, plain.
        fresh: Number up to which commands are in the store once it is written.
    """

    number: int
    last: int
    write: Callable[[], list[Any]]
    begins: int | None
    before: list[Any]
    fresh: int


class Tail:
    """The last commands of a session.

    Attributes:
        begins: Tick from which on everything is known.
        whole: Whether the face was new, and at rest, there.
        before: What was held there.
        commands: What it was told since, and did by itself, oldest first.
    """

    def __init__(self, rig: Rig, *, elapsed: int = 0) -> None:
        """Begin at tick 0 of a face that is new.

        Args:
            rig: Its rig.
            elapsed: Ticks that it lived in services before this one.
        """
        self.begins = -elapsed
        self.whole = True
        self.before = Writers(rig)
        self.commands: deque[Command] = deque()
        self._elapsed = elapsed
        self._count = 0
        self._fresh: deque[tuple[int, Command]] = deque(maxlen=MOST_KEPT)
        self._pieces = 0
        self._cut = 0
        self._fallen = 0

    @property
    def elapsed(self) -> int:
        """Ticks that the face lived in services before this one."""
        return self._elapsed

    def add(self, command: Command) -> None:
        """Put a command where its tick is: what waited for its time is told of a little late."""
        later: list[Command] = []
        while self.commands and self.commands[-1].tick > command.tick:
            later.append(self.commands.pop())
        self.commands.append(command)
        self.commands.extend(reversed(later))
        self._count += 1
        self._fresh.append((self._count, command))
        if len(self.commands) > MOST_KEPT:
            self._fall()

    @property
    def told(self) -> bool:
        """Whether the face was ever told anything."""
        return not self.whole or any(
            isinstance(each.command, Keyframe)
            or (isinstance(each.command, Resumed) and each.command.held)
            for each in self.commands
        )

    def copy(self) -> Tail:
        """Return the same tail, for somebody who reads it while this one goes on."""
        twin = copy.copy(self)
        twin.before, twin.commands = self.before.on(self.before.rig), deque(self.commands)
        return twin

    def on(self, rig: Rig) -> None:
        """Go on with the same on another rig."""
        self.before = self.before.on(rig)

    def _fall(self) -> None:
        """Take what came first, and all of its tick, into what was held before."""
        self.begins, self.whole = self.commands[0].tick, False
        while self.commands and self.commands[0].tick == self.begins:
            follow(self.before, self.commands.popleft())
            self._fallen += 1

    # What the store keeps.

    def piece(self) -> Piece | None:
        """Return what the store does not have yet; None where there is nothing."""
        cut = self._fallen - self._cut >= _CUT
        if not self._fresh and not cut:
            return None
        commands = [command for _, command in self._fresh]
        ticks = [command.tick for command in commands]
        before = held_to_json(self.before.keyframes(self.begins)) if cut else []
        self._pieces += 1  # A number is not used again, whatever becomes of the commit.
        return Piece(
            number=self._pieces,
            last=max(ticks, default=self.begins) + self._elapsed,
            write=lambda: [line for each in commands for line in _plain(each, self._elapsed)],
            begins=self.begins + self._elapsed if cut else None,
            before=before,
            fresh=self._fresh[-1][0] if self._fresh else 0,
        )

    def kept(self, piece: Piece) -> None:
        """Take notice that a piece is in the store."""
        while self._fresh and self._fresh[0][0] <= piece.fresh:
            self._fresh.popleft()
        if piece.begins is not None:
            self._cut = self._fallen

    @classmethod
    def restored(
        cls,
        rig: Rig,
        pieces: Sequence[tuple[int, Sequence[Any]]],
        *,
        elapsed: int,
        begins: int | None,
        before: Sequence[Mapping[str, Any]],
    ) -> Tail:
        """Return a tail as the store has it.

        Args:
            rig: The session's; what it does not play any more is left out.
            pieces: Number and commands of each, in order.
            elapsed: Ticks that the face has lived.
            begins: Tick at which the tail begins, as stored; None is with the face.
            before: What was held there.
        """
        tail = cls(rig, elapsed=elapsed)
        lines = sorted((line for _, lines in pieces for line in lines), key=lambda line: line[0])
        if begins is not None:
            tail.begins, tail.whole = begins - elapsed, False
            follow(tail.before, Command(tail.begins, Resumed(held_from_json(before, rig))))
            lines = [line for line in lines if line[0] > begins]
        tail.commands.extend(
            Command(min(tick - elapsed, 0), command, bool(idle))
            for tick, idle, told in lines
            for command in _read(told, rig)
        )
        tail._pieces = max((number for number, _ in pieces), default=0)
        return tail


def follow(writers: Writers, command: Command) -> None:
    """Have writers hold what they do after a command."""
    for _ in writers.expire(command.tick):
        pass
    told: Sequence[Keyframe] = ()
    if isinstance(command.command, Keyframe):
        told = (command.command,)
    elif isinstance(command.command, Resumed):
        writers.clear()
        told = command.command.held
    for keyframe in told:
        with suppress(EngineError):  # On another rig, or among more writers than there may be.
            writers.take(keyframe, command.tick)


def _plain(command: Command, elapsed: int) -> list[list[Any]]:
    """Return a command as plain data; of a move to another rig the store has the rig."""
    told: Any
    if isinstance(command.command, Keyframe):
        (told,) = held_to_json([command.command])
    elif isinstance(command.command, Resumed):
        told = held_to_json(command.command.held)
    else:
        return []
    return [[command.tick + elapsed, int(command.idle), told]]


def _read(told: Any, rig: Rig) -> list[Keyframe | Resumed]:
    if isinstance(told, list):
        return [Resumed(held_from_json(told, rig))]
    return [*held_from_json([told], rig)]
