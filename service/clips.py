"""Clips: asked for, queued, rendered, stored; a table of jobs and no broker."""

from __future__ import annotations

import asyncio
import copy
import secrets
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import structlog
from pydantic import ValidationError

from engine import EngineError, Rig, Timeline

from .access import EVERYTHING, Access
from .bodies import NewClip
from .commands import clip_timeline, how_told, live_model
from .errors import Busy, Conflict, NotFound, Refused, Unprocessable
from .explaining import explain
from .idle import seed_of, with_life
from .render_process import Order
from .renderer import Renderer
from .rigs import Rigs
from .store import ClipRow, Store

_LOG = structlog.get_logger("clips")
_FINISHED = ("done", "failed", "cancelled")


@dataclass(eq=False)
class _Job:
    """A clip on its way."""

    task: asyncio.Task[None] | None = None
    progress: float = 0.0

    def show(self, share: float) -> None:
        """Take the share of the work that is done."""
        self.progress = share


class Clips:
    """Every clip of the store, and the jobs that render them.

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
        on_end: Callable[[str], None],
    ) -> None:
        self._access = EVERYTHING
        self._store = store
        self._rigs = rigs
        self._renderer = Renderer()
        self._folder = folder
        self._limit = limit
        self._queue_limit = queue_limit
        self._max_seconds = max_seconds
        self._max_keyframes = max_keyframes
        self._on_end = on_end
        self._free = asyncio.Semaphore(processes)
        self._jobs: dict[str, _Job] = {}

    def seen_by(self, access: Access, rigs: Rigs) -> Clips:
        """Return the same clips as somebody sees them, and the rigs as they see those."""
        seen = copy.copy(self)
        seen._access, seen._rigs = access, rigs
        return seen

    def start(self) -> None:
        """Take up again what a stopped service left behind."""
        for row in self._store.clips():
            if row.status not in _FINISHED:
                try:
                    request = NewClip.model_validate(row.request)
                except ValidationError as error:
                    why = explain(error.errors(), row.request)
                    self._fail(row.id, f"this version cannot read it: {why}")
                else:
                    self._launch(row.id, request)

    async def stop(self) -> None:
        """Stop rendering; what is not done is taken up at the next start."""
        jobs = list(self._jobs.values())
        for job in jobs:
            if job.task is not None:
                job.task.cancel()
        await asyncio.gather(*(job.task for job in jobs if job.task), return_exceptions=True)
        await self._renderer.stop()

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
        timeline, _ = self._checked(clip, rig)
        if len(self._jobs) >= self._queue_limit:
            raise Busy("queue_full", f"{self._queue_limit} clips are waiting", retry_after=10)
        if self._store.clip_count() >= self._limit:
            message = f"{self._limit} clips are kept; delete one first"
            raise Busy("too_many_clips", message, retry_after=60)
        if self._access.allowance is not None:
            self._access.allowance.take_clip(timeline.duration)
        request = clip.model_copy(update={"rig": rig.id, "duration": timeline.duration})
        row = self._store.add_clip(
            secrets.token_hex(16),
            rig=rig.id,
            fps=clip.fps,
            request=request.model_dump(mode="json", exclude_unset=True),
            made_by=self._access.maker,
        )
        self._launch(row.id, clip)
        return row

    async def wait(self, clip: str, seconds: float) -> ClipRow:
        """Wait for a clip to end, `seconds` at most, and return how it stands.

        Raises:
            NotFound: If there is none of that id, or it is not theirs.
        """
        self.row(clip)  # Nobody waits for what is not there for them.
        job = self._jobs.get(clip)
        if job is not None and job.task is not None and seconds > 0:
            await asyncio.wait({job.task}, timeout=seconds)
        return self.row(clip)

    def row(self, clip: str) -> ClipRow:
        """Return a clip.

        Raises:
            NotFound: If there is none of that id, or it is not theirs.
        """
        row = self._store.clip(clip)
        if row is None or not self._access.sees(row.made_by):
            raise NotFound("unknown_clip", f"there is no clip {clip!r}")
        return row

    def rows(self) -> list[ClipRow]:
        """Return every clip that is theirs, oldest first."""
        rows = self._store.clips(self._access.key)
        return [row for row in rows if self._access.sees(row.made_by)]

    def describe(self, row: ClipRow) -> dict[str, object]:
        """Return what the API says of a clip."""
        job = self._jobs.get(row.id)
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
        }
        if row.message:
            line["message"] = row.message
        return line

    def file(self, clip: str, suffix: str) -> Path:
        """Return the path of a finished clip's file.

        Raises:
            NotFound: If there is no such clip, or its file is gone.
            Conflict: If it is not done.
        """
        row = self.row(clip)
        if row.status != "done":
            raise Conflict("clip_not_done", f"the clip is {row.status}; only a done one has files")
        path = self._path(clip, suffix)
        if not path.is_file():
            raise NotFound("file_gone", f"the file of clip {clip!r} is no longer there")
        return path

    async def remove(self, clip: str) -> None:
        """Cancel a clip that is not done; forget one that has ended.

        Raises:
            NotFound: If there is none of that id.
        """
        row = self.row(clip)
        if row.status in _FINISHED:
            self._store.remove_clip(clip)
            for suffix in ("glb", "csv"):
                self._path(clip, suffix).unlink(missing_ok=True)
            return
        self._store.keep_clip(clip, status="cancelled", message="cancelled by a client")
        self._on_end("cancelled")
        job = self._jobs.get(clip)
        if job is not None and job.task is not None:
            job.task.cancel()
            await asyncio.wait({job.task}, timeout=5.0)

    def _launch(self, clip: str, request: NewClip) -> None:
        job = self._jobs[clip] = _Job()
        job.task = asyncio.create_task(self._run(clip, request, job), name=f"clip {clip}")
        job.task.add_done_callback(lambda _: self._jobs.pop(clip, None))

    async def _run(self, clip: str, request: NewClip, job: _Job) -> None:
        try:
            async with self._free:
                self._store.keep_clip(clip, status="running")
                report = await self._render(clip, request, job)
        except (EngineError, Refused) as error:
            self._fail(clip, str(error))
        except Exception:
            _LOG.exception("a clip could not be rendered", clip=clip)
            self._fail(clip, "the clip could not be rendered; the service's log says why")
        else:
            self._store.keep_clip(clip, status="done", report=report)
            self._on_end("done")

    async def _render(self, clip: str, request: NewClip, job: _Job) -> Mapping[str, Any]:
        rig = await self._rigs.get(request.rig)
        root, steps = await self._rigs.made_from(request.rig)
        timeline, warnings = self._checked(request, rig)
        textures = await self._rigs.textures(rig) if request.textures else {}
        await asyncio.to_thread(self._folder.mkdir, parents=True, exist_ok=True)
        order = Order(
            root=root,
            steps=steps,
            timeline=timeline,
            fps=request.fps,
            model=live_model(request.model, rig),
            start=request.start,
            level=request.level,
            textures=textures,
            glb=self._path(clip, "glb"),
            csv=self._path(clip, "csv"),
            seed=seed_of(request),
            **how_told(request),
        )
        figures = await self._renderer.render(order, job.show)
        seconds = figures["simulation_seconds"] + figures["writing_seconds"]
        return {
            **figures,
            "times_real_time": round(timeline.duration / max(seconds, 1e-3), 2),
            "scales": sorted({keyframe.scale for keyframe in request.timeline}),
            "warnings": warnings,
        }

    def _checked(self, clip: NewClip, rig: Rig) -> tuple[Timeline, list[str]]:
        if len(clip.timeline) > self._max_keyframes:
            message = f"timeline: {len(clip.timeline)} keyframes; at most {self._max_keyframes}"
            raise Unprocessable("too_many_keyframes", message)
        timeline, warnings = clip_timeline(clip, rig)
        if timeline.duration > self._max_seconds:
            message = f"the clip lasts {timeline.duration:g} s; at most {self._max_seconds:g} s"
            if clip.start:
                message += f", with the {clip.start:g} s that are played before it begins"
            raise Unprocessable("clip_too_long", message)
        return with_life(timeline, clip, rig), warnings

    def _fail(self, clip: str, message: str) -> None:
        self._store.keep_clip(clip, status="failed", message=message)
        self._on_end("failed")

    def _path(self, clip: str, suffix: str) -> Path:
        return self._folder / f"{clip}.{suffix}"
