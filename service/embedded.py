"""The runner inside this process: one simulation thread owns every simulator, at a fixed 60 Hz.

Building has a bounded pool of its own, whose threads stand back: it never queues ahead of live
ticks, nor takes a core that they want.
"""

from __future__ import annotations

import asyncio
import math
import sys
import threading
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field

import structlog

from engine import (
    LONGEST_ONSET,
    EngineError,
    Frame,
    Idle,
    Keyframe,
    Model,
    Rig,
    Simulator,
    Timeline,
    end_of_life,
    idle_keyframes,
)

from .bystanders import Bystanders
from .errors import Busy, NotFound
from .lives import Lives
from .load import TICK_SECONDS, Load
from .mailbox import Mailbox
from .priority import AWAITED, background_pool
from .runner import Look, Move, Played, Tick, View
from .schedule import MOST_COMING, Schedule
from .timing import Times
from .writers import with_writers

_LOG = structlog.get_logger("runner")
_LATE_SECONDS = TICK_SECONDS / 2
"""From which on a tick counts as late: its frame then misses the picture of a display at 60 Hz."""
_FULL_SECONDS = 0.3 * TICK_SECONDS
"""Of a tick, from which on the next one is stepped without bystanders: less has time to spare."""
_SWITCH_SECONDS = 0.0005
"""How long one thread may hold the interpreter while another waits for it. A tick asks for it after
each kernel call; beside a busy thread, one tick in a hundred waited 12 ms for it with the default
of 5 ms, and 3 to 7 ms with this."""
_FIRST_TICKS = 3
"""Ticks of a new simulator that do not tell what a face costs: they load compiled kernels."""


@dataclass
class Counters:
    """What the simulation thread counts.

    Attributes:
        ticks: Ticks stepped.
        overruns: Ticks that ended late, by more than half a tick.
        resets: Faces put back to rest because their numbers ran away.
        busy_seconds: Time spent stepping.
        awake: Faces that the last tick left awake.
        last_tick_seconds: Time the last tick took.
        durations: Times that ticks took, answers to commands included [s].
        lateness: How far behind its due time each tick ended [s].
        waits: How long commands waited for their tick [s].
    """

    ticks: int = 0
    overruns: int = 0
    resets: int = 0
    busy_seconds: float = 0.0
    awake: int = 0
    last_tick_seconds: float = 0.0
    durations: Times = field(default_factory=Times)
    lateness: Times = field(default_factory=Times)
    waits: Times = field(default_factory=Times)


@dataclass(eq=False)
class _Group:
    """One simulator and which of its faces may move.

    Attributes:
        rig: Of all its faces.
        model: Of all its faces.
        simulator: Owned by the simulation thread.
        awake: Faces that were not asleep after the last tick.
        waiting: Faces, asleep or not, whose commands let go by themselves: ticks until then.
        schedule: Keyframes that are still to come, by `ticks`.
        lives: What its faces do by themselves, by `ticks`.
        played: Those that took effect and were not told of yet.
        ticks: Ticks stepped.
    """

    rig: Rig
    model: Model
    simulator: Simulator
    awake: set[str] = field(default_factory=set)
    waiting: dict[str, int] = field(default_factory=dict)
    schedule: Schedule = field(default_factory=Schedule)
    lives: Lives = field(default_factory=Lives)
    played: list[Played] = field(default_factory=list)
    ticks: int = 0

    @property
    def runs(self) -> bool:
        """Whether its time goes on."""
        return bool(self.awake or self.waiting) or not (self.schedule.empty and self.lives.empty)

    def step(self) -> dict[str, Frame]:
        """Advance one tick and return the frames of the faces that moved."""
        self.play_due()
        frames = self.simulator.step()
        self.ticks += 1
        self.awake = {face for face, frame in frames.items() if not frame.asleep}
        self.waiting = {face: left - 1 for face, left in self.waiting.items() if left > 0}
        return frames

    def play_due(self) -> None:
        """Apply the keyframes whose time has come."""
        for face, keyframe in () if self.schedule.empty else self.schedule.due(self.ticks):
            try:
                self.play(face, keyframe)
            except EngineError as error:  # Others hold the layer, or the rig has been edited.
                _LOG.warning("a keyframe was not played", session=face, reason=str(error))
        for face, keyframe in self.lives.due(self.ticks):
            with suppress(EngineError):  # For the same reasons; nobody waits for it.
                self.play(face, keyframe, idle=True)

    def play(self, face: str, keyframe: Keyframe, *, idle: bool = False) -> None:
        """Apply a keyframe now, to be told of later.

        Raises:
            EngineError: If the face cannot play it.
        """
        tick = self.simulator.apply(face, keyframe)
        self.awake.add(face)
        self.played.append(Played(face, tick, keyframe, idle))

    def live(self, face: str, idle: Idle | None) -> None:
        """Have a face live by itself from now on, in place of the life that it has."""
        if self.lives.leave(face, self.ticks) is not None:
            self.play(face, end_of_life(), idle=True)
        if idle is not None:
            self.lives.begin(face, idle_keyframes(idle, self.rig.action_units), self.ticks)

    def pause(self, face: str) -> None:
        """Have a face's life wait, and the face come to rest."""
        if self.lives.pause(face, self.ticks):
            self.play(face, end_of_life(), idle=True)

    def forget(self, face: str) -> None:
        """Take a face off the lists."""
        self.schedule.leave(face, self.ticks)
        self.awake.discard(face)
        self.waiting.pop(face, None)


