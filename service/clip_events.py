"""How a clip goes on, told to whoever listens: server-sent events, the newest news only.

Each event is the whole description of the clip, so that one who comes late, comes again or reads
slowly misses nothing that still matters, and nothing waits for anybody.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import suppress

from .clips import Clips
from .errors import Busy, NotFound
from .store import FINISHED, ClipRow

MOST_WATCHERS = 64
"""Streams of one clip at once."""
_SILENT_SECONDS = 15.0
"""After which a comment says that the stream is there still: proxies close silent ones."""
_AGAIN_MILLISECONDS = 2000
"""After which a browser whose stream broke off is to ask again."""
_NOT_BEGUN_SECONDS = 1.0
"""After which a clip is looked at again that a service has not taken up since its start."""


def has_heard(row: ClipRow, last_event: str) -> bool:
    """Return whether somebody who comes again has been told the end of a clip already."""
    return row.status in FINISHED and last_event == _id(row)


def clip_events(clips: Clips, clip: str, welcome: Callable[[], bool]) -> AsyncGenerator[str]:
    """Return events until a clip has ended, or is forgotten.

    Args:
        clips: As somebody sees them.
        clip: Which.
        welcome: Whether they may still be told.

    Raises:
        Busy: If as many listen as may.
    """
    job = clips.job(clip)
    if job is not None and job.watchers >= MOST_WATCHERS:
        raise Busy("too_many_watchers", f"{MOST_WATCHERS} listen to that clip", retry_after=10)
    return _events(clips, clip, welcome)


async def _events(clips: Clips, clip: str, welcome: Callable[[], bool]) -> AsyncGenerator[str]:
    watched, told = clips.job(clip), None
    if watched is not None:
        watched.watchers += 1
    try:
        yield f"retry: {_AGAIN_MILLISECONDS}\n\n"
        with suppress(NotFound):  # It is forgotten meanwhile.
            while welcome():
                job = clips.job(clip)
                # Taken before it is looked at how far it is, so that no news comes between.
                news = None if job is None else job.news
                row = clips.row(clip)
                line = clips.describe(row)
                yield ": still here\n\n" if line == told else _event(row, line)
                if row.status in FINISHED:
                    return
                told = line
                await _pause(news)
    finally:
        if watched is not None:
            watched.watchers -= 1


async def _pause(news: asyncio.Event | None) -> None:
    """Wait for news, but not for too long."""
    with suppress(TimeoutError):
        async with asyncio.timeout(_NOT_BEGUN_SECONDS if news is None else _SILENT_SECONDS):
            await (asyncio.Event() if news is None else news).wait()


def _event(row: ClipRow, line: Mapping[str, object]) -> str:
    kind = "end" if row.status in FINISHED else "progress"
    data = json.dumps(line, allow_nan=False, separators=(",", ":"))
    return f"event: {kind}\nid: {_id(row)}\ndata: {data}\n\n"


def _id(row: ClipRow) -> str:
    return row.status
