"""Expressions without a session: `1C+2C+L12D` settled, as a file and as a picture, cacheable."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Annotated, Any, ClassVar, Literal

from fastapi import APIRouter, Query, Request, Response

from engine import FacsWarning

from ..bodies import Scale
from ..components import Components, Parts
from ..errors import Unprocessable
from ..expressions import read_expression
from ..rigs import FULL
from ..stage import VIEWS, Look
from .answers import (
    ERROR_CONTENT,
    GLB,
    TAGGED,
    GlbResponse,
    LevelOfDetail,
    Textured,
    client_has,
)
from .leaving import AskerLeft, while_there

router = APIRouter(prefix="/api/rigs/{rig}/expressions", tags=["rigs"])
PNG = "image/png"
_WARNINGS = "Facs-Warnings"
_NOBODY = 499
"""Status of an answer that nobody is there to read."""
_HEADERS: dict[str, Any] = {
    "ETag": {"description": "What names this content.", "schema": {"type": "string"}},
    "Cache-Control": {"description": "How long it may be shown.", "schema": {"type": "string"}},
    _WARNINGS: {
        "description": "Rules of FACS that the expression breaks, each with its units, such as "
        "`head_turns_one_way=AU51+AU52`; POST /api/facs says them in full.",
        "schema": {"type": "string"},
    },
}
_FACE: dict[int | str, dict[str, Any]] = {
    **TAGGED,
    200: {**TAGGED[200], "headers": _HEADERS},
}
_PICTURE: dict[int | str, dict[str, Any]] = {
    **TAGGED,
    200: {
        "description": "A PNG picture.",
        "content": {PNG: {"schema": {"type": "string", "format": "binary"}}},
        "headers": _HEADERS,
    },
    501: {
        "description": "There is no viewer or no Chromium here to draw pictures with.",
        "content": ERROR_CONTENT,
    },
}
Letters = Annotated[Scale, Query(description="How its letters are read.")]
View = Annotated[
    str,
    Query(
        max_length=16,
        description=f"Where it is seen from: {', '.join(VIEWS)}, or degrees aside, -180 to 180.",
    ),
]


class PngResponse(Response):
    """A PNG picture."""

    media_type: ClassVar[str] = PNG  # type: ignore[misc]


@router.get("/{facs}.glb", responses=_FACE, response_class=GlbResponse)
async def expression_glb(
    rig: str,
    facs: str,
    parts: Parts,
    request: Request,
    scale: Letters = "linear",
    level: LevelOfDetail = FULL,
    textured: Textured = True,
) -> Response:
    """Return an expression such as `1C+2C+L12D`, settled and baked."""
    found = await parts.rigs.get(rig)
    asked = read_expression(facs, scale, found)
    made = parts.expressions
    tag = made.face_tag(found, asked, level, textured=textured)
    return await _cached(
        request,
        parts,
        tag,
        asked.warnings,
        lambda: made.face(rig, found, asked, level, textured=textured),
        GLB,
    )


@router.get("/{facs}.png", responses=_PICTURE, response_class=PngResponse)
async def expression_png(
    rig: str,
    facs: str,
    parts: Parts,
    request: Request,
    scale: Letters = "linear",
    size: Annotated[int, Query(ge=64, le=1024, description="Side of the picture, pixels.")] = 512,
    view: View = "front",
    whole: Annotated[
        bool, Query(description="Show the head with its hair and neck, not the face alone.")
    ] = False,
    theme: Annotated[
        Literal["dark", "light"], Query(description="What stands behind the face.")
    ] = "dark",
) -> Response:
    """Return a picture of an expression such as `1C+2C+L12D`, as the viewer draws it."""
    found = await parts.rigs.get(rig)
    asked = read_expression(facs, scale, found)
    look = Look(view=_seen_from(view), size=size, whole=whole, theme=theme)
    made = parts.expressions
    tag = made.picture_tag(found, asked, look)
    return await _cached(
        request, parts, tag, asked.warnings, lambda: made.picture(rig, found, asked, look), PNG
    )


def _seen_from(view: str) -> str:
    """Return a view in its one form.

    Raises:
        Unprocessable: If there is none of that name.
    """
    if view in VIEWS:
        return view
    degrees = view.removeprefix("-")
    if degrees.isascii() and degrees.isdigit() and int(degrees) <= 180:
        return str(int(view))
    message = f"there is no view {view!r}; it is one of {', '.join(VIEWS)}, or degrees aside"
    raise Unprocessable("unknown_view", message, known=VIEWS)


async def _cached(
    request: Request,
    parts: Components,
    tag: str,
    warnings: Sequence[FacsWarning],
    make: Callable[[], Awaitable[bytes]],
    media_type: str,
) -> Response:
    headers = {"ETag": f'"{tag}"', "Cache-Control": _lifetime(parts)}
    if warnings:
        headers[_WARNINGS] = "; ".join(f"{each.rule}={'+'.join(each.units)}" for each in warnings)
    if client_has(request, tag):
        return Response(status_code=304, headers=headers)
    try:
        data = await while_there(request, make())
    except AskerLeft:
        return Response(status_code=_NOBODY)
    return Response(data, media_type=media_type, headers=headers)


def _lifetime(parts: Components) -> str:
    """Return for how long it is shown unasked: a day; where keys are asked for, by who asked."""
    return f"{'private' if parts.keys.required else 'public'}, max-age=86400"
