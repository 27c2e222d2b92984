"""Clips: timelines and trackers' files that are rendered to animation files."""

from __future__ import annotations

import base64
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Query, Request, Response
from pydantic import ValidationError
from starlette.responses import FileResponse, StreamingResponse

from ..bodies import NewClip
from ..clip_events import clip_events, has_heard
from ..components import Components, Parts
from ..errors import Unprocessable
from ..explaining import explain, is_json
from ..store import ClipRow
from ..tracks import TrackClip, query_parameters
from ..uploads import MEDIA_TYPES, Upload, media_type
from .answers import ERROR_CONTENT, GLB, GLB_CONTENT, GlbResponse, Textured, client_has

router = APIRouter(prefix="/api/clips", tags=["clips"])
_NOT_OF_TRACKS = ("wait", "ticket")
_OF_TRACKS = {parameter["name"] for parameter in query_parameters()}
_CSV = "text/csv"
_EVENTS = "text/event-stream"
CSV_CONTENT: dict[int | str, dict[str, Any]] = {
    200: {"description": "Ground truth, a line a frame.", "content": {_CSV: {}}}
}
UNCHANGED: dict[int | str, dict[str, Any]] = {304: {"description": "The client has it already."}}
_EVENT = {
    "type": "object",
    "properties": {
        "event": {"enum": ["progress", "end"]},
        "id": {"type": "string"},
        "data": {"type": "string", "contentMediaType": "application/json"},
    },
    "required": ["event", "id", "data"],
}
_EVENTS_CONTENT: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "Events named `progress`, then one named `end`: each has as its data what "
        "GET of the clip answers.",
        "content": {_EVENTS: {"schema": _EVENT}},
    },
    204: {"description": "By its Last-Event-ID the client has heard the end."},
}
_FILE = {"schema": {"type": "string", "format": "binary"}}
_TRACKS_TOO = {
    "parameters": query_parameters(),
    "requestBody": {"required": True, "content": {kind: _FILE for kind in MEDIA_TYPES}},
}


def _refuse_other_bodies(request: Request) -> None:
    """Refuse what is neither a timeline nor a tracker's file, by its content type.

    Raises:
        Unprocessable: If it is.
    """
    kind = media_type(request.headers)
    if "risorius.upload" not in request.scope and kind and not is_json(kind):
        raise Unprocessable(
            "invalid_body",
            f"the body was sent as {kind[:40]!r}; send a timeline as application/json, or a "
            f"tracker's file as {' or '.join(MEDIA_TYPES)}",
        )


@router.post(
    "",
    status_code=202,
    dependencies=[Depends(_refuse_other_bodies)],
    responses={
        **GLB_CONTENT,
        202: {"description": "The clip is queued; Location says where it will be."},
        408: {"description": "The rest of the file does not come.", "content": ERROR_CONTENT},
        415: {"description": "The file comes packed, as by gzip.", "content": ERROR_CONTENT},
    },
    openapi_extra=_TRACKS_TOO,
)
async def render_clip(
    request: Request,
    parts: Parts,
    response: Response,
    wait: Annotated[float, Query(ge=0, le=60, allow_inf_nan=False)] = 0.0,
    textured: Textured = True,
    # Not `| None`: what is wrong with a timeline would be told of that form too.
    body: NewClip = None,  # type: ignore[assignment]
) -> Any:
    """Queue a clip of a timeline or a tracker's file; with `wait`, answer with its GLB if done."""
    upload: Upload | None = request.scope.get("risorius.upload")
    if upload is not None:
        row = await parts.clips.submit_track(_asked_of_track(request), upload)
    elif body is not None:
        _refuse_options_of_tracks(request)
        clip = body if textured else body.model_copy(update={"textures": False})
        row = await parts.clips.submit(clip)
    else:
        message = "the body is empty; send a timeline as application/json, or a tracker's file"
        raise Unprocessable("invalid_body", message)
    if wait:
        row = await parts.clips.wait(row.id, wait)
    location = f"/api/clips/{row.id}"
    if row.status == "done":
        return _file(parts, row, "glb", GLB, {"Location": location})
    response.headers["Location"] = location
    return parts.clips.describe(row)


