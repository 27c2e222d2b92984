"""Textures: what a rig's skin looks like up close, as images."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response

from ..components import Parts
from ..errors import NotFound
from .answers import client_has, tagged

router = APIRouter(prefix="/api/rigs", tags=["rigs"])
IMAGES: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "An image.",
        "content": {
            kind: {"schema": {"type": "string", "format": "binary"}} for kind in ("image/jpeg",)
        },
    },
    304: {"description": "The client has it already."},
}


@router.get("/{rig}/textures/{file}", responses=IMAGES, response_class=Response)
async def texture(rig: str, file: str, parts: Parts, request: Request) -> Response:
    """Return one of the maps of a rig's skin and eyes; the first request waits for all."""
    found = await parts.rigs.get(rig)
    known = parts.rigs.texture_names(found)
    if file not in known:
        raise NotFound("unknown_texture", f"rig {rig!r} has no texture {file!r}", known=known)
    tag = parts.rigs.texture_tag(found, file)
    kind = "image/jpeg"
    if client_has(request, tag):
        return tagged(request, b"", tag, kind)
    return tagged(request, (await parts.rigs.textures(found))[file], tag, kind)
