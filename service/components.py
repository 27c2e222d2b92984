"""Everything a route may need, made once for each application."""

from __future__ import annotations

import asyncio
import copy
import gc
import time
from dataclasses import dataclass, field
from typing import Annotated

import structlog
from fastapi import Depends
from starlette.requests import HTTPConnection
from starlette.types import Scope

from engine import Timeline, warm_kernels, warm_surface

from .access import Access
from .bodies import ModelChoice
from .bystanders import Bystanders
from .clips import DAY_SECONDS, Clips
from .commands import live_model
from .embedded import EmbeddedRunner
from .expressions import Expressions
from .guard import RateLimit
from .insight import Insight
from .kernels import Compiling, begin_compiling, compiled, end
from .keys import KeyRing
from .loop_delay import LoopDelay
from .metrics import Metrics
from .quotas import HOUR_SECONDS
from .rigs import Rigs
from .sessions import Sessions
from .settings import Settings
from .store import Store
from .tickets import Tickets

_LOG = structlog.get_logger("service")
_WARM_UP = "warm-up"
_GARBAGE = (700, 10, 1000)
"""When garbage is sought among new objects, those that stayed, and all: the last holds every thread
for 13 ms with a hundred sessions, and finds next to nothing."""
_KEYS_READ_SECONDS = 2.0
"""How soon a key that is made or taken away beside a running service counts."""


