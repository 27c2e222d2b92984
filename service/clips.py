"""Clips: asked for, kept, given, forgotten; a table of jobs and no broker."""

from __future__ import annotations

import asyncio
import copy
import secrets
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import structlog

from engine import Rig

from .access import EVERYTHING, Access
from .bodies import NewClip
from .bystanders import Bystanders
from .clip_folder import ClipFolder
from .clip_jobs import ClipJob
from .clip_requests import Bounds, played_by
from .clip_work import ClipWork
from .errors import Busy, Conflict, NotFound
from .renderer import RenderingEnded
from .rigs import Rigs
from .store import FINISHED, ClipRow, Store
from .track_file import TrackFile
from .tracks import TrackClip, options_of
from .uploads import Upload

_LOG = structlog.get_logger("clips")
DAY_SECONDS = 86_400.0
_SWEEP_SECONDS = 60.0
"""After which it is looked again for clips that were kept for long enough."""


class Clips:
    """Every clip of the store, and the work on those that have not ended.

    `seen_by` gives them as somebody sees them, to whom those of others are not there.
    """

    def __init__(
        self,
        store: Store,
        rigs: Rigs,
        *,
        folder: Path,
        processes: int,
        limit: int,
        queue_limit: int,
        max_seconds: float,
        max_keyframes: int,
        kept_seconds: float,
        on_end: Callable[[str], None],
        bystanders: Bystanders | None = None,
    ) -> None:
        self._access = EVERYTHING
        self._store = store
        self._rigs = rigs
        self._files = ClipFolder(folder)
        self._limit = limit
        self._queue_limit = queue_limit
        self._bounds = Bounds(max_seconds, max_keyframes)
        self._kept_seconds = kept_seconds
        self._work = ClipWork(
            store,
            rigs,
            self._files,
            processes=processes,
            bounds=self._bounds,
            on_end=on_end,
            bystanders=bystanders,
        )
        self._sweeping: list[asyncio.Task[None]] = []

    def seen_by(self, access: Access, rigs: Rigs) -> Clips:
        """Return the same clips as somebody sees them, and the rigs as they see those."""
        seen = copy.copy(self)
        seen._access, seen._rigs = access, rigs
        return seen

    def clean(self) -> None:
        """Remove what a killed service was in the middle of writing; nobody sends files yet."""
        unfinished = {row.id for row in self._store.clips() if row.status not in FINISHED}
        self._files.remove_strays(unfinished)

    def start(self) -> None:
        """Take up again what a stopped service left behind, and forget what is old from now on."""
        self._work.start()
        self._sweeping.append(asyncio.create_task(self._sweep(), name="old clips"))

    async def stop(self) -> None:
        """Stop rendering; what is not done is taken up at the next start."""
        for task in self._sweeping:
            task.cancel()
        await asyncio.gather(*self._sweeping, return_exceptions=True)
        await self._work.stop()

    async def submit(self, clip: NewClip) -> ClipRow:
        """Queue a clip.

        Raises:
            Unprocessable: If it cannot be played, or is too long.
            Busy: If the queue or the store is full.
            Forbidden: If it is a ticket that asks.
            QuotaExceeded: If the key asked for as much as it may.
        """
        self._access.check_whole()
        rig = await self._rigs.get(clip.rig)
        played = played_by(clip, rig, self._bounds)
        self._check_room()
        return self._queue(clip, rig, played.timeline.duration)

    async def submit_track(self, clip: TrackClip, upload: Upload) -> ClipRow:
        """Read a tracker's file to its end and queue the clip of it; the file is kept until then.

        Raises:
            Unprocessable: If it cannot be read, or a clip that is too long is asked for.
            Busy: If the queue or the store is full.
            Forbidden: If it is a ticket that asks.
            QuotaExceeded: If the key asked for as much as it may.
        """
        self._access.check_whole()
        rig = await self._rigs.get(clip.rig)
        options = options_of(clip, self._bounds.seconds)
        self._check_room()
        try:
            report = await self._work.read(TrackFile(upload.path, options))
        except RenderingEnded as error:
            _LOG.exception("a tracker's file could not be read", bytes=upload.size)
            raise Busy("not_read", "what read the file ended early; send it again") from error
        self._check_room()
        return self._queue(clip, rig, report["track"]["duration"], report, upload)

    async def wait(self, clip: str, seconds: float) -> ClipRow:
        """Wait for a clip to end, `seconds` at most, and return how it stands.

        Raises:
            NotFound: If there is none of that id, or it is not theirs.
        """
        self.row(clip)  # Nobody waits for what is not there for them.
        job = self._work.job(clip)
        if job is not None and job.task is not None and seconds > 0:
            await asyncio.wait({job.task}, timeout=seconds)
        return self.row(clip)

    def row(self, clip: str) -> ClipRow:
        """Return a clip.

        Raises:
            NotFound: If there is none of that id, or no longer, or it is not theirs.
        """
        row = self._store.clip(clip)
        if row is None or not self._access.sees(row.made_by) or self._is_old(row):
            days = self._kept_seconds / DAY_SECONDS
            message = f"there is no clip {clip!r}; one that has ended is kept for {days:g} days"
            raise NotFound("unknown_clip", message)
        return row

    def rows(self) -> list[ClipRow]:
        """Return every clip that is theirs, oldest first."""
        rows = self._store.clips(self._access.key)
        return [row for row in rows if self._access.sees(row.made_by) and not self._is_old(row)]

    @property
    def under_way(self) -> int:
        """How many clips are waiting or being rendered."""
        return len(self._work)

    def job(self, clip: str) -> ClipJob | None:
        """Return the work on a clip, None if it has ended or not begun."""
        return self._work.job(clip)

    def describe(self, row: ClipRow) -> dict[str, object]:
        """Return what the API says of a clip."""
        job = self._work.job(row.id)
        progress = 1.0 if row.status == "done" else job.progress if job else 0.0
        line: dict[str, object] = {
            "id": row.id,
            "rig": row.rig,
            "fps": row.fps,
            "status": row.status,
            "progress": round(progress, 4),
            "report": row.report,
            "created": row.created,
            "finished": row.finished,
            "expires": None if row.finished is None else row.finished + self._kept_seconds,
        }
        if row.message:
            line["message"] = row.message
        return line

    def outline(self, row: ClipRow) -> dict[str, object]:
        """Return what a list says of a clip: all but what became of a tracker's rows."""
        report = {name: value for name, value in row.report.items() if name != "track"}
        return {**self.describe(row), "report": report}

    def file(self, clip: str, suffix: str) -> Path:
        """Return the path of a finished clip's file.

        Raises:
            NotFound: If there is no such clip, or its file is gone.
            Conflict: If it is not done.
        """
        row = self.row(clip)
        if row.status != "done":
            raise Conflict("clip_not_done", f"the clip is {row.status}; only a done one has files")
        path = self._files.path(clip, suffix)
        if not path.is_file():
            raise NotFound("file_gone", f"the file of clip {clip!r} is no longer there")
        return path

    async def remove(self, clip: str) -> None:
        """Cancel a clip that is not done; forget one that has ended.

        Raises:
            NotFound: If there is none of that id.
        """
        row = self.row(clip)
        if row.status in FINISHED:
            self._forget(clip)
            return
        await self._work.cancel(clip)

    def _check_room(self) -> None:
        """Take no more clips than are rendered soon, and kept.

        Raises:
            Busy: If there are as many.
        """
        if len(self._work) >= self._queue_limit:
            raise Busy("queue_full", f"{self._queue_limit} clips are waiting", retry_after=10)
        if self._store.clip_count() >= self._limit:
            message = f"{self._limit} clips are kept; delete one first"
            raise Busy("too_many_clips", message, retry_after=60)

    def _queue(
        self,
        clip: NewClip | TrackClip,
        rig: Rig,
        duration: float,
        report: Mapping[str, Any] | None = None,
        upload: Upload | None = None,
    ) -> ClipRow:
        """Keep what was asked for, and begin with it."""
        if self._access.allowance is not None:
            self._access.allowance.take_clip(duration)
        request = clip.model_copy(update={"rig": rig.id}).model_dump(
            mode="json", exclude_unset=True
        )
        name = secrets.token_hex(16)
        if upload is not None:
            self._files.keep_track(name, upload.path)
        try:
            row = self._store.add_clip(
                name,
                rig=rig.id,
                fps=clip.fps,
                request={**request, "duration": duration},
                report=report,
                made_by=self._access.maker,
            )
        except BaseException:
            self._files.remove(name)
            raise
        self._work.begin(row.id, clip)
        return row

    def _is_old(self, row: ClipRow) -> bool:
        """Return whether a clip has been kept for long enough."""
        return row.finished is not None and row.finished < time.time() - self._kept_seconds

    def _forget(self, clip: str) -> None:
        """Forget a clip that has ended; one whose files are gone is found again after a kill."""
        self._files.remove(clip)
        self._store.remove_clip(clip)

    async def _sweep(self) -> None:
        """Forget clips once they are old."""
        while True:
            try:
                before = time.time() - self._kept_seconds
                for clip in self._store.ended_clips(before):
                    self._forget(clip)
                    await asyncio.sleep(0)
            except Exception:
                _LOG.exception("old clips could not be forgotten")
            await asyncio.sleep(_SWEEP_SECONDS)
