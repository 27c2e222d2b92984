"""What the service counts, as Prometheus text."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .embedded import Counters
from .load import Load
from .timing import Times

_REQUEST_SECONDS = (0.005, 0.02, 0.05, 0.1, 0.5, 1.0, 5.0, 30.0)
_QUANTILES = ("0.5", "0.9", "0.99", "1")


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
        self.encoding_seconds = Counter(
            "risorius_frame_encoding_seconds",
            "Processor time of the event loop's thread that went into bytes of frames.",
            registry=self.registry,
        )
        self.clips = Counter(
            "risorius_clips", "Clips that ended.", ("status",), registry=self.registry
        )
        self.gauge("resident_bytes", "Bytes of this process in memory.", _resident_bytes)
        self.gauge("cpu_seconds", "Processor time of this process.", time.process_time)
        # The numbers are asked for by a route, on the thread of the event loop.
        self.gauge("event_loop_cpu_seconds", "That of the event loop's thread.", time.thread_time)

    def gauge(self, name: str, help_text: str, value: Callable[[], float]) -> None:
        """Add a number that is read when somebody asks."""
        Gauge(f"risorius_{name}", help_text, registry=self.registry).set_function(value)

    def watch_times(self, name: str, help_text: str, times: Times) -> None:
        """Add durations: a histogram, and quantiles of the latest ones under `name`_recent."""
        self.registry.register(_Durations(name, help_text, times))

    def watch_simulation(self, counters: Counters, load: Load) -> None:
        """Add what the simulation thread counts and measures."""
        self.registry.register(_Simulation(counters))
        for name, help_text, times in (
            ("tick_duration_seconds", "Time a tick took.", counters.durations),
            ("tick_lateness_seconds", "How late a tick ended.", counters.lateness),
            ("command_wait_seconds", "How long a command waited for its tick.", counters.waits),
        ):
            self.watch_times(name, help_text, times)
        self.gauge(
            "face_cost_seconds",
            "Smoothed time of a tick over the faces that move in it.",
            lambda: load.face_seconds,
        )
        self.gauge(
            "tick_cost_seconds", "Smoothed time that a tick takes.", lambda: load.tick_seconds
        )
        self.gauge(
            "capacity_share",
            "Share of a tick that faces may take before new ones are refused.",
            lambda: load.share,
        )
        self.gauge(
            "load_share",
            "Share of a tick that the faces that move take.",
            lambda: load.share_of(counters.awake),
        )
        self.gauge("faces_awake", "Faces that move.", lambda: counters.awake)
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
            ("tick_overruns", "Ticks late by more than half a tick.", counters.overruns),
            ("face_resets", "Faces put back to rest because they diverged.", counters.resets),
            ("simulation_seconds", "Time spent stepping.", counters.busy_seconds),
        )
        return [
            CounterMetricFamily(f"risorius_{name}", text, value=value)
            for name, text, value in lines
        ]


class _Durations(Collector):
    """Durations of one kind, read without holding up the thread that notes them."""

    def __init__(self, name: str, help_text: str, times: Times) -> None:
        self._name = f"risorius_{name}"
        self._help = help_text
        self._times = times

    def collect(self) -> list[Metric]:
        histogram = HistogramMetricFamily(
            self._name, self._help, buckets=self._times.buckets(), sum_value=self._times.total
        )
        recent = GaugeMetricFamily(
            f"{self._name}_recent", f"{self._help} The latest.", labels=("quantile",)
        )
        found = self._times.quantiles(*map(float, _QUANTILES))
        for quantile, seconds in zip(_QUANTILES, found, strict=True):
            recent.add_metric((quantile,), seconds)
        return [histogram, recent]


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


def _resident_bytes() -> float:
    """Return the memory of this process that is not swapped out [bytes]; 0 but on Linux."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    except (OSError, ValueError, IndexError):
        return 0.0
    return float(pages * os.sysconf("SC_PAGE_SIZE"))


def _method(scope: Scope) -> str:
    """Return the method, if it is one: clients must not be able to invent label values."""
    method = str(scope["method"])
    known = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}
    return method if method in known else "other"
