"""Live sessions: who watches which face, its latest frame, and what it was told."""

from __future__ import annotations

import asyncio
import copy
import json
import secrets
import time
from collections import Counter, deque
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from typing import Any

import structlog

from engine import EngineError, Frame, Idle, Keyframe, Model, Rig, Timeline, Writers, ticks

from .access import EVERYTHING, Access
from .bodies import Units
from .clashes import clashes
from .commands import held_from_json, held_to_json
from .errors import Busy, NotFound, QuotaExceeded, refused_by_engine
from .keeping import Keeper
from .outgoing import Outgoing
from .protocol import GRID_METRES, RATE, SUBPROTOCOL
from .rigs import Rigs
from .runner import Look, Move, Runner, Tick, View
from .store import SessionRow, Store
from .tail import Command, Resumed, Tail
from .viewers import Viewer

_LOG = structlog.get_logger("sessions")
_UNWATCHED_SECONDS = 60.0
"""After which the idle life of a face waits that nobody watches or asks for: it would take part of
each tick from those who are seen."""
_BEATS_PER_SECOND = 5
_SHIFTS = 4
"""Parts of the sessions that are tended in turn, so that no tick answers for all of them."""
_AT_ONCE_SECONDS = 0.001
"""For which frames are handed on without a break: of forty watched faces they take 10 ms."""
_RIGS_REMEMBERED = 64
_FORGET_SECONDS = 60
"""How often stored sessions are looked through for those that nobody uses."""
_VIEWER_LEAVES_SECONDS = 10
"""When to ask again for a viewer's place: nobody knows when one leaves."""


