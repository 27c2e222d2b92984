"""Processes that make things beside live faces, which do not feel them."""

from __future__ import annotations

import asyncio
import pickle
import sys
from asyncio.subprocess import PIPE, Process
from contextlib import suppress
from typing import Any

from .apart import environment
from .workbench import LENGTH_BYTES, Made, NotMade

_KEPT_SECONDS = 60.0
"""For which a process waits for its next order: to start one takes a second or more."""


class WorkEnded(Exception):
    """A process ended by itself in the middle of its work; its log says why."""


class Workshop:
    """Processes of one module, started when they are needed and kept for a while."""

    def __init__(self, module: str, *arguments: str, processes: int = 1) -> None:
        self._command = (sys.executable, "-m", f"{__package__}.{module}", *arguments)
        self._free = asyncio.Semaphore(processes)
        self._idle: dict[Process, asyncio.TimerHandle] = {}

    async def make(self, order: object) -> Any:
        """Return what a process makes of `order`; whoever cancels it ends that process.

        Raises:
            Refused: If it cannot be made.
            WorkEnded: If the process ended, for want of memory perhaps.
        """
        async with self._free:
            process = await self._process()
            try:
                answer = await _answered(process, order)
            except BaseException:
                await _end(process)
                raise
            timer = asyncio.get_running_loop().call_later(_KEPT_SECONDS, self._let_go, process)
            self._idle[process] = timer
        if isinstance(answer, NotMade):
            raise answer.refusal()
        return answer.value

    async def stop(self) -> None:
        """End the processes that wait; cancel what is being made first."""
        for process in list(self._idle):
            self._idle.pop(process).cancel()
            await _end(process)

    async def _process(self) -> Process:
        while self._idle:
            process, timer = self._idle.popitem()
            timer.cancel()
            if process.returncode is None:
                return process
        return await asyncio.create_subprocess_exec(
            *self._command, env=environment(), stdin=PIPE, stdout=PIPE
        )

    def _let_go(self, process: Process) -> None:
        """Tell a process that no more comes: it then ends."""
        self._idle.pop(process, None)
        assert process.stdin is not None
        process.stdin.close()


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


async def _end(process: Process) -> None:
    """Kill a process."""
    with suppress(ProcessLookupError):
        process.kill()
    await process.wait()
