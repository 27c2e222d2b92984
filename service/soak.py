"""Load for as long as it is asked for: whether faces keep their rate, and memory its size.

First sessions are opened, all moving, until the service refuses one: that is its capacity. Then a
share of them is kept moving by a storm of commands, half of them watched, while others sleep,
sessions are closed and opened, faces fall asleep and others take their turn, and clips are
rendered. Whatever the load needs of the machine itself stands back behind the service.
"""

from __future__ import annotations

import asyncio
import random
import time
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from rich.table import Table
from websockets.exceptions import WebSocketException

from .benching import machine
from .gaps import gaps_seen, stolen_seconds
from .load import TICK_SECONDS
from .priority import AWAITED, stand_back
from .soak_client import Client, Counts, SoakRefused, Viewer, own_service

Show = Callable[[str], None]

MOST_OVERRUNS = 0.001
"""Share of ticks that may be late by more than half a tick."""
MOST_GROWTH_BYTES = 16e6
"""Growth of memory in the later two thirds that counts as none: allocators keep some back."""
_MEMORY_PARTS = 8
_SEED = 1
_MOST_SESSIONS = 200
_GAP_SECONDS = 20.0
_SETTLE_SECONDS = 3.0
"""Between two sessions while the capacity is found: the smoothed cost follows within two."""
_COMMAND_SECONDS = 1.0
"""In which every moving face gets a command, whose way takes as long: it never comes to rest."""
_COMMANDERS = 3
"""Who command at a time: one alone waits for each answer, and faces would sleep meanwhile."""
_CHURN_SECONDS = 5.0
_TURN_SECONDS = 8.0
_CLIP_SECONDS = 30.0
_SAMPLE_SECONDS = 2.0
_RETRY_SECONDS = 2.0
_PREPARING_SECONDS = 60.0
# Expressions far from each other, so that whoever changes between them keeps moving.
_EXPRESSIONS = (
    {"AU12": 1.0, "AU6": 0.8},
    {"AU1": 1.0, "AU4": 0.7, "AU15": 0.8},
    {"AU9": 1.0, "AU10": 0.6},
    {"AU26": 1.0, "AU5": 1.0},
    {"AU43": 1.0, "AU18": 0.8},
)
_CLIP = {
    "fps": 30,
    "duration": 2.0,
    "textures": False,
    "level": "low",
    "timeline": [
        {"time": 0.5 * turn, "action_units": units, "fade": 0.3, "replace": True}
        for turn, units in enumerate(_EXPRESSIONS[:4])
    ],
}


@dataclass(eq=False)
class _Face:
    """A session of the soak.

    Attributes:
        id: Of the session.
        moving: Whether it is commanded.
        viewer: Its socket, if it is watched.
    """

    id: str
    moving: bool
    viewer: Viewer | None = None
    closing: AsyncExitStack = field(default_factory=AsyncExitStack)


@dataclass(eq=False)
class _Tally:
    """What the load did and saw.

    Attributes:
        trips: From a command sent over HTTP to the answer with its tick [s].
        memory: Moments [s] and bytes of the service that is in memory.
        awake: Faces that moved, at the same moments.
        failures: Answers that should not have come.
    """

    commands: int = 0
    opened: int = 0
    closed: int = 0
    refused: int = 0
    clips: int = 0
    frames: int = 0
    trips: list[float] = field(default_factory=list)
    memory: list[tuple[float, float]] = field(default_factory=list)
    awake: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)


def soak(*, minutes: float, share: float, url: str | None, show: Show) -> dict[str, Any]:
    """Run the load and return what it came to.

    Args:
        minutes: How long, after the capacity is found.
        share: Of that capacity, that is kept moving.
        url: A running service; None starts one.
        show: Told what is being done.

    Raises:
        SoakRefused: If there is no service to load.
    """
    if url is not None:  # Its machine may be another one.
        return _loaded(url, minutes, share, show)
    show("looking for gaps of the machine itself")
    looked = min(_GAP_SECONDS, 6.0 * minutes)
    own = gaps_seen(looked, least=TICK_SECONDS / 2.0, cores=machine()["cores"])
    before, started = stolen_seconds(), time.monotonic()
    with own_service() as address:
        figures = _loaded(address, minutes, share, show)
    after, elapsed = stolen_seconds(), time.monotonic() - started
    stolen = {}
    if before is not None and after is not None:
        stolen = {"machine_stolen_ms_a_second": round(1000.0 * (after - before) / elapsed, 2)}
    return {
        **figures,
        **stolen,
        "machine_gaps_a_minute": round(60.0 * len(own) / looked, 1),
        "machine_longest_gap_ms": round(1000.0 * max(own, default=0.0), 1),
    }


