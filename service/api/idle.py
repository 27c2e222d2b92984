"""Idle life: what a face does while nobody asks anything of it."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from ..bodies import IdleLife
from ..components import Parts
from ..idle import idle_of

router = APIRouter(prefix="/api/sessions/{session_id}/idle", tags=["sessions"])


@router.get("")
async def idle_life(session_id: str, parts: Parts) -> dict[str, Any]:
    """Return the idle life that a session has, null if none."""
    return {"idle": (await parts.sessions.get(session_id)).life}


@router.put("")
async def put_idle_life(session_id: str, body: IdleLife, parts: Parts) -> dict[str, Any]:
    """Have the face live an idle life from now on, in place of the one it has.

    Without a seed it keeps the one it has, or takes one that the answer tells.
    """
    session = await parts.sessions.get(session_id)
    seed = session.idle.seed if session.idle else None
    tick = await parts.sessions.live(session, idle_of(body, seed=seed))
    return {"tick": tick, "idle": session.life}


@router.delete("")
async def end_idle_life(session_id: str, parts: Parts) -> dict[str, Any]:
    """End the idle life: eyes and head go back to where commands have them."""
    session = await parts.sessions.get(session_id)
    return {"tick": await parts.sessions.live(session, None), "idle": session.life}
