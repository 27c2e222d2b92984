"""Processes that work for the service one order after another, kept for a while between two."""

from __future__ import annotations

import asyncio
import sys
from asyncio.subprocess import PIPE, Process
from contextlib import suppress

from .apart import bound, environment
from .bystanders import Bystanders

_KEPT_SECONDS = 60.0
"""For which a process waits for its next order: it takes a second or more to start, and 150 MB."""
_BUFFER_BYTES = 2**16
"""Bytes of an answer that are read ahead, as asyncio has it."""
_ENDING_SECONDS = 5.0
"""That a process has to put away what it opened: a browser, a folder."""


class KeptProcesses:
    """Processes of one module, started when they are needed; they read orders from their input."""

    def __init__(
        self,
        module: str,
        *arguments: str,
        bystanders: Bystanders | None = None,
        longest_line: int = _BUFFER_BYTES,
    ) -> None:
        """Start none yet.

        Args:
            module: Of this package, run by its name.
            arguments: It is run with.
            bystanders: Where they are while they have an order; without any they are never held,
                and may end after their owner.
            longest_line: Bytes of the longest line that it answers with.
        """
        alone = sys.executable, "-m", f"{__package__}.{module}"
        self._command = (*(alone if bystanders is None else bound(module)), *arguments)
        self._bystanders = bystanders or Bystanders()
        self._longest_line = longest_line
        self._idle: dict[Process, asyncio.TimerHandle] = {}

    @property
    def waiting(self) -> tuple[Process, ...]:
        """Those that wait for an order."""
        return tuple(self._idle)

    async def take(self) -> Process:
        """Return one that waits, or a new one; `keep` or `end` it afterwards.

        Raises:
            OSError: If none can be started.
        """
        process = await self._taken()
        self._bystanders.add(process.pid)
        return process

    async def _taken(self) -> Process:
        while self._idle:
            process, timer = self._idle.popitem()
            timer.cancel()
            if process.returncode is None:
                return process
        return await asyncio.create_subprocess_exec(
            *self._command,
            env=environment(),
            stdin=PIPE,
            stdout=PIPE,
            limit=self._longest_line,
        )

    def keep(self, process: Process) -> None:
        """Have one wait for its next order."""
        self._bystanders.remove(process.pid)
        timer = asyncio.get_running_loop().call_later(_KEPT_SECONDS, self._let_go, process)
        self._idle[process] = timer

    async def end(self, process: Process) -> None:
        """End one that has not come to the end of its order; it may put away what it opened."""
        self._bystanders.remove(process.pid)
        with suppress(ProcessLookupError):
            process.terminate()
        await _ended(process)

    async def stop(self) -> None:
        """Let go of those that wait, until they have ended."""
        waiting = self._idle.copy()
        for process, timer in waiting.items():
            timer.cancel()
            self._let_go(process)
        await asyncio.gather(*map(_ended, waiting))

    def _let_go(self, process: Process) -> None:
        """Tell a process that no more comes: it then ends."""
        self._idle.pop(process, None)
        assert process.stdin is not None
        process.stdin.close()


async def _ended(process: Process) -> None:
    """Wait until a process has ended; kill one that takes too long."""
    try:
        await asyncio.wait_for(process.wait(), _ENDING_SECONDS)
    except TimeoutError:
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()
