"""How long an emotion takes to be seen: from its POST to the first frame that it has changed.

Through a service in a process of its own, over HTTP and a socket, with other sessions awake. What
is watched is at rest, so that the first frame whose surface is another one shows the emotion. One
that is asked for at once does so in its first tick; one with its own onset begins too slowly for
the stream's grid, and is seen two to four ticks later, however fast the service is.
"""

from __future__ import annotations

import asyncio
import random
import statistics
import time
from collections.abc import Callable
from contextlib import AsyncExitStack, suppress
from typing import Any, NamedTuple

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from ..protocol import RATE, SUBPROTOCOL, decode_frame
from ..soak_client import Client, SoakRefused, own_service
from .company import OTHERS, TURN_SECONDS, keep_moving, opened
from .live import spread

_WATCHED = 4
"""Sessions that take turns: while one comes to rest the next one is played."""
_LONGEST_SECONDS = 30.0
_EMOTIONS = ("joy", "anger", "surprise", "sadness", "fear", "disgust")
_WAYS: dict[str, dict[str, float]] = {"at once": {"fade_in": 0.0}, "with its own onset": {}}


class _Seen(NamedTuple):
    """How long one emotion took.

    Attributes:
        answered: Until its answer [s].
        frame: Until the first frame that shows it [s].
        ticks: That the face moved until then.
    """

    answered: float
    frame: float
    ticks: int


def measure_emotion_to_frame(*, emotions: int) -> dict[str, Any]:
    """Return how long emotions take until they are answered, and until they are seen.

    Args:
        emotions: How many are timed.

    Raises:
        SoakRefused: If the service does not start, or shows nothing.
    """
    with own_service() as url:
        return asyncio.run(_measured(url, emotions))


async def _measured(url: str, emotions: int) -> dict[str, Any]:
    client = Client(url)
    try:
        await client.until_ready()
        others = [await opened(client) for _ in range(OTHERS)]
        watched = [await opened(client) for _ in range(_WATCHED)]
        async with AsyncExitStack() as stack:
            watches = [await stack.enter_async_context(_Watch(url, face)) for face in watched]
            moving = asyncio.create_task(keep_moving(client, others))
            try:
                return await _timed(client, watches, emotions)
            finally:
                moving.cancel()
                await asyncio.gather(moving, return_exceptions=True)
    finally:
        client.close()


async def _timed(client: Client, watches: list[_Watch], emotions: int) -> dict[str, Any]:
    """Play emotions on the watched faces by turns."""
    chance = random.Random(1)
    seen: dict[str, list[_Seen]] = {way: [] for way in _WAYS}
    awake = []
    for watch in watches:  # Everything once that is slow the first time.
        await _play(client, watch, 0, {})
    await asyncio.sleep(TURN_SECONDS)
    before = await client.counts()
    for number in range(emotions):
        watch, turn = watches[number % len(watches)], 1 + number // len(watches)
        await watch.until_asleep()
        await asyncio.sleep(chance.uniform(0.5, 2.0) / RATE)
        health = await client.call("GET", "/api/health")
        awake.append(health.body["pace"]["awake"])
        # So that every emotion is played in every way.
        way = list(_WAYS)[(turn + turn // len(_EMOTIONS)) % len(_WAYS)]
        seen[way].append(await _play(client, watch, turn, _WAYS[way]))
    after = await client.counts()
    return {
        "others": OTHERS,
        "awake_median": statistics.median(awake),
        "ways": [{"way": way, **_figures(found)} for way, found in seen.items()],
        "ticks": int(after.since(before, "risorius_ticks_total")),
        "late_ticks": int(after.since(before, "risorius_tick_overruns_total")),
    }


def _figures(seen: list[_Seen]) -> dict[str, Any]:
    frames = [each.frame for each in seen]
    return {
        "emotions": len(seen),
        **spread("answered", [each.answered for each in seen]),
        **spread("frame", frames),
        "frame_median_ticks": round(statistics.median(frames) * RATE, 2),
        "moved_median_ticks": statistics.median(each.ticks for each in seen),
    }


async def _play(client: Client, watch: _Watch, turn: int, more: dict[str, float]) -> _Seen:
    """Play an emotion and wait for the frame that shows it."""
    rest = watch.surface
    path = f"/api/sessions/{watch.face}/emotions"
    body = {"label": _EMOTIONS[turn % len(_EMOTIONS)], **more}
    sent = time.perf_counter()
    answer = await client.call("POST", path, body)
    answered = time.perf_counter() - sent
    if answer.status != 200:
        raise SoakRefused(f"an emotion was answered with {answer.status}: {answer.body}.")
    came, tick = await watch.changed(rest, answer.body["tick"])
    return _Seen(answered, came - sent, tick - answer.body["tick"])


class _Watch:
    """A socket: the frames of a face, and when they came."""

    def __init__(self, url: str, face: str) -> None:
        self.face = face
        self.surface = b""
        self._address = f"{url.replace('http', 'ws', 1)}/api/sessions/{face}/stream"
        self._frames: list[tuple[float, int, bytes]] = []
        self._asleep = False
        self._news = asyncio.Event()

    async def __aenter__(self) -> _Watch:
        """Open it and wait for the first frame."""
        self._socket = await connect(self._address, subprotocols=[SUBPROTOCOL])  # type: ignore[list-item]
        self._reading = asyncio.create_task(self._read(self._socket))
        await self.until_asleep()
        return self

    async def __aexit__(self, *_: object) -> None:
        """Close it."""
        self._reading.cancel()
        await asyncio.gather(self._reading, return_exceptions=True)
        await self._socket.close()

    async def until_asleep(self) -> None:
        """Wait until the face rests; what came until then is forgotten."""
        await self._until(lambda: self._asleep)
        self._frames.clear()

    async def changed(self, surface: bytes, tick: int) -> tuple[float, int]:
        """Return when the first frame since `tick` came whose surface is another one, and its tick.

        The time is the clock's [s].
        """
        found: list[tuple[float, int]] = []

        def came() -> bool:
            found.extend(
                (when, at) for when, at, shown in self._frames if at >= tick and shown != surface
            )
            return bool(found)

        await self._until(came)
        return found[0]

    async def _until(self, true: Callable[[], bool]) -> None:
        try:
            async with asyncio.timeout(_LONGEST_SECONDS):
                while not true():
                    self._news.clear()
                    await self._news.wait()
        except TimeoutError:
            message = f"no such frame came within {_LONGEST_SECONDS:g} s."
            raise SoakRefused(message) from None

    async def _read(self, socket: ClientConnection) -> None:
        with suppress(WebSocketException):
            async for message in socket:
                if isinstance(message, bytes):
                    came = time.perf_counter()
                    frame = decode_frame(message)
                    self.surface, self._asleep = frame.steps.tobytes(), frame.asleep
                    self._frames.append((came, frame.tick, self.surface))
                    self._news.set()
