"""Processes that make things beside live faces, which do not feel them."""

from __future__ import annotations

import asyncio
import pickle
from asyncio.subprocess import Process
from contextlib import suppress
from typing import Any

from .bystanders import Bystanders
from .kept_processes import KeptProcesses
from .workbench import LENGTH_BYTES, Made, NotMade


class WorkEnded(Exception):
    """A process ended by itself in the middle of its work; its log says why."""


class Workshop:
    """Processes of one module, started when they are needed and kept for a while."""

    def __init__(
        self,
        module: str,
        *arguments: str,
        processes: int = 1,
        bystanders: Bystanders | None = None,
    ) -> None:
        self._free = asyncio.Semaphore(processes)
        self._processes = KeptProcesses(module, *arguments, bystanders=bystanders)

    async def make(self, order: object) -> Any:
        """Return what a process makes of `order`; whoever cancels it ends that process.

        Raises:
            Refused: If it cannot be made.
            WorkEnded: If the process ended, for want of memory perhaps.
        """
        async with self._free:
            process = await self._processes.take()
            try:
                answer = await _answered(process, order)
            except BaseException:
                await self._processes.end(process)
                raise
            self._processes.keep(process)
        if isinstance(answer, NotMade):
            raise answer.refusal()
        return answer.value

    async def stop(self) -> None:
        """End the processes that wait; cancel what is being made first."""
        await self._processes.stop()


async def _answered(process: Process, order: object) -> Made | NotMade:
    assert process.stdin is not None
    assert process.stdout is not None
    with suppress(ConnectionError):  # It has ended, which is seen below.
        process.stdin.write(pickle.dumps(order))
        await process.stdin.drain()
    try:
        length = int.from_bytes(await process.stdout.readexactly(LENGTH_BYTES), "little")
        answer: Made | NotMade = pickle.loads(await process.stdout.readexactly(length))
    except asyncio.IncompleteReadError:
        ended = await process.wait()
        raise WorkEnded(f"the process that worked on it ended with {ended}") from None
    return answer
