"""A client of a running service, for the soak: calls, viewers, and what the service counts."""

from __future__ import annotations

import asyncio
import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
from collections.abc import AsyncIterator, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any

from prometheus_client.parser import text_string_to_metric_families
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

from .protocol import SUBPROTOCOL
from .timing import quantile_of

_CALLS_AT_ONCE = 4
_TIMEOUT_SECONDS = 300.0
_READY_SECONDS = 300.0
_IDLE_SECONDS = 2.0
"""After which a connection is not used again: a service elsewhere may close idle ones soon."""


class SoakRefused(Exception):
    """A service that cannot be soaked; the message is one sentence."""


@dataclass(frozen=True)
class Answer:
    """What the service said.

    Attributes:
        status: HTTP status.
        body: The JSON, None if it is none.
        seconds: From the first byte sent to the last one read.
    """

    status: int
    body: Any
    seconds: float


@dataclass(frozen=True)
class Counts:
    """What the service had counted at a moment."""

    values: Mapping[str, float]
    histograms: Mapping[str, Mapping[float, float]]

    def since(self, earlier: Counts, name: str) -> float:
        """Return how much a counter has grown."""
        return self.values.get(name, 0.0) - earlier.values.get(name, 0.0)

    def quantile(self, earlier: Counts, name: str, share: float) -> float:
        """Return a quantile [s] of the durations that were noted since `earlier`."""
        before = earlier.histograms.get(name, {})
        buckets = sorted(self.histograms.get(name, {}).items())
        return quantile_of([(end, count - before.get(end, 0.0)) for end, count in buckets], share)


class Client:
    """Calls of one service, a few at once, each on a connection that stays open."""

    def __init__(self, url: str) -> None:
        parts = urllib.parse.urlsplit(url)
        if parts.scheme != "http" or not parts.hostname:
            raise SoakRefused(f"{url!r} is no address of a service; expected http://name:port.")
        self._place = (parts.hostname, parts.port or 80)
        self._sockets = f"ws://{parts.netloc}"
        self._own = threading.local()
        self._connections: list[http.client.HTTPConnection] = []
        self._pool = ThreadPoolExecutor(_CALLS_AT_ONCE, thread_name_prefix="client")

    async def call(self, method: str, path: str, body: object = None) -> Answer:
        """Send a request and return the answer, whatever its status.

        Raises:
            SoakRefused: If the service does not answer.
        """
        loop = asyncio.get_running_loop()
        try:
            return await loop.run_in_executor(self._pool, self._call, method, path, body)
        except (OSError, http.client.HTTPException) as error:
            host, port = self._place
            raise SoakRefused(f"the service at {host}:{port} does not answer: {error}.") from error

    async def counts(self) -> Counts:
        """Return what the service has counted."""
        answer = await self.call("GET", "/metrics")
        return read_counts(answer.body)

    async def until_ready(self) -> None:
        """Wait until faces can be opened.

        Raises:
            SoakRefused: If that takes more than five minutes.
        """
        deadline = time.monotonic() + _READY_SECONDS
        while time.monotonic() < deadline:
            with suppress(SoakRefused):
                if (await self.call("GET", "/api/ready")).status == 200:
                    return
            await asyncio.sleep(0.3)
        raise SoakRefused("the service was not ready within five minutes; its log says why.")

    @asynccontextmanager
    async def viewer(self, session: str) -> AsyncIterator[Viewer]:
        """Watch a session, reading every frame."""
        address = f"{self._sockets}/api/sessions/{session}/stream"
        async with connect(address, subprotocols=[SUBPROTOCOL]) as socket:  # type: ignore[list-item]
            viewer = Viewer(socket)
            reading = asyncio.create_task(viewer.read())
            try:
                yield viewer
            finally:
                reading.cancel()
                await asyncio.gather(reading, return_exceptions=True)

    def close(self) -> None:
        """Wait for calls under way and close the connections."""
        self._pool.shutdown(wait=True, cancel_futures=True)
        for connection in self._connections:
            connection.close()

    def _call(self, method: str, path: str, body: object) -> Answer:
        connection = getattr(self._own, "connection", None)
        if connection is None:
            connection = http.client.HTTPConnection(*self._place, timeout=_TIMEOUT_SECONDS)
            self._own.connection = connection
            self._own.used = 0.0
            self._connections.append(connection)
        if time.monotonic() - self._own.used > _IDLE_SECONDS:
            connection.close()  # The request opens it again.
        data = None if body is None else json.dumps(body)
        headers = {} if data is None else {"Content-Type": "application/json"}
        started = time.perf_counter()
        try:
            connection.request(method, path, data, headers)
            answer = connection.getresponse()
            text = answer.read()
        except BaseException:
            connection.close()
            raise
        self._own.used = time.monotonic()
        seconds = time.perf_counter() - started
        kind = answer.headers.get("content-type", "")
        read = json.loads(text) if text and "json" in kind else text.decode("utf-8", "replace")
        return Answer(answer.status, read, seconds)


@dataclass(eq=False)
class Viewer:
    """A socket that is read to the end.

    Attributes:
        frames: Binary frames that came.
        errors: What the service refused.
    """

    socket: Any
    frames: int = 0
    errors: list[str] = field(default_factory=list)

    async def send(self, message: Mapping[str, object]) -> None:
        """Send a command; a socket that was closed meanwhile takes none."""
        with suppress(WebSocketException):
            await self.socket.send(json.dumps(message))

    async def read(self) -> None:
        """Read until the socket ends."""
        with suppress(WebSocketException):
            async for message in self.socket:
                if isinstance(message, bytes):
                    self.frames += 1
                elif json.loads(message)["type"] == "error":
                    self.errors.append(message)


def read_counts(text: str) -> Counts:
    """Return counters and gauges without labels, and histograms, of Prometheus text."""
    values: dict[str, float] = {}
    histograms: dict[str, dict[float, float]] = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            if family.type == "histogram" and sample.name.endswith("_bucket"):
                histograms.setdefault(family.name, {})[float(sample.labels["le"])] = sample.value
            elif not sample.labels:
                values[sample.name] = sample.value
    return Counts(values, histograms)


@contextmanager
def own_service(settings: Mapping[str, str] | None = None) -> Iterator[str]:
    """Start a service in a process of its own, on a free port, and yield its URL.

    Args:
        settings: What it has otherwise than usual, by variable.

    Raises:
        SoakRefused: If it does not start.
    """
    with tempfile.TemporaryDirectory(prefix="risorius-soak-") as folder:
        environment = {
            **os.environ,
            "RISORIUS_DATA_DIR": folder,
            "RISORIUS_API_KEYS": "",
            "RISORIUS_REQUESTS_PER_SECOND": "1000000",
            **(settings or {}),
        }
        process = subprocess.Popen(
            [sys.executable, "-m", "service", "serve", "--host", "127.0.0.1", "--port", "0"],
            env=environment,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert process.stderr is not None
        # Reads on, so that it never waits for somebody to read what it logs.
        copying = threading.Thread(target=_copy, args=(process.stderr,), daemon=True)
        try:
            first = process.stderr.readline().split()
            if not first or not first[-1].startswith("http"):
                raise SoakRefused(f"the service did not start: {' '.join(first)}")
            copying.start()
            yield first[-1]
        finally:
            process.terminate()
            try:
                process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            if copying.is_alive():
                copying.join()
            process.stderr.close()


def _copy(log: Any) -> None:
    """Hand on what the service says of itself, but how it starts."""
    for line in log:
        if not line.startswith("  "):
            sys.stderr.write(line)
