"""Tickets: leave for a browser, or for whoever follows a link, to use one session for a while."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Request
from pydantic import BaseModel, Field

from ..bodies import Body
from ..components import Parts
from ..tickets import MAX_SECONDS, Role

router = APIRouter(prefix="/api/sessions", tags=["sessions"])


class NewTicket(Body):
    """A ticket to make."""

    role: Role = Field(
        default="read",
        description="read watches: state, stream and files; control commands the face too.",
    )
    seconds: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1, le=MAX_SECONDS)] = (
        Field(default=300.0, description="How long it lasts; a socket ends with it.")
    )


class IssuedTicket(BaseModel):
    """A ticket that was made.

    Attributes:
        ticket: For `?ticket=`, or wherever a key goes.
        role: What it allows.
        expires_in: How long it lasts [s].
        url: The page that shows the session, with the ticket in its address.
    """

    ticket: str
    role: Role
    expires_in: float
    url: str


@router.post("/{session_id}/tickets", status_code=201)
async def issue_ticket(
    session_id: str, body: NewTicket, parts: Parts, request: Request
) -> IssuedTicket:
    """Make a short-lived ticket for one session: for a browser's socket, or a link to share."""
    session = await parts.sessions.get(session_id)
    ticket = parts.tickets.issue(
        session.id, key=session.made_by or None, role=body.role, seconds=body.seconds
    )
    page = str(request.base_url).rstrip("/")
    return IssuedTicket(
        ticket=ticket,
        role=body.role,
        expires_in=body.seconds,
        url=f"{page}/?session={session.id}&ticket={ticket}",
    )
