"""Insight: what a live face does inside, and which muscles bring landmarks to their targets."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from ..components import Parts
from ..insight_bodies import AnalysisBody, InverseBody, InverseRequest
from ..layers import encode_layers, layers_frame

router = APIRouter(prefix="/api", tags=["insight"])
_POLL_SECONDS = 2
_BYTES = "application/octet-stream"
Measured = Annotated[bool, Query(description="Whether action units are measured.")]
Wait = Annotated[
    float,
    Query(
        ge=0,
        le=60,
        allow_inf_nan=False,
        description="Seconds to wait for what each unit of this rig looks like, if nobody has "
        "asked for that before.",
    ),
]

InverseWait = Annotated[
    float,
    Query(
        ge=0,
        le=60,
        allow_inf_nan=False,
        description="Seconds to wait for how this rig answers each muscle, if nobody has asked for "
        "that before; 503 if it is not known by then.",
    ),
]


@router.get("/sessions/{session_id}/analysis", response_model_exclude_unset=True)
async def session_analysis(
    session_id: str, parts: Parts, response: Response, measured: Measured = True, wait: Wait = 1.0
) -> AnalysisBody:
    """Return force and contraction by muscle, strain, energy, and measured action units."""
    session = await parts.sessions.get(session_id)
    look = await parts.sessions.look(session)
    found = await parts.insight.analyze(look, measured=measured, wait=wait)
    body = found.analysis.to_json()
    if found.measuring is not None:
        response.headers["Retry-After"] = str(_POLL_SECONDS)
        message = (
            "what each action unit of this rig looks like is being worked out, once for each rig; "
            "ask again, or with ?wait=60"
        )
        body |= {
            "measured": None,
            "measuring": {"progress": round(found.measuring, 3), "message": message},
        }
    return AnalysisBody.model_validate(body)


@router.get(
    "/sessions/{session_id}/layers",
    response_class=Response,
    responses={
        200: {
            "description": "Where dermis, hypodermis and bone are, as docs/stream.md lays it out.",
            "content": {_BYTES: {"schema": {"type": "string", "format": "binary"}}},
        }
    },
)
async def session_layers(session_id: str, parts: Parts) -> Response:
    """Return how far the tissue under the skin is from rest, at the present tick."""
    session = await parts.sessions.get(session_id)
    look = await parts.sessions.look(session)
    data = encode_layers(layers_frame(look.snapshot))
    return Response(data, media_type=_BYTES, headers={"Cache-Control": "no-store"})


@router.post("/rigs/{rig}/inverse")
async def rig_inverse(
    rig: str, body: InverseRequest, parts: Parts, wait: InverseWait = 60.0
) -> InverseBody:
    """Return the muscles, or action units, and the jaw that bring landmarks to their targets."""
    found = await parts.rigs.get(rig)
    inverse = await parts.insight.invert(found, body, wait=wait)
    return InverseBody.model_validate(inverse.to_json())