def _loaded(address: str, minutes: float, share: float, show: Show) -> dict[str, Any]:
    stand_back(AWAITED)  # Only now: a process that is started takes the priority over.
    return asyncio.run(_Soak(address, share, show).run(60.0 * minutes))


def verdict(figures: dict[str, Any]) -> list[str]:
    """Return what is wrong with the figures of a soak, a sentence each; nothing if all is well."""
    wrong = []
    if figures["overrun_share"] > MOST_OVERRUNS:
        wrong.append(
            f"{figures['overrun_share']:.2%} of ticks were late by more than half a tick; "
            f"expected at most {MOST_OVERRUNS:.1%}"
        )
    if figures["memory_growth_mb"] > MOST_GROWTH_BYTES / 1e6:
        wrong.append(
            f"memory grew by {figures['memory_growth_mb']:g} MB in the later two thirds; "
            f"expected at most {MOST_GROWTH_BYTES / 1e6:g} MB"
        )
    if figures["failures"]:
        wrong.append(f"{len(figures['failures'])} requests failed, first: {figures['failures'][0]}")
    return wrong


def table(figures: dict[str, Any]) -> Table:
    """Return the figures for people."""
    processor = figures["machine"]["processor"]
    title = f"{processor}, {figures['machine']['cores']} cores, {figures['minutes']:g} minutes"
    lines = Table(title=title, title_justify="left")
    lines.add_column("figure")
    lines.add_column("value", justify="right")
    for name, value in figures.items():
        if name.endswith("_share"):
            lines.add_row(name.removesuffix("_share").replace("_", " "), f"{value:.3%}")
        elif isinstance(value, int | float) and name != "minutes":
            lines.add_row(name.replace("_ms", ", ms").replace("_", " "), f"{value:g}")
    wrong = verdict(figures)
    lines.add_row("verdict", "; ".join(wrong) if wrong else "passed")
    return lines


