"""Clips rendered, and trackers' files read, in processes that live faces do not feel.

In a thread each step of a clip would ask for the interpreter that live ticks and the event loop
need, and a thread that stands back may hold it while it waits for a core.
"""

from __future__ import annotations

import json
import pickle
from asyncio.subprocess import Process
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from .bystanders import Bystanders
from .errors import Unprocessable
from .kept_processes import KeptProcesses
from .render_process import Order
from .track_file import LONGEST_REPORT, TrackFile
from .whole_files import part_of

_LONGEST_LINE = 2 * LONGEST_REPORT
"""Bytes of one answer: a report, and what else there is to say of a clip."""


class RenderingEnded(Exception):
    """A process ended by itself in the middle of a clip; its log says why."""


class Renderer:
    """Processes that render clips, made when they are needed and kept for a while."""

    def __init__(self, bystanders: Bystanders | None = None) -> None:
        self._processes = KeptProcesses(
            "render_process", bystanders=bystanders, longest_line=_LONGEST_LINE
        )

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
        process = await self._processes.take()
        try:
            figures = await _answered(process, order, progress)
        except Unprocessable:
            self._processes.keep(process)
            raise
        except BaseException:
            await self._processes.end(process)
            for path in files:  # It had no time to do so where it was killed.
                part_of(path, process.pid).unlink(missing_ok=True)
            raise
        self._processes.keep(process)
        return figures

    async def stop(self) -> None:
        """End the processes that wait; cancel what is being rendered first."""
        await self._processes.stop()


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
