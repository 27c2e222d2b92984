"""Maps from the names of other vocabularies to action units: versioned, with their sources."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from engine import arkit_table, viseme_table

router = APIRouter(prefix="/api/maps", tags=["rigs"])


@router.get("/arkit")
async def arkit_map() -> dict[str, Any]:
    """Return what each of ARKit's 52 blend shapes plays."""
    return {"name": "arkit", **arkit_table().to_json()}


@router.get("/visemes")
async def viseme_map() -> dict[str, Any]:
    """Return what each of Oculus' 15 visemes plays."""
    return {"name": "visemes", **viseme_table().to_json()}