class _Soak:
    """One run."""

    def __init__(self, url: str, share: float, show: Show) -> None:
        self._client = Client(url)
        self._share = share
        self._show = show
        self._faces: list[_Face] = []
        self._moving = self._wanted = 0
        self._tally = _Tally()
        self._chance = random.Random(_SEED)  # The same load each time.

    async def run(self, seconds: float) -> dict[str, Any]:
        """Find the capacity, run the load and return the figures."""
        try:
            self._show("waiting for the service")
            await self._client.until_ready()
            capacity = await self._find_capacity()
            self._moving = max(1, int(self._share * capacity))
            self._wanted = self._moving + max(2, self._moving)
            await self._prepare()
            self._tally = _Tally()
            before, started = await self._client.counts(), time.monotonic()
            await self._load(seconds)
            elapsed = time.monotonic() - started
            after = await self._client.counts()
            await self._close_all()
        finally:
            for face in self._faces:  # None, unless something went wrong.
                await face.closing.aclose()
            self._client.close()
        return {
            "machine": machine(),
            "minutes": round(elapsed / 60.0, 2),
            "capacity_faces": capacity,
            "moving_faces": self._moving,
            **_of_service(before, after, elapsed),
            **_of_load(self._tally),
        }

    async def _find_capacity(self) -> int:
        """Open moving sessions until one is refused; return how many were not."""
        storm = asyncio.create_task(self._storm())
        try:
            deadline = time.monotonic() + _PREPARING_SECONDS
            while not await self._open(moving=True):
                if time.monotonic() > deadline:
                    raise SoakRefused(
                        "the service refuses the first session; nobody else may use it meanwhile."
                    )
                await asyncio.sleep(_RETRY_SECONDS)
            while len(self._faces) < _MOST_SESSIONS:
                self._show(f"finding the capacity: {len(self._faces)} faces move")
                await asyncio.sleep(_SETTLE_SECONDS)
                if not await self._open(moving=True):
                    break
        finally:
            await _end(storm)
        return len(self._faces)

    async def _prepare(self) -> None:
        """Have made what is made once, and some faces sleep while the others move."""
        self._show("letting faces fall asleep")
        for face in self._faces:
            face.moving = False
        while len(self._faces) > self._wanted:
            await self._close(self._faces[-1])
        deadline = time.monotonic() + _PREPARING_SECONDS
        while len(self._faces) < self._wanted and time.monotonic() < deadline:
            if not await self._open(moving=False):
                await asyncio.sleep(_RETRY_SECONDS)
        self._show("baking textures and rendering a first clip")
        await self._client.call("GET", "/api/rigs/standard/textures/albedo.jpg")
        await self._render()
        self._keep_moving()
        await asyncio.sleep(_SETTLE_SECONDS)

    async def _load(self, seconds: float) -> None:
        """Do everything at once, for so long [s]."""
        started = time.monotonic()
        tasks = [
            asyncio.create_task(work)
            for work in (
                self._storm(),
                self._every(_CHURN_SECONDS, self._churn),
                self._every(_TURN_SECONDS, self._take_turns),
                self._every(_CLIP_SECONDS, self._render),
                self._every(_SAMPLE_SECONDS, self._sample),
            )
        ]
        try:
            while (left := started + seconds - time.monotonic()) > 0:
                self._show(f"{len(self._faces)} sessions, {left / 60.0:.1f} minutes to go")
                done, _ = await asyncio.wait(
                    tasks, timeout=min(left, 5.0), return_when=asyncio.FIRST_COMPLETED
                )
                for task in done:
                    task.result()  # It ends only by what went wrong.
        finally:
            for task in tasks:
                await _end(task)

    async def _every(self, seconds: float, work: Callable[[], Any]) -> None:
        while True:
            await asyncio.sleep(seconds)
            await work()

    async def _storm(self) -> None:
        """Keep every moving face on its way from one expression to another."""
        await asyncio.gather(*(self._commander(share) for share in range(_COMMANDERS)))

    async def _commander(self, share: int) -> None:
        turn = 0
        while True:
            turn += 1
            faces = [face for face in self._faces if face.moving][share::_COMMANDERS]
            started = time.monotonic()
            for number, face in enumerate(faces):
                units = _EXPRESSIONS[(turn + number) % len(_EXPRESSIONS)]
                await self._command(face, units)
                due = started + _COMMAND_SECONDS * (number + 1) / len(faces)
                await asyncio.sleep(max(0.0, due - time.monotonic()))
            if not faces:
                await asyncio.sleep(_SAMPLE_SECONDS)

    async def _command(self, face: _Face, units: dict[str, float]) -> None:
        self._tally.commands += 1
        body = {"action_units": units, "fade": _COMMAND_SECONDS}
        # Those that are watched are commanded over their socket every other time.
        if face.viewer is not None and self._chance.random() < 0.5:
            await face.viewer.send({"type": "controls", "replace": True, **body})
            return
        answer = await self._client.call("PUT", f"/api/sessions/{face.id}/controls", body)
        if answer.status == 200:
            self._tally.trips.append(answer.seconds)
        elif face in self._faces:  # Else it was closed meanwhile.
            self._fail("a command", answer.status, answer.body)

    async def _open(self, *, moving: bool) -> bool:
        """Open a session, every other one watched; return whether there was room."""
        answer = await self._client.call("POST", "/api/sessions", {})
        if answer.status == 429:
            self._tally.refused += 1
            return False
        if answer.status != 201:
            self._fail("opening a session", answer.status, answer.body)
            return False
        self._tally.opened += 1
        face = _Face(answer.body["id"], moving)
        if len(self._faces) % 2 == 0:
            try:
                face.viewer = await face.closing.enter_async_context(self._client.viewer(face.id))
            except (OSError, WebSocketException) as error:
                self._tally.failures.append(f"a viewer was refused: {error}")
        self._faces.append(face)
        if moving:
            await self._command(face, self._chance.choice(_EXPRESSIONS))
        return True

    async def _close(self, face: _Face) -> None:
        self._faces.remove(face)
        await self._leave(face)
        answer = await self._client.call("DELETE", f"/api/sessions/{face.id}")
        if answer.status != 204:
            self._fail("closing a session", answer.status, answer.body)
        self._tally.closed += 1

    async def _leave(self, face: _Face) -> None:
        if face.viewer is not None:
            self._tally.frames += face.viewer.frames
            self._tally.failures += face.viewer.errors
        await face.closing.aclose()

    async def _close_all(self) -> None:
        for face in list(self._faces):
            await self._close(face)

    async def _churn(self) -> None:
        """Close a session, and open those that are missing as far as there is room."""
        if self._faces:
            await self._close(self._chance.choice(self._faces))
        while len(self._faces) < self._wanted and await self._open(moving=False):
            pass
        self._keep_moving()

    async def _take_turns(self) -> None:
        """Let a face fall asleep, and wake another in its place."""
        moving = [face for face in self._faces if face.moving]
        if moving and len(moving) < len(self._faces):
            chosen = self._chance.choice(moving)
            chosen.moving = False
            self._keep_moving(but=chosen)

    def _keep_moving(self, but: _Face | None = None) -> None:
        """Wake sleeping faces until as many move as are to."""
        sleeping = [face for face in self._faces if not face.moving and face is not but]
        moving = len([face for face in self._faces if face.moving])
        for face in self._chance.sample(
            sleeping, min(len(sleeping), max(0, self._moving - moving))
        ):
            face.moving = True

    async def _render(self) -> None:
        answer = await self._client.call("POST", "/api/clips", _CLIP)
        if answer.status != 202:
            self._fail("rendering a clip", answer.status, answer.body)
            return
        path = f"/api/clips/{answer.body['id']}"
        while (row := await self._client.call("GET", path)).body["status"] in ("queued", "running"):
            await asyncio.sleep(1.0)
        if row.body["status"] != "done":
            self._fail("rendering a clip", row.status, row.body)
        self._tally.clips += 1
        await self._client.call("DELETE", path)

    async def _sample(self) -> None:
        counts = await self._client.counts()
        memory = counts.values.get("risorius_resident_bytes", 0.0)
        self._tally.memory.append((time.monotonic(), memory))
        self._tally.awake.append(counts.values.get("risorius_faces_awake", 0.0))

    def _fail(self, what: str, status: int, body: object) -> None:
        self._tally.failures.append(f"{what} was answered with {status}: {body}")


