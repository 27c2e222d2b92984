"""Keeping what sessions hold: commands are answered once they are committed, many at a time.

One commit is under way at most. Whoever comes meanwhile shares the next one, so that hundreds of
commands a second take a few dozen commits, and none waits for more than two.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, Protocol

import structlog

from .errors import Busy
from .store import Store

_LOG = structlog.get_logger("sessions")


class Kept(Protocol):
    """What is kept of a session."""

    id: str
    unsaved: bool

    def to_row(self, tick: int) -> dict[str, Any]:
        """Return what the store keeps of it at `tick`."""

    def kept(self, row: Mapping[str, Any]) -> None:
        """Take notice that the store has what `to_row` returned."""


class Keeper:
    """The one who writes sessions to the store; rows go there in the order they are made in."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._waiting: dict[str, tuple[Kept, int]] = {}
        self._next: asyncio.Future[None] | None = None
        self._committing: asyncio.Task[None] | None = None

    async def keep(self, session: Kept, tick: int) -> None:
        """Return once what a session holds at `tick`, or holds later, is committed.

        Raises:
            Busy: If the store does not take it.
        """
        self._waiting[session.id] = session, tick
        if self._next is None:
            self._next = asyncio.get_running_loop().create_future()
        committed = self._next
        if self._committing is None or self._committing.done():
            self._committing = asyncio.create_task(self._commit_all(), name="keeping")
        # One who gives up takes nothing from the others.
        await asyncio.shield(committed)

    async def _commit_all(self) -> None:
        """Commit until nobody waits."""
        while (committed := self._next) is not None:
            waiting, self._waiting, self._next = self._waiting, {}, None
            error = await self._commit(waiting)
            if error is None:
                committed.set_result(None)
            else:
                committed.set_exception(error)
                committed.exception()  # Whether or not anybody still waits to be told.

    async def _commit(self, waiting: Mapping[str, tuple[Kept, int]]) -> Busy | None:
        """Write rows in one transaction; return what to tell those who wait if it fails."""
        sessions = [session for session, _ in waiting.values()]
        try:
            for session in sessions:
                session.unsaved = False  # What comes while they are saved is saved the next time.
            # No await between the making of rows and their way to the store's thread: a row must
            # not overtake a newer one.
            rows = [session.to_row(tick) for session, tick in waiting.values()]
            await self._store.aside(lambda: self._store.keep_sessions(rows))
        except Exception:
            _LOG.exception("sessions could not be saved", sessions=len(sessions))
            for session in sessions:
                session.unsaved = True
            message = "the face obeys, but the database did not take it; send it again"
            return Busy("not_kept", message)
        for session, row in zip(sessions, rows, strict=True):
            session.kept(row)
        return None
