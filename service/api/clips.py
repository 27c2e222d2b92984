"""Clips: timelines that are rendered to animation files."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Request, Response
from starlette.responses import FileResponse

from ..bodies import NewClip
from ..components import Parts
from ..errors import Refused
from .answers import ERROR_CONTENT, GLB, GLB_CONTENT, GlbResponse, Textured

router = APIRouter(prefix="/api/clips", tags=["clips"])
CSV_CONTENT: dict[int | str, dict[str, Any]] = {
    200: {"description": "Ground truth, a line a frame.", "content": {"text/csv": {}}}
}


def _refuse_tracks(request: Request) -> None:
    if request.headers.get("content-type", "").partition(";")[0].strip().lower() == "text/csv":
        refused = Refused(
            "not_available", "tracker files are not available yet; send a timeline as JSON"
        )
        refused.status = 415
        raise refused


@router.post(
    "",
    status_code=202,
    dependencies=[Depends(_refuse_tracks)],
    responses={
        **GLB_CONTENT,
        202: {"description": "The clip is queued; Location says where it will be."},
        415: {"description": "Tracker files are not available yet.", "content": ERROR_CONTENT},
    },
)
async def render_clip(
    body: NewClip,
    parts: Parts,
    response: Response,
    wait: Annotated[float, Query(ge=0, le=60, allow_inf_nan=False)] = 0.0,
    textured: Textured = True,
) -> Any:
    """Queue a clip; with `wait`, answer with its GLB if it is done by then."""
    if not textured:
        body = body.model_copy(update={"textures": False})
    row = await parts.clips.submit(body)
    if wait:
        row = await parts.clips.wait(row.id, wait)
    location = f"/api/clips/{row.id}"
    if row.status == "done":
        path = parts.clips.file(row.id, "glb")
        return FileResponse(path, media_type=GLB, headers={"Location": location})
    response.headers["Location"] = location
    return parts.clips.describe(row)


@router.get("")
async def list_clips(parts: Parts) -> dict[str, Any]:
    """List the clips, oldest first."""
    return {"clips": [parts.clips.describe(row) for row in parts.clips.rows()]}


@router.get("/{clip}.glb", responses=GLB_CONTENT, response_class=GlbResponse)
async def clip_glb(clip: str, parts: Parts) -> Response:
    """Return a finished clip's animation."""
    return FileResponse(parts.clips.file(clip, "glb"), media_type=GLB)


@router.get("/{clip}.csv", responses=CSV_CONTENT, response_class=Response)
async def clip_csv(clip: str, parts: Parts) -> Response:
    """Return a finished clip's ground truth: activations, pose and landmarks of each frame."""
    return FileResponse(parts.clips.file(clip, "csv"), media_type="text/csv")


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