@dataclass(eq=False)
class Session:
    """One face, its viewers and its timeline so far.

    Attributes:
        id: Unguessable name.
        rig: The rig it is on now.
        model: Its numerical model.
        created: When it was opened [s since 1970].
        made_by: Name of the key that opened it, empty where none was asked for.
        used: When somebody last spoke to it or watched it.
        frame: Its latest frame.
        held: What each writer holds in each layer, and how long; survives a restart.
        tail: The last of its timeline.
        idle: The idle life that it has.
        paused: Whether that waits, since nobody has looked for a while.
        viewers: The sockets that watch it.
        editing: Held while a live edit derives a rig, so that edits follow each other.
        turns: How often each recipe of an emotion was played on it.
        shown: Ids of the rigs that it was on, the last ones.
        speaking: Layer and owner of what is played at its time, and the tick at which that ends.
        unsaved: Whether it holds anything that the store was not given yet.
        kept_tick: Its tick as the store was given it last.
        outgoing: Its latest frame as bytes.
    """

    id: str
    rig: Rig
    model: Model
    created: float
    used: float
    frame: Frame
    held: Writers
    tail: Tail
    made_by: str = ""
    idle: Idle | None = None
    paused: bool = False
    viewers: set[Viewer] = field(default_factory=set)
    editing: asyncio.Lock = field(default_factory=asyncio.Lock)
    turns: Counter[str] = field(default_factory=Counter)
    shown: deque[str] = field(default_factory=lambda: deque(maxlen=_RIGS_REMEMBERED))
    speaking: dict[tuple[str, str], int] = field(default_factory=dict)
    unsaved: bool = False
    kept_tick: int = 0
    state_changed: bool = False
    outgoing: Outgoing = field(default_factory=Outgoing)
    _told: tuple[Mapping[str, Any], str] | None = None

    @property
    def shift(self) -> int:
        """Which part of the sessions it is tended with."""
        return hash(self.id) % _SHIFTS

    def frame_for(self, viewer: Viewer) -> bytes:
        """Return the latest frame as bytes, in the form that a viewer asked for."""
        if viewer.packed:
            return self.outgoing.packed(self.frame, self.rig.jaw, viewer.base)
        return self.outgoing.plain(self.frame, self.rig.jaw)

    def show(self, frame: Frame) -> None:
        """Take a newer frame and wake the viewers."""
        self.state_changed |= frame.asleep and not self.frame.asleep
        self.frame = frame
        for viewer in self.viewers:
            viewer.offer_frame()

    def text_of(self, event: Mapping[str, Any]) -> str:
        """Return an event as JSON, made once for all who are told it."""
        if self._told is None or self._told[0] is not event:
            text = json.dumps(event, allow_nan=False, separators=(",", ":"))
            self._told = (event, text)
        return self._told[1]

    def tell(self, event: Mapping[str, Any]) -> None:
        """Send an event to every viewer."""
        for viewer in self.viewers:
            viewer.offer(event)

    def to_row(self, tick: int) -> dict[str, Any]:
        """Return what the store keeps of it at `tick`: not what a speech under way holds.

        A service that starts again does not go on speaking, and a mouth must not stay open.
        """
        held = held_to_json(
            keyframe
            for keyframe in self.held.keyframes(tick)
            if self.speaking.get((keyframe.layer, keyframe.owner), tick) <= tick
        )
        return {
            "id": self.id,
            "rig": self.rig.id,
            "held": held,
            "used": self.used,
            "life": self.life,
            "tick": self.tail.elapsed + tick,
            "tail": self.tail.piece(),
        }

    def kept(self, row: Mapping[str, Any]) -> None:
        """Take notice that the store has what `to_row` returned."""
        self.kept_tick = row["tick"] - self.tail.elapsed
        if row["tail"] is not None:
            self.tail.kept(row["tail"])

    @property
    def life(self) -> dict[str, float] | None:
        """Its idle life as plain data."""
        return None if self.idle is None else asdict(self.idle)

    @property
    def commands(self) -> list[Command]:
        """What it was told of late, oldest first."""
        return [each for each in self.tail.commands if not each.idle]

    @property
    def lived(self) -> list[Command]:
        """What it did by itself of late, oldest first."""
        return [each for each in self.tail.commands if each.idle]

    def describe(self) -> dict[str, object]:
        """Return what the API says of it."""
        return {
            "id": self.id,
            "rig": self.rig.id,
            "rig_name": self.rig.name,
            "model": asdict(self.model),
            "stream": f"/api/sessions/{self.id}/stream",
            "surface": f"/api/rigs/{self.rig.id}/surface.glb",
            "tick": self.frame.tick,
            "asleep": self.frame.asleep,
            "idle": self.life,
            "viewers": len(self.viewers),
            "created": self.created,
        }

    def on_rig(self) -> dict[str, object]:
        """Return what a viewer needs to know of the rig."""
        return {
            "rig": self.rig.id,
            "surface": f"/api/rigs/{self.rig.id}/surface.glb",
            "vertices": len(self.rig.head.points),
            "rate": RATE,
            "grid": GRID_METRES,
            "tick": self.frame.tick,
        }

    def clashes_of(self, command: Units, keyframe: Keyframe) -> list[str]:
        """Return what to say of a command that was applied, beside what its layer holds."""
        held = self.held.units(keyframe.layer)
        return [str(clash) for clash in clashes(command, keyframe, self.rig, held)]

    def take(self, keyframe: Keyframe, tick: int) -> list[str]:
        """Take a command that took effect at `tick`; return who stands over which of it."""
        self.lapse(tick)
        self.held.take(keyframe, tick)
        return [
            f"{', '.join(names)}: {owner!r} writes it in {keyframe.layer!r} too, and counts; "
            f"this waits beneath until {owner!r} lets go or has been quiet for half a second"
            for owner, names in self.held.beneath(keyframe).items()
        ]

    def lapse(self, tick: int) -> None:
        """Let go of the writers whose time is up at `tick`."""
        for _ in self.held.expire(tick):
            pass

    def told(self, view: View) -> dict[str, object]:
        """Return what viewers are told of what it holds."""
        return {**view.report, "idle": self.life}

    def hello(self, view: View) -> dict[str, object]:
        """Return the first event of a socket."""
        return {
            "type": "hello",
            "protocol": SUBPROTOCOL,
            "session": self.id,
            **self.on_rig(),
            "state": self.told(view),
        }