class EmbeddedRunner:
    """Every face in this process, on one simulation thread."""

    def __init__(
        self,
        *,
        simulation_threads: int = 1,
        capacity: float = 1.0,
        bystanders: Bystanders | None = None,
    ) -> None:
        """Make a runner; nothing runs before `start`.

        Args:
            simulation_threads: Live faces stepped at a time.
            capacity: Share of a tick that awake faces may take before new ones are refused.
            bystanders: Held while a tick is stepped, where ticks are full.
        """
        self.counters = Counters()
        self.load = Load(threads=simulation_threads, share=capacity)
        self._threads = simulation_threads
        self._bystanders = bystanders or Bystanders()
        self._mailbox = Mailbox()
        self._groups: list[_Group] = []
        self._home: dict[str, _Group] = {}
        self._pending: dict[str, Frame] = {}
        self._pending_resets: set[str] = set()
        self._pending_played: list[Played] = []
        self._lock = threading.Lock()
        self._wake_reader: Callable[[], None] = _nothing
        self._build_pool = background_pool(1, "build", steps=AWAITED)
        self._step_pool = ThreadPoolExecutor(simulation_threads, thread_name_prefix="step")
        self._thread = threading.Thread(target=self._run, name="simulation", daemon=True)

    def start(self) -> None:
        """Start the simulation thread, and let threads change places more often."""
        sys.setswitchinterval(min(sys.getswitchinterval(), _SWITCH_SECONDS))
        self._thread.start()

    def stop(self) -> None:
        """Stop every thread."""
        self._mailbox.stop()
        if self._thread.is_alive():
            self._thread.join()
        for pool in (self._build_pool, self._step_pool):
            pool.shutdown(wait=True, cancel_futures=True)

    @property
    def alive(self) -> bool:
        """Whether the simulation thread runs."""
        return self._thread.is_alive()

    # The verbs, on the event loop's thread.

    async def admit(self) -> None:
        """Return if there is room for one more face that moves."""
        await self._mailbox.ask(lambda: self.load.admit(self._awake_count()))

    async def open(self, session: str, rig: Rig, timeline: Timeline, model: Model) -> None:
        """Make a face and apply the keyframes of `timeline`, whose times do not count."""
        spare = await self._spare(rig, model)
        await self._mailbox.ask(lambda: self._open(session, rig, model, timeline.keyframes, spare))

    async def apply(self, session: str, command: Keyframe | Move) -> int:
        """Put a command in the mailbox; return the tick at which it takes effect."""
        if isinstance(command, Keyframe):
            asked = time.perf_counter()
            return await self._mailbox.ask(lambda: self._obey(session, command, asked))
        model = (await self._mailbox.ask(lambda: self._group(session))).model
        spare = await self._spare(command.rig, model)
        return await self._mailbox.ask(lambda: self._move(session, command.rig, spare))

    async def perform(self, session: str, keyframes: Sequence[Keyframe]) -> int:
        """Play keyframes at their times from the next tick on; return that tick."""
        return await self._mailbox.ask(lambda: self._perform(session, keyframes))

    async def live(self, session: str, idle: Idle | None) -> int:
        """Have a face live by itself from the next tick on; return that tick."""
        return await self._mailbox.ask(lambda: self._live(session, idle))

    async def pause(self, session: str) -> None:
        """Have the life of a face wait, and the face come to rest."""
        await self._mailbox.ask(lambda: self._group(session).pause(session))

    async def resume(self, session: str) -> None:
        """Have the life of a face that waits go on where it stopped."""
        await self._mailbox.ask(lambda: self._resume(session))

    async def close(self, session: str) -> None:
        """Forget the face."""
        await self._mailbox.ask(lambda: self._close(session))

    async def view(self, session: str) -> View:
        """Return the face as it stands."""
        frame, report = await self._mailbox.ask(lambda: self._view(session))
        # On who asks, not between two ticks: told to whoever watches, it is asked for all the time.
        return View(frame, with_writers(report))

    async def look(self, session: str) -> Look:
        """Return the face with all of its tissue, copied between two ticks."""
        return await self._mailbox.ask(lambda: self._look(session))

    async def ticks(self) -> AsyncIterator[Tick]:
        """Yield what moved, in batches; a slow reader gets fewer, newer frames."""
        loop = asyncio.get_running_loop()
        news = asyncio.Event()

        def wake() -> None:
            loop.call_soon_threadsafe(news.set)

        self._wake_reader = wake
        try:
            while True:
                await news.wait()
                news.clear()
                with self._lock:
                    frames, self._pending = self._pending, {}
                    reset, self._pending_resets = frozenset(self._pending_resets), set()
                    played, self._pending_played = self._pending_played, []
                yield Tick(frames, reset, played)
        finally:
            self._wake_reader = _nothing

    async def _spare(self, rig: Rig, model: Model) -> Simulator | None:
        """Build a simulator beside the simulation thread when there is none of that kind."""
        if self._room(rig, model) is not None:
            return None
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._build_pool, lambda: self._simulator(rig, model))

    def _room(self, rig: Rig, model: Model) -> _Group | None:
        """Return the group that a new face of `rig` joins, if there is one."""
        for group in list(self._groups):
            if group.rig.id == rig.id and group.model == model:
                return group
        return None

    def _simulator(self, rig: Rig, model: Model) -> Simulator:
        return Simulator(rig, model=model, threads=self._threads)

    # What the simulation thread does.

    def _run(self) -> None:
        try:
            self._tick_until_stopped()
        except Exception:
            _LOG.exception("the simulation thread ended")
        finally:
            self._mailbox.end()

    def _tick_until_stopped(self) -> None:
        due = 0.0  # When the tick that is next has to be done.
        while True:
            awake = self._runs()
            if awake and self.counters.last_tick_seconds > _FULL_SECONDS:
                self._bystanders.hold()
            try:
                started = time.perf_counter()
                if not self._mailbox.answer_all(block=not awake):
                    return
                if not self._runs():
                    continue
                if not awake:  # Nothing ran until now: time begins with what was just asked for.
                    started = time.perf_counter()
                    due = started + TICK_SECONDS
                stepped = self._step()
            finally:
                self._bystanders.let_go()
            due = self._pace(started, due, stepped)

    def _pace(self, started: float, due: float, stepped: int) -> float:
        """Count a tick and sleep until the next one is to begin.

        What is late is made up for by shorter sleeps, up to one tick; beyond that the faces slow
        down instead of skipping.

        Args:
            started: When the tick began [s].
            due: When it had to be done [s].
            stepped: Faces that took its time; 0 if they do not tell what faces cost.

        Returns:
            When the next one has to be done [s].
        """
        now = time.perf_counter()
        late = max(0.0, now - due)
        self._count(now - started, late, stepped)
        if now < due:
            time.sleep(due - now)
        return max(due, now - TICK_SECONDS) + TICK_SECONDS

    def _runs(self) -> bool:
        return any(group.runs for group in self._groups)

    def _awake_count(self) -> int:
        return sum(len(group.awake) for group in self._groups)

    def _step(self) -> int:
        """Step every simulator that has a face awake, several at once when there are several.

        Returns:
            How many faces took the time of the tick; 0 while a simulator is too new to tell.
        """
        moving = [group for group in self._groups if group.runs]
        if len(moving) == 1:
            results = [self._step_group(moving[0])]
        else:
            results = list(self._step_pool.map(self._step_group, moving))
        self.counters.awake = self._awake_count()
        frames = {face: frame for result in results for face, frame in result.items()}
        if frames:
            self._publish(frames)
        return len(frames) if all(group.ticks > _FIRST_TICKS for group in moving) else 0

    def _step_group(self, group: _Group) -> dict[str, Frame]:
        try:
            frames = group.step()
        except Exception:
            _LOG.exception("a simulator failed; its faces go back to rest", rig=group.rig.id)
            return self._restart(group)
        self._report_played(group)
        diverged = {face for face, frame in frames.items() if frame.diverged}
        if diverged:
            _LOG.warning("faces diverged and are back at rest", sessions=sorted(diverged))
            self._report_reset(diverged)
        return frames

    def _restart(self, group: _Group) -> dict[str, Frame]:
        """Replace a simulator that raised by a new one with the same faces at rest."""
        faces = group.simulator.faces
        group.simulator = self._simulator(group.rig, group.model)
        group.awake.clear()
        group.waiting.clear()
        group.played.clear()
        for face in faces:
            group.forget(face)
        for face in faces:
            group.simulator.add(face)
        self._report_reset(set(faces))
        return {face: group.simulator.frame(face) for face in faces}

    def _report_reset(self, faces: set[str]) -> None:
        self.counters.resets += len(faces)
        with self._lock:
            self._pending_resets |= faces

    def _report_played(self, group: _Group) -> None:
        if group.played:
            with self._lock:
                self._pending_played += group.played
            group.played.clear()

    def _publish(self, frames: Mapping[str, Frame]) -> None:
        with self._lock:
            self._pending.update(frames)
        self._wake_reader()

    def _count(self, seconds: float, late: float, stepped: int) -> None:
        counters = self.counters
        counters.ticks += 1
        counters.overruns += late > _LATE_SECONDS
        counters.busy_seconds += seconds
        counters.last_tick_seconds = seconds
        counters.durations.add(seconds)
        counters.lateness.add(late)
        self.load.note(seconds, stepped)

    def _group(self, session: str) -> _Group:
        group = self._home.get(session)
        if group is None:
            raise NotFound("unknown_session", f"there is no session {session!r}")
        return group

    def _open(
        self,
        session: str,
        rig: Rig,
        model: Model,
        keyframes: Sequence[Keyframe],
        spare: Simulator | None,
    ) -> None:
        group = self._join(rig, model, spare)
        group.simulator.add(session)
        self._home[session] = group
        for keyframe in keyframes:
            self._apply(session, keyframe)
        self._wake(session, group)

    def _join(self, rig: Rig, model: Model, spare: Simulator | None) -> _Group:
        group = self._room(rig, model)
        if group is None:
            group = _Group(rig, model, spare or self._simulator(rig, model))
            self._groups.append(group)
        return group

    def _wake(self, session: str, group: _Group) -> None:
        group.awake.add(session)
        self._publish({session: group.simulator.frame(session)})

    def _apply(self, session: str, keyframe: Keyframe) -> int:
        group = self._group(session)
        tick = group.simulator.apply(session, keyframe)
        group.awake.add(session)
        if keyframe.hold is not None or keyframe.ttl is not None:
            fade = LONGEST_ONSET if keyframe.fade is None else keyframe.fade
            ends = [math.inf if keyframe.ttl is None else keyframe.ttl]
            ends += [] if keyframe.hold is None else [fade + keyframe.hold]
            left = math.ceil(min(ends) * Simulator.TICKS_PER_SECOND) + 2
            group.waiting[session] = max(left, group.waiting.get(session, 0))
        return tick

    def _obey(self, session: str, keyframe: Keyframe, asked: float) -> int:
        """Apply what was asked for at `asked` [s], and note how long it waited."""
        self.counters.waits.add(max(0.0, time.perf_counter() - asked))
        return self._apply(session, keyframe)

    def _perform(self, session: str, keyframes: Sequence[Keyframe]) -> int:
        group = self._group(session)
        if group.schedule.coming(session) + len(keyframes) > MOST_COMING:
            message = f"at most {MOST_COMING} keyframes wait for one face; stop a speech first"
            raise Busy("too_much_to_come", message)
        group.schedule.plan(session, keyframes, group.ticks)
        return group.simulator.frame(session).tick

    def _live(self, session: str, idle: Idle | None) -> int:
        group = self._group(session)
        group.live(session, idle)
        return group.simulator.frame(session).tick

    def _resume(self, session: str) -> None:
        group = self._group(session)
        group.lives.resume(session, group.ticks)

    def _move(self, session: str, rig: Rig, spare: Simulator | None) -> int:
        old = self._group(session)
        new = self._join(rig, old.model, spare)
        if new is old:
            return old.simulator.frame(session).tick
        new.simulator.add(session, state=old.simulator.remove(session))
        new.schedule.carry_on(session, old.schedule.leave(session, old.ticks), new.ticks)
        new.lives.carry_on(session, old.lives.leave(session, old.ticks), new.ticks)
        if session in old.waiting:
            new.waiting[session] = old.waiting[session]
        self._leave(session, old)
        self._home[session] = new
        self._wake(session, new)
        return new.simulator.frame(session).tick

    def _close(self, session: str) -> None:
        group = self._group(session)
        group.simulator.remove(session)
        del self._home[session]
        self._leave(session, group)
        with self._lock:
            self._pending.pop(session, None)

    def _leave(self, session: str, group: _Group) -> None:
        """Drop a simulator that has no faces left."""
        group.forget(session)
        group.lives.leave(session, group.ticks)
        if not group.simulator.faces:
            self._groups.remove(group)

    def _view(self, session: str) -> tuple[Frame, Mapping[str, object]]:
        simulator = self._group(session).simulator
        return simulator.frame(session), simulator.report(session)

    def _look(self, session: str) -> Look:
        simulator = self._group(session).simulator
        return Look(simulator.snapshot(session), simulator.report(session))


def _nothing() -> None:
    """Wake nobody: no reader has come yet."""
