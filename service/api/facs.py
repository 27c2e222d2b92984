"""FACS for tools: a string read for a rig, checked by FACS' rules, and written canonically."""

from __future__ import annotations

from fastapi import APIRouter

from ..bodies import FacsRequest
from ..components import Parts
from ..facs_reading import FacsReading, read_facs

router = APIRouter(prefix="/api/facs", tags=["facs"])


@router.post("")
async def facs(body: FacsRequest, parts: Parts) -> FacsReading:
    """Read FACS, or write units as FACS: canonical form, units, and warnings by rule."""
    return read_facs(body, await parts.rigs.get(body.rig))
