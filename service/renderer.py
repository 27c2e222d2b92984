"""Clips rendered, and trackers' files read, in processes that live faces do not feel.

In a thread each step of a clip would ask for the interpreter that live ticks and the event loop
need, and a thread that stands back may hold it while it waits for a core.
"""

from __future__ import annotations

import asyncio
import json
import pickle
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from .apart import environment
from .errors import Unprocessable
from .render_process import Order
from .track_file import LONGEST_REPORT, TrackFile
from .whole_files import part_of

_KEPT_SECONDS = 60.0
"""For which a process waits for its next clip: it takes a second to start, and 150 MB."""
_LONGEST_LINE = 2 * LONGEST_REPORT
"""Bytes of one answer: a report, and what else there is to say of a clip."""
_MODULE = f"{__package__}.render_process"


class RenderingEnded(Exception):
    """A process ended by itself in the middle of a clip; its log says why."""


class Renderer:
    """Processes that render clips, made when they are needed and kept for a while."""

    def __init__(self) -> None:
        self._idle: dict[Process, asyncio.TimerHandle] = {}

    async def render(self, order: Order, progress: Callable[[float], None]) -> Mapping[str, Any]:
        """Render a clip and return its figures; whoever cancels it ends its process.

        Args:
            order: What to render.
            progress: Told the share of the work done, 0 to 1.

        Raises:
            Unprocessable: If it cannot be played.
            RenderingEnded: If the process ended, for want of memory perhaps.
        """
        files = [path for path in (order.glb, order.csv) if path is not None]
        return await self._carried_out(order, files, progress)

    async def read(self, file: TrackFile) -> Mapping[str, Any]:
        """Read a tracker's file to its end and return what became of it.

        Raises:
            Unprocessable: If it cannot be read.
            RenderingEnded: If the process ended, for want of memory perhaps.
        """
        return await self._carried_out(file, (), lambda share: None)

    async def _carried_out(
        self, order: Order | TrackFile, files: Sequence[Path], progress: Callable[[float], None]
    ) -> Mapping[str, Any]:
        """Have a process do it, which ends if it does not come to an end of it."""
        process = await self._process()
        try:
            figures = await _answered(process, order, progress)
        except Unprocessable:
            self._keep(process)
            raise
        except BaseException:
            await _end(process)
            for path in files:  # It had no time to do so where it was killed.
                part_of(path, process.pid).unlink(missing_ok=True)
            raise
        self._keep(process)
        return figures

    async def stop(self) -> None:
        """End the processes that wait; cancel what is being rendered first."""
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
            sys.executable,
            "-m",
            _MODULE,
            env=environment(),
            stdin=PIPE,
            stdout=PIPE,
            limit=_LONGEST_LINE,
        )

    def _keep(self, process: Process) -> None:
        timer = asyncio.get_running_loop().call_later(_KEPT_SECONDS, self._let_go, process)
        self._idle[process] = timer

    def _let_go(self, process: Process) -> None:
        """Tell a process that no more comes: it then ends."""
        self._idle.pop(process, None)
        assert process.stdin is not None
        process.stdin.close()


async def _answered(
    process: Process, order: Order | TrackFile, progress: Callable[[float], None]
) -> Mapping[str, Any]:
    assert process.stdin is not None
    assert process.stdout is not None
    with suppress(ConnectionError):  # It has ended, which is seen below.
        process.stdin.write(pickle.dumps(order))
        await process.stdin.drain()
    async for line in process.stdout:
        news = json.loads(line)
        if "done" in news:
            figures: Mapping[str, Any] = news["done"]
            return figures
        if "refused" in news:
            raise Unprocessable(news["error"], news["refused"])
        progress(news["progress"])
    raise RenderingEnded(f"the process that rendered it ended with {await process.wait()}")


async def _end(process: Process) -> None:
    """Kill a process."""
    with suppress(ProcessLookupError):
        process.kill()
    await process.wait()
