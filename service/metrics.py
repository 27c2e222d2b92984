"""What the service counts, as Prometheus text."""

from __future__ import annotations

from collections.abc import Callable

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .embedded import Counters

_REQUEST_SECONDS = (0.005, 0.02, 0.05, 0.1, 0.5, 1.0, 5.0, 30.0)


class Metrics:
    """Counters of one application; two applications in one process do not mix."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "risorius_requests", "Requests answered.", ("method", "status"), registry=self.registry
        )
        self.request_seconds = Histogram(
            "risorius_request_seconds",
            "Time to answer a request.",
            buckets=_REQUEST_SECONDS,
            registry=self.registry,
        )
        self.frames_sent = Counter(
            "risorius_frames_sent", "Binary frames sent to viewers.", registry=self.registry
        )
        self.frame_bytes = Counter(
            "risorius_frame_bytes", "Bytes of binary frames sent.", registry=self.registry
        )
        self.frames_skipped = Counter(
            "risorius_frames_skipped", "Frames slow viewers missed.", registry=self.registry
        )
        self.clips = Counter(
            "risorius_clips", "Clips that ended.", ("status",), registry=self.registry
        )

    def gauge(self, name: str, help_text: str, value: Callable[[], float]) -> None:
        """Add a number that is read when somebody asks."""
        Gauge(f"risorius_{name}", help_text, registry=self.registry).set_function(value)

    def watch_simulation(self, counters: Counters) -> None:
        """Add what the simulation thread counts."""
        self.registry.register(_Simulation(counters))
        self.gauge("faces_awake", "Faces stepped in the last tick.", lambda: counters.awake)
        self.gauge("tick_seconds", "Time the last tick took.", lambda: counters.last_tick_seconds)

    def text(self) -> bytes:
        """Return every number in the text format."""
        return generate_latest(self.registry)


class _Simulation(Collector):
    """The simulation thread's own counters, read without touching its hot path."""

    def __init__(self, counters: Counters) -> None:
        self._counters = counters

    def collect(self) -> list[Metric]:
        counters = self._counters
        lines = (
            ("ticks", "Ticks stepped.", counters.ticks),
            ("tick_overruns", "Ticks that were late.", counters.overruns),
            ("face_resets", "Faces put back to rest because they diverged.", counters.resets),
            ("simulation_seconds", "Time spent stepping.", counters.busy_seconds),
        )
        return [
            CounterMetricFamily(f"risorius_{name}", text, value=value)
            for name, text, value in lines
        ]


class CountRequests:
    """Middleware that counts answers and the time they take."""

    def __init__(self, app: ASGIApp, *, metrics: Metrics) -> None:
        self.app = app
        self.metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on and count its answer."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def counted(message: Message) -> None:
            if message["type"] == "http.response.start":
                self.metrics.requests.labels(_method(scope), str(message["status"])).inc()
            await send(message)

        with self.metrics.request_seconds.time():
            await self.app(scope, receive, counted)


def _method(scope: Scope) -> str:
    """Return the method, if it is one: clients must not be able to invent label values."""
    method = str(scope["method"])
    known = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}
    return method if method in known else "other"
