"""Whether the service is alive, whether it is ready, and what it counts."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel
from starlette.responses import PlainTextResponse

from ..components import Parts
from ..errors import Busy
from ..version import version

router = APIRouter(tags=["service"])


class Health(BaseModel):
    """The service is alive."""

    status: str
    version: str


@router.get("/api/health")
async def health() -> Health:
    """Answer at once."""
    return Health(status="ok", version=version())


@router.get("/api/ready")
async def ready(parts: Parts) -> Health:
    """Answer 200 once kernels are warm and the standard rig is built, while faces can move."""
    if not parts.ready.is_set():
        raise Busy("not_ready", f"the service is {parts.stage}")
    if not parts.runner.alive:
        raise Busy("simulation_stopped", "the simulation has stopped; restart the service")
    return Health(status="ready", version=version())


@router.get("/metrics", response_class=PlainTextResponse)
async def metrics(parts: Parts) -> PlainTextResponse:
    """Return counters as Prometheus text."""
    return PlainTextResponse(parts.metrics.text())
