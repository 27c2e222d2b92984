"""Whether the event loop keeps up: a task that sleeps, and how late it is woken."""

from __future__ import annotations

import asyncio
import time

from .timing import Times

_SLEEP_SECONDS = 0.02
"""Fifty looks a second: what blocks the loop for 5 ms is seen one time in four or more, and the
looking costs nothing that can be measured."""


class LoopDelay:
    """The watch over one event loop.

    Attributes:
        times: How late each waking was [s].
    """

    def __init__(self) -> None:
        self.times = Times()
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Watch the running loop."""
        self._task = asyncio.create_task(self._watch(), name="loop delay")

    async def stop(self) -> None:
        """End the watch."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _watch(self) -> None:
        while True:
            due = time.perf_counter() + _SLEEP_SECONDS
            await asyncio.sleep(_SLEEP_SECONDS)
            self.times.add(max(0.0, time.perf_counter() - due))
