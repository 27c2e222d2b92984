"""What answers look like: documented errors, JSON bodies, GLB files with their tag."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from fastapi import Query, Request
from pydantic import BaseModel
from starlette.responses import Response

GLB = "model/gltf-binary"


class ErrorBody(BaseModel):
    """The one shape of every error."""

    error: str
    message: str
    known: list[str] | None = None


_MEANINGS = {
    400: "The body is not JSON.",
    401: "Keys are set, and none was sent.",
    403: "Pages of this origin may not use the service, or this ticket is not for that.",
    404: "There is no such thing.",
    409: "The thing is not in a state for this.",
    413: "The body is too large.",
    421: "The service does not answer for this host.",
    422: "A name or a value cannot be used.",
    429: "Too many requests, or more than the key may take; Retry-After says when to ask again.",
    503: "A limit is reached, or the service warms up.",
}
# Written out, because FastAPI would give a model the media type of the route's good answer.
ERROR_CONTENT = {"application/json": {"schema": ErrorBody.model_json_schema()}}
ERRORS: dict[int | str, dict[str, Any]] = {
    status: {"description": meaning, "content": ERROR_CONTENT}
    for status, meaning in _MEANINGS.items()
}
AT_CAPACITY: dict[int | str, dict[str, Any]] = {
    429: {
        "description": "Too many requests, or the faces that move take as much of a tick as they "
        "may (`at_capacity`); live ones keep their rate.",
        "content": ERROR_CONTENT,
        "headers": {
            "Retry-After": {
                "description": "Seconds after which to ask again.",
                "schema": {"type": "integer"},
            }
        },
    }
}
GLB_CONTENT: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "A GLB file.",
        "content": {GLB: {"schema": {"type": "string", "format": "binary"}}},
    }
}
TAGGED: dict[int | str, dict[str, Any]] = {
    **GLB_CONTENT,
    304: {"description": "The client has it already."},
}


Textured = Annotated[
    bool, Query(alias="textures", description="Whether the maps of skin and eyes are embedded.")
]

LevelOfDetail = Annotated[
    str, Query(max_length=16, description="Detail of the drawn skin: low, medium or high.")
]


class GlbResponse(Response):
    """A GLB file."""

    media_type: ClassVar[str] = GLB  # type: ignore[misc]


def tagged_glb(request: Request, data: bytes, tag: str) -> Response:
    """Return a GLB that depends on its tag alone, or 304 if the client has it."""
    return tagged(request, data, tag, GLB)


def tagged(request: Request, data: bytes, tag: str, media_type: str) -> Response:
    """Return bytes that depend on their tag alone, or 304 if the client has them."""
    headers = {"ETag": f'"{tag}"', "Cache-Control": "no-cache"}
    if client_has(request, tag):
        return Response(status_code=304, headers=headers)
    return Response(data, media_type=media_type, headers=headers)


def client_has(request: Request, tag: str) -> bool:
    """Return whether the client named `tag` as one it has."""
    offered = request.headers.get("if-none-match", "")
    tags = {part.strip().removeprefix("W/").strip('"') for part in offered.split(",")}
    return tag in tags or offered.strip() == "*"
