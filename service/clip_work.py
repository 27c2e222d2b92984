"""The work on clips: each is rendered in its turn, and told of; what a stop left is taken up."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

import structlog
from pydantic import ValidationError

from engine import EngineError

from .bodies import NewClip
from .bystanders import Bystanders
from .clip_folder import GIVEN, TRACK, ClipFolder
from .clip_jobs import ClipJob
from .clip_requests import Bounds, Played, played_by, request_of
from .commands import how_told, live_model
from .errors import Refused
from .explaining import explain
from .render_process import Order
from .renderer import Renderer
from .rigs import Rigs
from .store import FINISHED, Store
from .track_file import TrackFile
from .tracks import TrackClip, options_of

_LOG = structlog.get_logger("clips")
_LET_GO_SECONDS = 5.0
"""How long whoever cancels a clip waits for its process to end."""


class ClipWork:
    """The jobs that render clips.

    Args:
        store: Told what became of each.
        rigs: All of them: whether somebody sees one is asked before a clip gets here.
        files: Where clips are written.
        processes: Clips that are rendered at a time.
        bounds: How long a clip may be.
        on_end: Told the state in which a clip ended.
        bystanders: Where the processes are that render.
    """

    def __init__(
        self,
        store: Store,
        rigs: Rigs,
        files: ClipFolder,
        *,
        processes: int,
        bounds: Bounds,
        on_end: Callable[[str], None],
        bystanders: Bystanders | None,
    ) -> None:
        self._store = store
        self._rigs = rigs
        self._files = files
        self._bounds = bounds
        self._on_end = on_end
        self._renderer = Renderer(bystanders)
        self._free = asyncio.Semaphore(processes)
        self._reading = asyncio.Semaphore(1)
        self._jobs: dict[str, ClipJob] = {}

    def __len__(self) -> int:
        """Return how many clips are waiting or being rendered."""
        return len(self._jobs)

    def start(self) -> None:
        """Take up again what a stopped service left behind."""
        for row in self._store.clips():
            if row.status not in FINISHED:
                try:
                    request = request_of(row)
                except ValidationError as error:
                    why = explain(error.errors(), row.request)
                    self._fail(row.id, f"this version cannot read it: {why}")
                else:
                    self.begin(row.id, request)

    async def stop(self) -> None:
        """Stop rendering; what is not done is taken up at the next start."""
        tasks = [job.task for job in self._jobs.values() if job.task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await self._renderer.stop()

    def job(self, clip: str) -> ClipJob | None:
        """Return the work on a clip, None if it has ended."""
        return self._jobs.get(clip)

    async def read(self, file: TrackFile) -> Mapping[str, Any]:
        """Read a tracker's file to its end and return what became of it.

        One at a time, and not behind clips that are being rendered.

        Raises:
            Unprocessable: If it cannot be read.
            RenderingEnded: If the process ended, for want of memory perhaps.
        """
        async with self._reading:
            return await self._renderer.read(file)

    def begin(self, clip: str, request: NewClip | TrackClip) -> None:
        """Render a clip once it is its turn."""
        job = self._jobs[clip] = ClipJob()
        job.task = asyncio.create_task(self._run(clip, request, job), name=f"clip {clip}")

        def ended(_task: object) -> None:
            self._jobs.pop(clip, None)
            job.tell()

        job.task.add_done_callback(ended)

    async def cancel(self, clip: str) -> None:
        """Stop the work on a clip for good."""
        self._store.keep_clip(clip, status="cancelled", message="cancelled by a client")
        self._on_end("cancelled")
        job = self._jobs.get(clip)
        if job is not None and job.task is not None:
            job.task.cancel()
            await asyncio.wait({job.task}, timeout=_LET_GO_SECONDS)
        self._files.remove(clip)

    async def _run(self, clip: str, request: NewClip | TrackClip, job: ClipJob) -> None:
        try:
            async with self._free:
                self._store.keep_clip(clip, status="running")
                job.tell()
                report = await self._render(clip, request, job)
        except (EngineError, Refused) as error:
            self._fail(clip, str(error))
        except Exception:
            _LOG.exception("a clip could not be rendered", clip=clip)
            self._fail(clip, "the clip could not be rendered; the service's log says why")
        else:
            self._store.keep_clip(clip, status="done", report=report)
            self._files.remove(clip, TRACK)
            self._on_end("done")

    async def _render(
        self, clip: str, request: NewClip | TrackClip, job: ClipJob
    ) -> Mapping[str, Any]:
        rig = await self._rigs.get(request.rig)
        root, steps = await self._rigs.made_from(request.rig)
        if isinstance(request, TrackClip):
            options = options_of(request, self._bounds.seconds)
            played: Played[Any] = Played(TrackFile(self._files.path(clip, TRACK), options))
        else:
            played = played_by(request, rig, self._bounds)
        textures = await self._rigs.textures(rig) if request.textures else {}
        await asyncio.to_thread(self._files.folder.mkdir, parents=True, exist_ok=True)
        order = Order(
            root=root,
            steps=steps,
            timeline=played.timeline,
            fps=request.fps,
            model=live_model(played.model, rig),
            start=played.start,
            level=request.level,
            textures=textures,
            glb=self._files.path(clip, GIVEN[0]),
            csv=self._files.path(clip, GIVEN[1]),
            seed=played.seed,
            **how_told(request),
        )
        figures = await self._renderer.render(order, job.show)
        seconds = figures["simulation_seconds"] + figures["writing_seconds"]
        notes = figures["track"]["notes"] if "track" in figures else []
        return {
            **figures,
            "times_real_time": round((figures["duration"] + played.start) / max(seconds, 1e-3), 2),
            "scales": played.scales,
            "warnings": [*played.warnings, *notes],
        }

    def _fail(self, clip: str, message: str) -> None:
        self._store.keep_clip(clip, status="failed", message=message)
        self._files.remove(clip)
        self._on_end("failed")
