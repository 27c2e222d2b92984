"""Insight: what a live face does inside, and which muscles bring landmarks to their targets."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from ..components import Parts
from ..insight_bodies import AnalysisBody, InverseBody, InverseRequest

router = APIRouter(prefix="/api", tags=["insight"])
Measured = Annotated[
    bool,
    Query(description="Whether action units are measured: slow the first time on a rig."),
]


@router.get("/sessions/{session_id}/analysis", response_model_exclude_none=True)
async def session_analysis(
    session_id: str, parts: Parts, measured: Measured = True
) -> AnalysisBody:
    """Return force and contraction by muscle, strain, energy, and measured action units."""
    session = await parts.sessions.get(session_id)
    look = await parts.sessions.look(session)
    analysis = await parts.insight.analyze(look, measured=measured)
    return AnalysisBody.model_validate(analysis.to_json())


@router.post("/rigs/{rig}/inverse")
async def rig_inverse(rig: str, body: InverseRequest, parts: Parts) -> InverseBody:
    """Return the muscles, or action units, and the jaw that bring landmarks to their targets."""
    found = await parts.rigs.get(rig)
    inverse = await parts.insight.invert(found, body)
    return InverseBody.model_validate(inverse.to_json())