def _refuse_options_of_tracks(request: Request) -> None:
    """Refuse what is asked of trackers' files where a timeline is sent, which would not hear it.

    Raises:
        Unprocessable: If something is.
    """
    for name in request.query_params:
        if name in _OF_TRACKS:
            raise Unprocessable(
                "invalid_query",
                f"{name!r} in the address is for trackers' files; what a timeline is rendered "
                "with, as fps, level and form, stands in its body",
            )


def _asked_of_track(request: Request) -> TrackClip:
    """Return what is asked of a tracker's file in the address.

    Raises:
        Unprocessable: For what there is not, or cannot be.
    """
    asked = {k: v for k, v in request.query_params.items() if k not in _NOT_OF_TRACKS}
    try:
        return TrackClip.model_validate_strings(asked)
    except ValidationError as error:
        found = explain(list(error.errors()), asked)
        raise Unprocessable("invalid_query", found.message, known=found.known) from error


@router.get("")
async def list_clips(parts: Parts) -> dict[str, Any]:
    """List the clips, oldest first, without what became of each row of a tracker's file."""
    return {"clips": [parts.clips.outline(row) for row in parts.clips.rows()]}


@router.get("/{clip}.glb", responses={**GLB_CONTENT, **UNCHANGED}, response_class=GlbResponse)
async def clip_glb(clip: str, request: Request, parts: Parts) -> Response:
    """Return a finished clip's animation."""
    return _file_or_unchanged(request, parts, clip, "glb", GLB)


@router.get("/{clip}.csv", responses={**CSV_CONTENT, **UNCHANGED}, response_class=Response)
async def clip_csv(clip: str, request: Request, parts: Parts) -> Response:
    """Return a finished clip's ground truth: activations, pose and landmarks of each frame."""
    return _file_or_unchanged(request, parts, clip, "csv", _CSV)


@router.get("/{clip}/events", responses=_EVENTS_CONTENT, response_class=StreamingResponse)
async def events_of_clip(
    clip: str,
    request: Request,
    parts: Parts,
    last_event: Annotated[
        str, Header(alias="Last-Event-ID", max_length=64, description="The last one heard.")
    ] = "",
) -> Response:
    """Tell how far a clip is until it has ended, as server-sent events."""
    if has_heard(parts.clips.row(clip), last_event):
        return Response(status_code=204)  # A browser then asks no more.
    events = clip_events(parts.clips, clip, lambda: _is_welcome(request, parts))
    headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
    return StreamingResponse(events, media_type=_EVENTS, headers=headers)


@router.get("/{clip}")
async def one_clip(
    clip: str,
    parts: Parts,
    wait: Annotated[float, Query(ge=0, le=60, allow_inf_nan=False)] = 0.0,
) -> dict[str, Any]:
    """Return how far a clip is; with `wait`, once it has ended or that time is over."""
    return parts.clips.describe(await parts.clips.wait(clip, wait))


@router.delete("/{clip}", status_code=204)
async def remove_clip(clip: str, parts: Parts) -> None:
    """Cancel a clip that is not done; forget one that has ended."""
    await parts.clips.remove(clip)


def _is_welcome(request: Request, parts: Components) -> bool:
    """Return whether who asked would still be let in."""
    key = request.scope["risorius.access"].key
    return not parts.keys.required if key is None else parts.keys.allowance(key) is not None


def _file_or_unchanged(
    request: Request, parts: Components, clip: str, suffix: str, kind: str
) -> Response:
    answer = _file(parts, parts.clips.row(clip), suffix, kind, {})
    if client_has(request, answer.headers.get("etag", "").strip('"')):
        kept = ("etag", "repr-digest")
        headers = {name: answer.headers[name] for name in kept if name in answer.headers}
        return Response(status_code=304, headers=headers)
    return answer


def _file(
    parts: Components, row: ClipRow, suffix: str, kind: str, headers: dict[str, str]
) -> Response:
    """Return a finished clip's file, tagged by its checksum: RFC 9530's Repr-Digest has it too."""
    path = parts.clips.file(row.id, suffix)
    digest = row.report.get("sha256", {}).get(suffix)
    if digest is not None:
        encoded = base64.b64encode(bytes.fromhex(digest)).decode()
        headers |= {"ETag": f'"{digest}"', "Repr-Digest": f"sha-256=:{encoded}:"}
    return FileResponse(path, media_type=kind, headers=headers)
