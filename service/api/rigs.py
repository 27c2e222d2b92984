"""Rigs: what faces are made of, as JSON and as GLB."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from ..bodies import NewRig
from ..components import Parts
from ..rigs import FULL, UNITS, tag_of, targets_tag, tissue_tag
from .answers import TAGGED, GlbResponse, LevelOfDetail, Textured, client_has, tagged_glb

router = APIRouter(prefix="/api/rigs", tags=["rigs"])


@router.get("")
async def list_rigs(parts: Parts) -> dict[str, Any]:
    """List the rigs, the built-in ones first."""
    return {"rigs": await parts.rigs.lines()}


@router.post("", status_code=201, responses={200: {"description": "That content exists."}})
async def derive_rig(body: NewRig, parts: Parts, response: Response) -> dict[str, Any]:
    """Derive a rig: the same changes of the same rig always give the same id."""
    base = await parts.rigs.get(body.base)
    changes = body.model_dump(exclude={"base", "passing"}, exclude_none=True)
    rig, created = await parts.rigs.derive(base, changes, passing=body.passing)
    response.status_code = 201 if created else 200
    response.headers["Location"] = f"/api/rigs/{rig.id}"
    return rig.describe()


@router.get("/{rig}.glb", responses=TAGGED, response_class=GlbResponse)
async def rig_glb(
    rig: str,
    parts: Parts,
    request: Request,
    names: Annotated[
        str, Query(max_length=16, description="Of the morph targets: facs, or arkit.")
    ] = UNITS,
    level: LevelOfDetail = FULL,
    textured: Textured = True,
) -> Response:
    """Return the rest head with its action units, or ARKit's shapes, as morph targets."""
    found = await parts.rigs.get(rig)
    tag = targets_tag(found, level, names, textured=textured)
    if client_has(request, tag):
        return tagged_glb(request, b"", tag)
    data = await parts.rigs.glb(found, level, textured=textured, names=names)
    return tagged_glb(request, data, tag)


@router.get("/{rig}")
async def one_rig(rig: str, parts: Parts) -> dict[str, Any]:
    """Return a rig's muscles, action units, emotions, tissue constants and mesh sizes."""
    return (await parts.rigs.get(rig)).describe()


@router.get("/{rig}/surface.glb", responses=TAGGED, response_class=GlbResponse)
async def surface_glb(
    rig: str, parts: Parts, request: Request, level: LevelOfDetail = FULL
) -> Response:
    """Return the tissue surface in stream order, and the sparse map to the drawn surface."""
    found = await parts.rigs.get(rig)
    tag = tag_of(found, level)
    data = b"" if client_has(request, tag) else await parts.rigs.surface(found, level)
    return tagged_glb(request, data, tag)


@router.get("/{rig}/tissue.glb", responses=TAGGED, response_class=GlbResponse)
async def tissue_glb(rig: str, parts: Parts, request: Request) -> Response:
    """Return the sheets of tissue under the skin at rest, and their springs as lines."""
    found = await parts.rigs.get(rig)
    tag = tissue_tag(found)
    data = b"" if client_has(request, tag) else await parts.rigs.tissue(found)
    return tagged_glb(request, data, tag)