class Sessions:
    """Every session of this process; sleeping rows of the store are woken when asked for.

    `seen_by` gives them as somebody sees them, to whom those of others are not there.
    """

    def __init__(
        self,
        runner: Runner,
        rigs: Rigs,
        store: Store,
        *,
        limit: int,
        viewer_limit: int,
        idle_seconds: float,
    ) -> None:
        self._runner = runner
        self._rigs = rigs
        self._store = store
        self._limit = limit
        self._viewer_limit = viewer_limit
        self._idle_seconds = idle_seconds
        self._access = EVERYTHING
        self._keeper = Keeper(store)
        self._live: dict[str, Session] = {}
        self._opening = asyncio.Lock()
        self._tasks: list[asyncio.Task[None]] = []

    def seen_by(self, access: Access, rigs: Rigs) -> Sessions:
        """Return the same sessions as somebody sees and may use them, on rigs as they see those."""
        seen = copy.copy(self)
        seen._access, seen._rigs = access, rigs
        return seen

    def start(self) -> None:
        """Start to hand frames on."""
        self._tasks = [
            asyncio.create_task(self._hand_on(), name="frames"),
            asyncio.create_task(self._beat(), name="beat"),
        ]

    async def stop(self) -> None:
        """Save every session and let its viewers go."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for session in self._live.values():
            for viewer in session.viewers:
                viewer.end(1012, "the service stops")
        await self._save(list(self._live.values()))

    @property
    def viewer_count(self) -> int:
        """How many sockets are open."""
        return sum(len(session.viewers) for session in self._live.values())

    def lines(self) -> list[dict[str, object]]:
        """Return one line for each session, oldest first."""
        lines: list[dict[str, object]] = []
        for row in self._store.sessions(self._access.key):
            if not self._access.sees(row.made_by, session=row.id):
                continue
            session = self._live.get(row.id)
            stream = f"/api/sessions/{row.id}/stream"
            lines.append(
                session.describe()
                if session
                else {"id": row.id, "rig": row.rig, "stream": stream, "created": row.created}
            )
        return lines

    async def open(self, rig: Rig, model: Model, idle: Idle | None = None) -> Session:
        """Make a new session, which lives by itself with `idle`.

        Raises:
            AtCapacity: If the faces that are awake take as much of a tick as they may.
            Busy: If there are as many as are allowed.
            Forbidden: If it is a ticket that asks.
            QuotaExceeded: If the key has as many as it may.
        """
        self._access.check_whole()
        session_id, store = secrets.token_hex(16), self._store
        async with self._opening:
            await self._check_quota()
            if await store.aside(store.session_count) >= self._limit:
                message = f"at most {self._limit} sessions are open at once; close one first"
                raise Busy("too_many_sessions", message, retry_after=10)
            await self._runner.admit()
            try:
                row = await store.aside(
                    lambda: store.add_session(
                        session_id,
                        rig=rig.id,
                        model=asdict(model),
                        made_by=self._access.maker,
                        life=None if idle is None else asdict(idle),
                    )
                )
                return await self._wake(row, rig, model, Tail(rig))
            except BaseException:
                await asyncio.shield(self._forget(session_id))
                raise

    async def get(self, session_id: str) -> Session:
        """Return a session, woken from the store if need be, which is never refused.

        Raises:
            NotFound: If there is none of that id, or it is not theirs.
        """
        session = self._live.get(session_id)
        if session is None:
            async with self._opening:
                session = self._live.get(session_id) or await self._restore(session_id)
        if not self._access.sees(session.made_by, session=session_id):
            raise _unknown(session_id)
        session.used = time.time()
        if session.paused:
            session.paused = False
            await self._runner.resume(session.id)
        return session

    async def close(self, session_id: str) -> None:
        """End a session for good.

        Raises:
            NotFound: If there is none of that id, or it is not theirs.
            Forbidden: If it is a ticket that asks.
        """
        session = await self.get(session_id)
        self._access.check_whole()
        # First the row: who asks meanwhile must not wake the session from it again.
        await self._forget(session_id)
        if self._live.pop(session_id, None) is None:
            raise _unknown(session_id)
        for viewer in session.viewers:
            viewer.end(1000, "the session was closed")
        await self._runner.close(session_id)

    async def apply(self, session: Session, keyframe: Keyframe) -> tuple[int, list[str]]:
        """Apply a command and keep it; return the tick at which it takes effect, and warnings.

        Raises:
            Refused: If a name or a value of it does not fit the rig.
            Forbidden: If they may only watch.
            Busy: If it was applied, and could not be kept.
        """
        tick, warnings = await self.apply_unkept(session, keyframe)
        await self._keeper.keep(session, tick)
        return tick, warnings

    async def apply_unkept(self, session: Session, keyframe: Keyframe) -> tuple[int, list[str]]:
        """Apply a command that nobody waits for; it is kept within a second, or with the next one.

        Raises:
            Refused: If a name or a value of it does not fit the rig.
            Forbidden: If they may only watch.
        """
        self.check_commands()
        try:
            warnings = session.rig.check(keyframe)
            tick = await self._runner.apply(session.id, keyframe)
        except EngineError as error:
            raise refused_by_engine(error) from error
        session.tail.add(Command(tick, keyframe))
        warnings += session.take(keyframe, tick)
        session.unsaved = session.state_changed = True
        return tick, warnings

    async def perform(self, session: Session, keyframes: Sequence[Keyframe]) -> int:
        """Play keyframes, which fit the rig, at their times from now; return the first tick.

        They take the place of what the same owners still have to come in the same layers, and of
        what they hold there: that is not kept.

        Raises:
            Forbidden: If they may only watch.
            Busy: If it is played, and could not be kept.
        """
        self.check_commands()
        tick = await self._runner.perform(session.id, keyframes)
        speaking: dict[tuple[str, str], int] = {}
        for each in keyframes:
            whose, end = (each.layer, each.owner), tick + 1 + ticks(each.time + (each.ttl or 0.0))
            speaking[whose] = max(end, speaking.get(whose, end))
        others = {whose: end for whose, end in session.speaking.items() if end > tick}
        session.speaking = {**others, **speaking}
        await self._keeper.keep(session, tick)
        return tick

    async def live(self, session: Session, idle: Idle | None) -> int:
        """Have a session live by itself from now on, or no more; return the tick of it.

        Raises:
            Forbidden: If they may only watch.
            Busy: If it does, and could not be kept.
        """
        self.check_commands()
        tick = await self._runner.live(session.id, idle)
        session.idle, session.state_changed = idle, True
        await self._keeper.keep(session, tick)
        return tick

    async def move(self, session: Session, rig: Rig) -> int:
        """Carry a session's face over to another rig; return the tick of it.

        Raises:
            Forbidden: If they may only watch.
        """
        self.check_commands()
        move = Move(rig)
        tick = await self._runner.apply(session.id, move)
        session.tail.add(Command(tick, move))
        session.tail.on(rig)
        session.shown.append(session.rig.id)
        session.rig, session.held = rig, session.held.on(rig)
        self._rigs.bake(rig)
        session.unsaved = session.state_changed = True
        session.tell({"type": "rig", "session": session.id, **session.on_rig()})
        await self._keeper.keep(session, tick)
        return tick

    async def view(self, session: Session) -> View:
        """Return the face as it stands."""
        return await self._runner.view(session.id)

    async def look(self, session: Session) -> Look:
        """Return the face with all of its tissue."""
        return await self._runner.look(session.id)

    def watch(self, session: Session, *, packed: bool = False) -> Viewer:
        """Add a viewer, of packed frames if it asked for them.

        Raises:
            Busy: If the session has as many as are allowed.
            QuotaExceeded: If all sessions of the key have as many as it may.
        """
        allowance = self._access.allowance
        if allowance is not None:
            most, made_by = allowance.quota.viewers, session.made_by
            same = (each for each in self._live.values() if each.made_by == made_by)
            if sum(len(each.viewers) for each in same) >= most:
                message = f"at most {most} viewers watch the sessions of this key"
                raise QuotaExceeded(message, retry_after=_VIEWER_LEAVES_SECONDS)
        if len(session.viewers) >= self._viewer_limit:
            message = f"at most {self._viewer_limit} viewers watch one session"
            raise Busy("too_many_viewers", message)
        viewer = Viewer(packed=packed)
        session.viewers.add(viewer)
        return viewer

    def check_commands(self) -> None:
        """Let nobody move a face who only watches.

        Raises:
            Forbidden: If they may not.
        """
        self._access.check_commands()

    async def check_rig(self, session_id: str, rig: str) -> None:
        """Let those through to a rig who are shown a session that is or was on it.

        Raises:
            NotFound: If it never was, or there is no such session for them.
        """
        session = await self.get(session_id)
        if rig not in (session.rig.id, session.rig.name, *session.shown):
            raise NotFound("unknown_rig", f"the session of this ticket is on no rig {rig!r}")

    def end_sockets_of(self, keys: Collection[str]) -> None:
        """Close the sockets on the sessions of keys that are no more."""
        for session in self._live.values():
            if session.made_by in keys:
                reason = "the key was taken away" if session.made_by else "a key is needed now"
                for viewer in session.viewers:
                    viewer.end(1008, reason)

    def leave(self, session: Session, viewer: Viewer) -> None:
        """Forget a viewer."""
        session.viewers.discard(viewer)
        session.used = time.time()

    # What goes on by itself.

    async def _hand_on(self) -> None:
        async for tick in self._runner.ticks():
            try:
                await self._take(tick)
            except Exception:
                _LOG.exception("frames could not be handed on")

    async def _take(self, tick: Tick) -> None:
        # First, in one go: commands that come between the frames are later ones.
        self._take_played(tick)
        await self._show_frames(tick.frames)

    async def _show_frames(self, frames: Mapping[str, Frame]) -> None:
        """Hand frames on; who else wants the loop has a turn in between."""
        live = self._live
        coming = [(live[each], frame) for each, frame in frames.items() if each in live]
        begun = time.perf_counter()
        for session, frame in coming:
            if live.get(session.id) is session:  # It may have been closed and opened meanwhile.
                session.show(frame)
            if time.perf_counter() - begun > _AT_ONCE_SECONDS:
                await asyncio.sleep(0.0)
                begun = time.perf_counter()

    def _take_played(self, tick: Tick) -> None:
        """Note what waited for its time and took effect, and who was put back to rest."""
        for played in tick.played:
            session = self._live.get(played.session)
            if session is None:
                continue
            session.tail.add(Command(played.tick, played.keyframe, played.idle))
            session.unsaved = True
            if not played.idle:
                session.take(played.keyframe, played.tick)
                session.state_changed = True
        for session_id in tick.reset:
            session = self._live.get(session_id)
            if session is not None:
                frame = tick.frames.get(session_id, session.frame)
                session.tail.add(Command(frame.tick, Resumed()))
                session.held.clear()
                session.speaking.clear()
                session.unsaved = session.state_changed = True
                message = "the simulation left the finite numbers; the face is back at rest"
                session.tell({"type": "error", "error": "diverged", "message": message})

    async def _beat(self) -> None:
        """Send states, repeat sleeping frames, save, and close what nobody uses."""
        turn = 0
        while True:
            await asyncio.sleep(1 / (_BEATS_PER_SECOND * _SHIFTS))
            turn += 1
            beat, shift = divmod(turn, _SHIFTS)
            each_second = beat % _BEATS_PER_SECOND == 0
            # Side by side: each one waits for the simulation thread's next tick.
            sessions = [live for live in self._live.values() if live.shift == shift]
            await asyncio.gather(*(self._tend(session, each_second) for session in sessions))
            if each_second:
                await self._save_changed(sessions)
            if turn % (_FORGET_SECONDS * _BEATS_PER_SECOND * _SHIFTS) == 0:
                await self._forget_sleepers()

    async def _forget_sleepers(self) -> None:
        """Forget the stored sessions that nobody woke; a database that is busy has its next try."""
        used_before, live, store = time.time() - self._idle_seconds, list(self._live), self._store
        try:
            await store.aside(lambda: store.remove_idle_sessions(used_before, but=live))
        except Exception:
            _LOG.exception("idle sessions could not be forgotten")

    async def _tend(self, session: Session, each_second: bool) -> None:
        try:
            await self._tell_state(session)
            if each_second:
                await self._each_second(session)
        except NotFound:
            return  # It was closed while it was being tended.
        except Exception:
            _LOG.exception("a session could not be tended", session=session.id)

    async def _tell_state(self, session: Session) -> None:
        if session.viewers and (session.state_changed or not session.frame.asleep):
            session.state_changed = False
            view = await self._runner.view(session.id)
            session.tell({"type": "state", "tick": view.frame.tick, **session.told(view)})

    async def _each_second(self, session: Session) -> None:
        for viewer in session.viewers:
            viewer.repeat_frame(session.frame.tick, asleep=session.frame.asleep)
        alone = 0.0 if session.viewers else time.time() - session.used
        if session.idle is not None and not session.paused and alone > _UNWATCHED_SECONDS:
            session.paused = True
            await self._runner.pause(session.id)
        if alone > self._idle_seconds:
            _LOG.info("a session that nobody uses is closed", session=session.id)
            await self.close(session.id)

    async def _save_changed(self, sessions: Sequence[Session]) -> None:
        """Save those that were commanded, and what is left of leases."""
        changed = [each for each in sessions if each.unsaved or each.held.alarm() is not None]
        with suppress(Busy):  # The next beat tries again.
            await self._save(changed)
        lived_on = [each for each in sessions if each.frame.tick > each.kept_tick]
        try:
            await self._save_ticks(lived_on)
        except Exception:
            _LOG.exception("the ticks of sessions could not be saved", sessions=len(lived_on))

    async def _save_ticks(self, sessions: Sequence[Session]) -> None:
        """Save how long sessions have lived that were told nothing meanwhile."""
        ticks = {each.id: each.tail.elapsed + each.frame.tick for each in sessions}
        if ticks:
            await self._store.aside(lambda: self._store.keep_ticks(ticks))
        for each in sessions:
            each.kept_tick = ticks[each.id] - each.tail.elapsed

    async def _save(self, sessions: Sequence[Session]) -> None:
        ticks_now = await asyncio.gather(*(self._tick_of(session) for session in sessions))
        each = list(zip(sessions, ticks_now, strict=True))
        for session, tick in each:
            session.lapse(tick)
        await asyncio.gather(*(self._keeper.keep(session, tick) for session, tick in each))

    async def _tick_of(self, session: Session) -> int:
        """Return a session's tick: no frame tells it of a face that sleeps until a lease ends."""
        if session.held.alarm() is None:
            return session.frame.tick
        try:
            return (await self._runner.view(session.id)).frame.tick
        except NotFound:  # It was closed meanwhile.
            return session.frame.tick

    async def _check_quota(self) -> None:
        """Let a key open a session, if it has fewer than it may.

        Raises:
            QuotaExceeded: If it has not, with when the first would end by itself.
        """
        allowance, store = self._access.allowance, self._store
        if allowance is None:
            return
        rows = await store.aside(lambda: store.sessions(self._access.maker))
        if len(rows) >= allowance.quota.sessions:
            message = f"this key has {len(rows)} sessions open, as many as it may; close one first"
            ends = min(self._ends_at(row) for row in rows)
            raise QuotaExceeded(message, retry_after=ends - time.time())

    def _ends_at(self, row: SessionRow) -> float:
        """Return when a session ends if nobody uses it any more [s since 1970]."""
        session = self._live.get(row.id)
        if session is None:
            return row.used + self._idle_seconds + _FORGET_SECONDS
        used = time.time() if session.viewers else session.used
        return used + self._idle_seconds + 1.0

    async def _forget(self, session_id: str) -> None:
        store = self._store
        await store.aside(lambda: store.remove_session(session_id))

    async def _restore(self, session_id: str) -> Session:
        row = await self._store.aside(lambda: self._store.session(session_id))
        if row is None or not self._access.sees(row.made_by, session=session_id):
            raise _unknown(session_id)  # Before a face is woken that is not theirs.
        rig = await self._rigs.get(row.rig)
        pieces = await self._store.aside(lambda: self._store.tail(session_id))
        tail = await asyncio.to_thread(
            lambda: Tail.restored(
                rig, pieces, elapsed=row.tick, begins=row.begins, before=row.before or ()
            )
        )
        tail.add(Command(0, Resumed(held_from_json(row.held, rig))))
        session = await self._wake(row, rig, Model.for_rig(rig, **row.model), tail)
        session.unsaved = True
        return session

    async def _wake(self, row: SessionRow, rig: Rig, model: Model, tail: Tail) -> Session:
        timeline = Timeline(tuple(held_from_json(row.held, rig)), duration=1.0)
        await self._runner.open(row.id, rig, timeline, model)
        view = await self._runner.view(row.id)
        now, writers = time.time(), Writers(rig)
        session = Session(
            row.id, rig, model, row.created, now, view.frame, writers, tail, made_by=row.made_by
        )
        for keyframe in timeline.keyframes:
            session.take(keyframe, view.frame.tick)
        self._live[row.id] = session
        if row.life is not None:  # From now on it is told what its life plays.
            session.idle = Idle(**row.life)
            await self._runner.live(row.id, session.idle)
        self._rigs.bake(rig)
        return session


def _unknown(session_id: str) -> NotFound:
    return NotFound("unknown_session", f"there is no session {session_id!r}")
