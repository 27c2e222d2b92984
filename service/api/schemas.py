"""Schemas: what files and bodies may say, for editors and for programs that write them."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from ..schemas import timeline_schema

router = APIRouter(prefix="/api/schemas", tags=["schemas"])


@router.get("/timeline.json")
async def timeline() -> dict[str, Any]:
    """Return the JSON Schema of a timeline: every control, layer and envelope of a keyframe."""
    return timeline_schema()