@dataclass(eq=False)
class Components:
    """The parts of a running service.

    Attributes:
        ready: Set once kernels are compiled and the first rig is built.
        stage: What is being done until then, in words.
        compiling: Kernels that are being compiled, begun before there was an application or here.
    """

    settings: Settings
    metrics: Metrics
    rate: RateLimit
    keys: KeyRing
    tickets: Tickets
    store: Store
    rigs: Rigs
    runner: EmbeddedRunner
    sessions: Sessions
    clips: Clips
    expressions: Expressions
    insight: Insight
    loop_delay: LoopDelay
    ready: asyncio.Event = field(default_factory=asyncio.Event)
    stage: str = "starting"
    compiling: Compiling | None = None
    _warming: asyncio.Task[None] | None = None
    _garbage: tuple[int, int, int] = field(default_factory=gc.get_threshold)
    _reading_keys: asyncio.Task[None] | None = None

    @classmethod
    def make(
        cls,
        settings: Settings,
        metrics: Metrics,
        rate: RateLimit,
        keys: KeyRing,
        tickets: Tickets,
    ) -> Components:
        """Wire the parts; nothing runs before `start`."""
        bystanders = Bystanders()
        store = Store(settings.database)
        keys.load(store.keys())
        keys.remember(store.clips(since=time.time() - HOUR_SECONDS))
        rigs = Rigs(
            store,
            cache_dir=settings.cache_dir / "files",
            cache_bytes=settings.max_cache_bytes,
            limit=settings.max_rigs,
            bystanders=bystanders,
        )
        runner = EmbeddedRunner(
            simulation_threads=settings.simulation_threads,
            capacity=settings.capacity_share,
            bystanders=bystanders,
        )
        sessions = Sessions(
            runner,
            rigs,
            store,
            limit=settings.max_sessions,
            viewer_limit=settings.max_viewers,
            idle_seconds=settings.session_idle_seconds,
        )
        clips = Clips(
            store,
            rigs,
            folder=settings.clips_folder,
            processes=settings.render_processes,
            limit=settings.max_clips,
            queue_limit=settings.max_queued_clips,
            max_seconds=settings.max_clip_seconds,
            max_keyframes=settings.max_keyframes,
            kept_seconds=settings.clip_days * DAY_SECONDS,
            on_end=lambda status: metrics.clips.labels(status).inc(),
            bystanders=bystanders,
        )
        expressions = Expressions(
            rigs,
            cache_dir=settings.cache_dir,
            cache_bytes=settings.max_cache_bytes,
            viewer_dir=settings.viewer_dir,
            queue_limit=settings.max_queued_expressions,
            bystanders=bystanders,
        )
        insight = Insight(queue_limit=settings.max_queued_analyses)
        return cls(
            settings,
            metrics,
            rate,
            keys,
            tickets,
            store,
            rigs,
            runner,
            sessions,
            clips,
            expressions,
            insight,
            LoopDelay(),
        )

    def seen_by(self, access: Access) -> Components:
        """Return these parts as somebody sees them, with the sessions, clips and rigs of theirs."""
        seen = copy.copy(self)
        seen.rigs = self.rigs.seen_by(access)
        seen.sessions = self.sessions.seen_by(access, seen.rigs)
        seen.clips = self.clips.seen_by(access, seen.rigs)
        return seen

    def start(self) -> None:
        """Start the threads and tasks, and warm up beside them."""
        self.clips.clean()
        self.runner.start()
        self.loop_delay.start()
        self.sessions.start()
        self._warming = asyncio.create_task(self._warm_up(), name="warm-up")
        self._reading_keys = asyncio.create_task(self._read_keys(), name="keys")

    async def stop(self) -> None:
        """Stop everything, and keep what is to be kept."""
        for task in (self._warming, self._reading_keys):
            if task is not None:
                task.cancel()
                await asyncio.gather(task, return_exceptions=True)
        await asyncio.to_thread(end, self.compiling)
        await self.clips.stop()
        await self.expressions.stop()
        await self.sessions.stop()
        await self.loop_delay.stop()
        await asyncio.to_thread(self.runner.stop)
        await asyncio.to_thread(self.insight.close)
        await asyncio.to_thread(self.rigs.close)
        self.store.close()
        gc.unfreeze()
        gc.set_threshold(*self._garbage)

    async def _read_keys(self) -> None:
        """Take notice of keys that are made and taken away; a busy database has its next try."""
        while True:
            await asyncio.sleep(_KEYS_READ_SECONDS)
            try:
                gone = self.keys.load(await self.store.aside(self.store.keys))
            except Exception:
                _LOG.exception("the keys could not be read")
            else:
                self.tickets.end_of(gone)
                self.sessions.end_sockets_of(gone)

    async def _warm_up(self) -> None:
        """Build the first rig and compile every kernel a face needs."""
        try:
            self.stage = "building the standard rig, compiling the simulation"
            if self.compiling is None:
                self.compiling = await asyncio.to_thread(begin_compiling)
            try:
                rig = await self.rigs.get("standard")
                self.stage = "compiling the simulation"
                warming = asyncio.to_thread(warm_surface, rig)
                await asyncio.gather(self.rigs.surface(rig), warming, compiled(self.compiling))
            finally:
                end(self.compiling)
            self.stage = "loading the simulation"
            await asyncio.to_thread(warm_kernels, rig)
            await self.runner.open(_WARM_UP, rig, Timeline((), 1.0), live_model(ModelChoice(), rig))
            # Asked for at once, they are answered in one tick.
            await asyncio.gather(self.runner.view(_WARM_UP), self.runner.close(_WARM_UP))
        except Exception as error:
            self.stage = f"failed: {error}"
            _LOG.exception("the service could not warm up")
            return
        # What is there now stays: looking through it again and again would stop every thread,
        # the simulation's too, for 50 ms at a time. Nor is it looked through now: next to nothing
        # of what a start makes is garbage, and to find that takes a tenth of it.
        gc.freeze()
        gc.set_threshold(*_GARBAGE)
        self.stage = "ready"
        self.ready.set()
        self.rigs.bake(rig)  # The first page is about to ask for them.
        self.clips.start()


async def parts_of(scope: Scope) -> Components:
    """Return the parts as who asks sees them; every route and socket has them from here.

    Raises:
        KeyError: If the request did not come through the guard.
        NotFound: If it names a rig, and comes with the ticket of a session that was never on it.
    """
    parts: Components = scope["app"].state.parts
    access: Access = scope["risorius.access"]
    if access.key is None and access.session is None:
        return parts
    seen = parts.seen_by(access)
    rig = scope.get("path_params", {}).get("rig")
    if rig is not None and access.session is not None:
        await seen.sessions.check_rig(access.session, rig)
    return seen


async def _parts(connection: HTTPConnection) -> Components:
    return await parts_of(connection.scope)


Parts = Annotated[Components, Depends(_parts)]
