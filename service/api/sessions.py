"""Sessions: live faces, and the commands that move them."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response

from engine import LETS_GO, SPEAKER, UnknownName, face_to_glb

from ..bodies import (
    Controls,
    EmotionCommand,
    MuscleChanges,
    NewSession,
    Owner,
    Scale,
    SpeechCommand,
    TissueChanges,
)
from ..commands import controls_keyframe, live_model
from ..components import Components, Parts
from ..emotions import play_emotion
from ..errors import Conflict, json_response, refused_by_engine
from ..facs import with_facs
from ..idle import idle_of
from ..recording import record_last
from ..rigs import FULL, tag_of
from ..sessions import Session
from ..speech import silence, spoken
from .answers import AT_CAPACITY, GLB_CONTENT, GlbResponse, LevelOfDetail, Textured

router = APIRouter(prefix="/api/sessions", tags=["sessions"])
RECORDED: dict[int | str, dict[str, Any]] = {
    **GLB_CONTENT,
    202: {"description": "It is still being rendered; Location says where the clip will be."},
}


@router.post("", status_code=201, responses=AT_CAPACITY)
async def open_session(parts: Parts, response: Response, body: NewSession) -> dict[str, Any]:
    """Open a session, a face at rest or, with `idle`, alive; 429 while no more can move."""
    rig = await parts.rigs.get(body.rig)
    session = await parts.sessions.open(rig, live_model(body.model, rig), idle_of(body.idle))
    response.headers["Location"] = f"/api/sessions/{session.id}"
    return session.describe()


@router.get("")
async def list_sessions(parts: Parts) -> dict[str, Any]:
    """List the sessions, oldest first."""
    return {"sessions": parts.sessions.lines()}


@router.get("/{session_id}.glb", responses=GLB_CONTENT, response_class=GlbResponse)
async def session_glb(session_id: str, parts: Parts, textured: Textured = True) -> Response:
    """Return the face as it stands: plain positions, deformation baked."""
    session = await parts.sessions.get(session_id)
    view = await parts.sessions.view(session)
    rig = session.rig
    maps = await parts.rigs.textures(rig) if textured else None
    data = await parts.rigs.written(lambda: face_to_glb(rig, view.frame, textures=maps))
    return GlbResponse(data, headers={"Cache-Control": "no-store"})


@router.get("/{session_id}/recording.glb", responses=RECORDED, response_class=GlbResponse)
async def recording_glb(
    session_id: str,
    parts: Parts,
    last: Annotated[
        float, Query(gt=0, le=3600, allow_inf_nan=False, description="Seconds to record.")
    ] = 10.0,
    fps: Annotated[int, Query(ge=1, le=60, description="Frames a second.")] = 30,
    level: LevelOfDetail = FULL,
    textured: Textured = True,
    wait: Annotated[
        float, Query(ge=0, le=60, allow_inf_nan=False, description="Most seconds to wait.")
    ] = 60.0,
) -> Response:
    """Return what the face did last as an animation: its commands again, rendered as a clip is.

    The clip is forgotten once it has been answered; one that is not done in time is kept.
    """
    session = await parts.sessions.get(session_id)
    tag_of(session.rig, level)
    clip = await record_last(parts.sessions, session, last=last, fps=fps)
    clip = clip.model_copy(update={"level": level, "textures": textured})
    row = await parts.clips.wait((await parts.clips.submit(clip)).id, wait)
    if row.status in ("queued", "running"):
        headers = {"Location": f"/api/clips/{row.id}"}
        return json_response(parts.clips.describe(row), status=202, headers=headers)
    done = row.status == "done"
    data = await asyncio.to_thread(parts.clips.file(row.id, "glb").read_bytes) if done else b""
    await parts.clips.remove(row.id)
    if not done:
        message = row.message or "the recording could not be rendered"
        raise Conflict(f"clip_{row.status}", message)
    return GlbResponse(data, headers={"Cache-Control": "no-store"})


@router.get("/{session_id}")
async def one_session(
    session_id: str,
    parts: Parts,
    scale: Annotated[Scale, Query(description="How letters of `merged.facs` are written.")] = (
        "linear"
    ),
) -> dict[str, Any]:
    """Return a session: what each writer of each layer holds, and what they make together."""
    session = await parts.sessions.get(session_id)
    view = await parts.sessions.view(session)
    return {**session.describe(), "tick": view.frame.tick, **with_facs(view.report, scale)}


@router.delete("/{session_id}", status_code=204)
async def close_session(session_id: str, parts: Parts) -> None:
    """Close a session for good."""
    await parts.sessions.close(session_id)


@router.put("/{session_id}/controls")
async def put_controls(session_id: str, body: Controls, parts: Parts) -> dict[str, Any]:
    """Replace what the owner holds in the layer; without an owner, what everybody holds there.

    With no controls in it, it releases them, over `fade`.
    """
    return await _control(session_id, body, parts, replace=True)


@router.patch("/{session_id}/controls")
async def patch_controls(session_id: str, body: Controls, parts: Parts) -> dict[str, Any]:
    """Move only what is named; what else the owner holds in the layer stays, for as long as said.

    Of what several owners of a layer hold, the last to come counts; see `warnings` for who waits.
    """
    return await _control(session_id, body, parts, replace=False)


@router.post("/{session_id}/emotions")
async def play(session_id: str, body: EmotionCommand, parts: Parts) -> dict[str, Any]:
    """Play an emotion: a label, a scored list, or coordinates of feeling."""
    session = await parts.sessions.get(session_id)
    played = play_emotion(body, session.rig, session.turns)
    tick, warnings = await parts.sessions.apply(session, played.keyframe)
    return {"tick": tick, **played.describe(), "warnings": warnings}


@router.post("/{session_id}/speech")
async def speak(session_id: str, body: SpeechCommand, parts: Parts) -> dict[str, Any]:
    """Play visemes in time, from now on; what the owner had still to say is dropped."""
    session = await parts.sessions.get(session_id)
    # Thousands of visemes take longer than frames of other faces may wait.
    speech = await asyncio.to_thread(spoken, body, session.rig)
    tick = await parts.sessions.perform(session, speech.keyframes)
    return {
        "tick": tick,
        "owner": body.owner,
        "sound_in": body.delay,
        "seconds": round(speech.seconds, 4),
        "keyframes": len(speech.keyframes),
        "warnings": speech.warnings,
    }


@router.delete("/{session_id}/speech")
async def be_silent(
    session_id: str,
    parts: Parts,
    owner: Annotated[Owner, Query(description="Whose speech ends.")] = SPEAKER,
    fade: Annotated[
        float, Query(ge=0, le=3600, description="Seconds over which the mouth lets go.")
    ] = LETS_GO,
) -> dict[str, Any]:
    """End a speech: what is still to come is dropped, and the mouth lets go."""
    session = await parts.sessions.get(session_id)
    return {"tick": await parts.sessions.perform(session, [silence(owner, fade)])}


@router.patch("/{session_id}/tissue")
async def edit_tissue(session_id: str, body: TissueChanges, parts: Parts) -> dict[str, Any]:
    """Change tissue constants live: the face moves over to the derived rig as it stands."""
    session = await parts.sessions.get(session_id)
    return await _edit(session, {"tissue": body}, parts)


@router.patch("/{session_id}/muscles/{muscle}")
async def edit_muscle(
    session_id: str, muscle: str, body: MuscleChanges, parts: Parts
) -> dict[str, Any]:
    """Change one muscle live: the face moves over to the derived rig as it stands."""
    session = await parts.sessions.get(session_id)
    try:
        session.rig.muscle(muscle)
    except UnknownName as error:
        raise refused_by_engine(error, status=404) from error
    return await _edit(session, {"muscles": {muscle: body}}, parts)


async def _control(
    session_id: str, body: Controls, parts: Components, *, replace: bool
) -> dict[str, Any]:
    session = await parts.sessions.get(session_id)
    keyframe = controls_keyframe(body, session.rig, replace=replace)
    tick, warnings = await parts.sessions.apply(session, keyframe)
    warnings += session.clashes_of(body, keyframe)
    return {"tick": tick, "scale": body.scale, "warnings": warnings}


async def _edit(session: Session, changes: dict[str, Any], parts: Components) -> dict[str, Any]:
    async with session.editing:
        rig, created = await parts.rigs.derive(session.rig, changes, passing=True)
        tick = await parts.sessions.move(session, rig)
    return {"tick": tick, "rig": rig.id, "created": created}
