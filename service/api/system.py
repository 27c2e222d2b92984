"""Whether the service is alive, whether it is ready, and what it counts."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel
from starlette.responses import PlainTextResponse

from ..components import Components, Parts
from ..errors import Busy
from ..version import version

router = APIRouter(tags=["service"])


class Pace(BaseModel):
    """Whether live faces keep their rate.

    Attributes:
        awake: Faces that move.
        load: Share of a tick that they take.
        capacity: Share that they may take before new sessions are refused.
        late_ticks: Ticks since the start that were late by more than half a tick.
        ticks: Ticks since the start.
        lateness_p99: How late ticks of the last minute were, the worst in a hundred left out [s].
        loop_delay_p99: The same of the event loop [s].
    """

    awake: int
    load: float
    capacity: float
    late_ticks: int
    ticks: int
    lateness_p99: float
    loop_delay_p99: float


class Health(BaseModel):
    """The service is alive."""

    status: str
    version: str
    pace: Pace


@router.get("/api/health")
async def health(parts: Parts) -> Health:
    """Answer at once, with how well live faces keep their rate."""
    return Health(status="ok", version=version(), pace=_pace(parts))


@router.get("/api/ready")
async def ready(parts: Parts) -> Health:
    """Answer 200 once kernels are warm and the standard rig is built, while faces can move."""
    if not parts.ready.is_set():
        raise Busy("not_ready", f"the service is {parts.stage}")
    if not parts.runner.alive:
        raise Busy("simulation_stopped", "the simulation has stopped; restart the service")
    return Health(status="ready", version=version(), pace=_pace(parts))


@router.get("/metrics", response_class=PlainTextResponse)
async def metrics(parts: Parts) -> PlainTextResponse:
    """Return counters as Prometheus text."""
    return PlainTextResponse(parts.metrics.text())


def _pace(parts: Components) -> Pace:
    counters, load = parts.runner.counters, parts.runner.load
    return Pace(
        awake=counters.awake,
        load=round(load.share_of(counters.awake), 3),
        capacity=load.share,
        late_ticks=counters.overruns,
        ticks=counters.ticks,
        lateness_p99=round(counters.lateness.quantile(0.99), 5),
        loop_delay_p99=round(parts.loop_delay.times.quantile(0.99), 5),
    )
