"""The runner: how the rest of the service reaches simulators, wherever they live.

It is the seam for several machines: only plain, frozen data crosses it. `EmbeddedRunner` keeps
everything in this process.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from engine import Frame, Idle, Keyframe, Model, Rig, Snapshot, Timeline


@dataclass(frozen=True)
class Move:
    """A command besides keyframes: carry the face, as it stands, over to another rig."""

    rig: Rig


@dataclass(frozen=True)
class Played:
    """A keyframe that waited for its time, and the tick at which it took effect.

    Attributes:
        session: Whose face.
        tick: When.
        keyframe: Which.
        idle: Whether the face did it by itself.
    """

    session: str
    tick: int
    keyframe: Keyframe
    idle: bool = False


@dataclass(frozen=True, eq=False)
class Tick:
    """What faces did since the last tick handed out: the newest frame of each that moved.

    Attributes:
        frames: Session to its newest frame.
        reset: Sessions whose numbers ran away; their faces are back at rest.
        played: What waited for its time and took effect: session, tick and keyframe, in order.
    """

    frames: Mapping[str, Frame]
    reset: frozenset[str] = frozenset()
    played: Sequence[Played] = ()


@dataclass(frozen=True, eq=False)
class View:
    """A face as it stands: its frame, and what its layers hold."""

    frame: Frame
    report: Mapping[str, object]


@dataclass(frozen=True, eq=False)
class Look:
    """A face with all of its tissue, and what its layers hold."""

    snapshot: Snapshot
    report: Mapping[str, Any]


class Runner(Protocol):
    """The verbs by which the service drives faces; `view` looks without changing anything."""

    async def admit(self) -> None:
        """Return if there is room for one more face that moves; ask before `open` of a new one.

        Raises:
            AtCapacity: If those that are awake take as much of a tick as they may.
            Busy: If the simulation has stopped.
        """

    async def open(self, session: str, rig: Rig, timeline: Timeline, model: Model) -> None:
        """Make a face and apply the keyframes of `timeline`, whose times do not count."""

    async def apply(self, session: str, command: Keyframe | Move) -> int:
        """Put a command in the mailbox; return the tick at which it takes effect.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def perform(self, session: str, keyframes: Sequence[Keyframe]) -> int:
        """Play keyframes at their times from the next tick on; return that tick.

        They take the place of what the same owners still have to come in the same layers.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped, or too much waits for the face already.
        """

    async def live(self, session: str, idle: Idle | None) -> int:
        """Have a face live by itself from the next tick on; return that tick.

        The life that it has ends, and with None it has no other.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def pause(self, session: str) -> None:
        """Have the life of a face, if it has one, wait, and the face come to rest.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def resume(self, session: str) -> None:
        """Have the life of a face that waits go on where it stopped.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def close(self, session: str) -> None:
        """Forget the face.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def view(self, session: str) -> View:
        """Return the face as it stands.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    async def look(self, session: str) -> Look:
        """Return the face with all of its tissue, copied between two ticks.

        Raises:
            NotFound: If there is no such face.
            Busy: If the simulation has stopped.
        """

    def ticks(self) -> AsyncIterator[Tick]:
        """Yield what moved, in batches; a slow reader gets fewer, newer frames."""