def _of_service(before: Counts, after: Counts, seconds: float) -> dict[str, Any]:
    """Return what the service itself counted between two moments."""
    ticks = after.since(before, "risorius_ticks_total")
    overruns = after.since(before, "risorius_tick_overruns_total")

    def milliseconds(name: str, share: float) -> float:
        return round(1000.0 * after.quantile(before, f"risorius_{name}_seconds", share), 2)

    return {
        "ticks": int(ticks),
        "ticks_a_second": round(ticks / seconds, 2),
        "overruns": int(overruns),
        "overrun_share": overruns / max(ticks, 1.0),
        "tick_p50_ms": milliseconds("tick_duration", 0.5),
        "tick_p99_ms": milliseconds("tick_duration", 0.99),
        "lateness_p99_ms": milliseconds("tick_lateness", 0.99),
        "loop_delay_p50_ms": milliseconds("loop_delay", 0.5),
        "loop_delay_p99_ms": milliseconds("loop_delay", 0.99),
        "command_to_tick_p50_ms": milliseconds("command_wait", 0.5),
        "command_to_tick_p99_ms": milliseconds("command_wait", 0.99),
        "frames_sent": int(after.since(before, "risorius_frames_sent_total")),
        "frames_skipped": int(after.since(before, "risorius_frames_skipped_total")),
    }


def _of_load(tally: _Tally) -> dict[str, Any]:
    """Return what the clients saw."""
    trips = 1000.0 * np.array(tally.trips or [0.0])
    slope, growth = memory_trend(tally.memory)
    resident = [size / 1e6 for _, size in tally.memory] or [0.0]
    return {
        "awake_faces_mean": round(float(np.mean(tally.awake or [0.0])), 1),
        "round_trip_p50_ms": round(float(np.percentile(trips, 50)), 2),
        "round_trip_p99_ms": round(float(np.percentile(trips, 99)), 2),
        "commands": tally.commands,
        "sessions_opened": tally.opened,
        "sessions_closed": tally.closed,
        "sessions_refused": tally.refused,
        "clips_rendered": tally.clips,
        "memory_first_mb": round(resident[0], 1),
        "memory_last_mb": round(resident[-1], 1),
        "memory_slope_mb_a_minute": round(60.0 * slope / 1e6, 3),
        "memory_growth_mb": round(growth / 1e6, 1),
        "failures": tally.failures,
    }


def memory_trend(samples: list[tuple[float, float]]) -> tuple[float, float]:
    """Return slope [bytes/s] and growth [bytes] of a line through the later two thirds.

    The first third is left out: caches fill, and allocators take what they keep. Of each eighth of
    the rest only the least counts: what a clip takes and gives back is no growth.

    Args:
        samples: Moments [s] and sizes [bytes], oldest first.
    """
    later = np.array(samples[len(samples) // 3 :])
    if len(later) < 3:
        return 0.0, 0.0
    parts = np.array_split(later, min(_MEMORY_PARTS, len(later)))
    least = np.array([part[part[:, 1].argmin()] for part in parts])
    slope = float(np.polyfit(least[:, 0] - later[0, 0], least[:, 1], 1)[0])
    return slope, slope * float(later[-1, 0] - later[0, 0])


async def _end(task: asyncio.Task[Any]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
