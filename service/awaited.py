"""Values made while somebody waits: once, however many ask, and no longer than one does."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from .errors import Busy

Value = TypeVar("Value")
_RETRY_SECONDS = 5


@dataclass(eq=False)
class _UnderWay(Generic[Value]):
    """A value being made, and how many wait for it."""

    task: asyncio.Task[Value]
    askers: int = 0


class Awaited(Generic[Value]):
    """Values under way, by key; the one that nobody waits for any more is cancelled."""

    def __init__(self, *, most: int) -> None:
        self._most = most
        self._under_way: dict[str, _UnderWay[Value]] = {}

    async def get(self, key: str, make: Callable[[], Awaitable[Value]]) -> Value:
        """Return the value of `key`, which `make` makes where it is not under way.

        Raises:
            Busy: If too many others are.
        """
        one = self._under_way.get(key)
        if one is None or one.task.done():
            if len(self._under_way) >= self._most:
                message = f"{self._most} expressions are being made; ask for this one again"
                raise Busy("queue_full", message, retry_after=_RETRY_SECONDS)
            one = self._under_way[key] = _UnderWay(asyncio.ensure_future(_run(make)))
        one.askers += 1
        try:
            # Shielded: one asker who leaves must not cancel it for the others.
            return await asyncio.shield(one.task)
        finally:
            one.askers -= 1
            if not one.askers:
                one.task.cancel()
                if self._under_way.get(key) is one:
                    del self._under_way[key]

    async def stop(self) -> None:
        """Cancel whatever is under way."""
        tasks = [one.task for one in self._under_way.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _run(make: Callable[[], Awaitable[Value]]) -> Value:
    return await make()
