"""The stream: one WebSocket that carries frames out and commands in."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

import anyio
from fastapi import APIRouter, WebSocket
from pydantic import ValidationError
from starlette.websockets import WebSocketDisconnect

from engine import Idle

from .access import Access
from .bodies import MESSAGE, AckMessage, ControlsMessage, IdleMessage
from .commands import controls_keyframe
from .components import Components, parts_of
from .emotions import play_emotion
from .errors import Refused, Unprocessable, error_body, json_response
from .explaining import explain
from .guard import KEY_SUBPROTOCOL
from .idle import idle_of
from .lines import LINE, Line
from .metrics import Metrics
from .protocol import SUBPROTOCOL
from .sessions import Session
from .viewers import Viewer

router = APIRouter()
_FRAMES = ("plain", "packed")
_PROTOCOL_ERROR = 1002
_NOT_ALLOWED = 1008
_TOO_BIG = 1009


@router.websocket("/api/sessions/{session_id}/stream")
async def stream(socket: WebSocket, session_id: str) -> None:
    """Send the session's frames and events; take commands."""
    offered = [n for n in socket.scope["subprotocols"] if not n.startswith(KEY_SUBPROTOCOL)]
    if offered and SUBPROTOCOL not in offered:
        # The handshake is completed in the client's own version, so that it can read the reason.
        await socket.accept(subprotocol=offered[0])
        await socket.close(_PROTOCOL_ERROR, f"this service speaks {SUBPROTOCOL} only")
        return
    try:
        parts = await parts_of(socket.scope)
        session = await parts.sessions.get(session_id)
        viewer = parts.sessions.watch(session, packed=_packed(socket))
    except Refused as refused:
        await socket.send_denial_response(
            json_response(refused.body(), status=refused.status, headers=refused.headers)
        )
        return
    ending = _end_with(socket.scope["risorius.access"], viewer)
    try:
        await socket.accept(subprotocol=SUBPROTOCOL if offered else None)
        view = await parts.sessions.view(session)
        role = socket.scope["risorius.access"].role
        frames = "packed" if viewer.packed else "plain"
        hello = {**session.hello(view), "role": role, "frames": frames}
        await socket.send_text(session.text_of(hello))
        await _converse(socket, parts, session, viewer)
    except (WebSocketDisconnect, Refused):
        pass  # The viewer left, or the session was closed between two lines above.
    finally:
        if ending is not None:
            ending.cancel()
        parts.sessions.leave(session, viewer)
        parts.metrics.frames_skipped.inc(viewer.skipped)


def _packed(socket: WebSocket) -> bool:
    """Tell whether a socket asks for packed frames.

    Raises:
        Unprocessable: If it asks for others than there are.
    """
    asked = socket.query_params.get("frames", _FRAMES[0])
    if asked not in _FRAMES:
        message = f"frames is {asked!r}; expected one of: {', '.join(_FRAMES)}"
        raise Unprocessable("unknown_frames", message, known=_FRAMES)
    return asked == "packed"


def _end_with(access: Access, viewer: Viewer) -> asyncio.TimerHandle | None:
    """Have a socket closed with the ticket that it was opened by, where it was by one."""
    if access.expires is None:
        return None
    left = access.expires - time.monotonic()
    loop = asyncio.get_running_loop()
    return loop.call_later(left, viewer.end, _NOT_ALLOWED, "the ticket is over")


async def _converse(socket: WebSocket, parts: Components, session: Session, viewer: Viewer) -> None:
    """Send and receive side by side until either ends."""
    async with anyio.create_task_group() as both:

        async def until_the_end(side: Callable[..., Awaitable[None]]) -> None:
            with suppress(WebSocketDisconnect):
                await side(socket, parts, session, viewer)
            both.cancel_scope.cancel()

        both.start_soon(until_the_end, _send)
        both.start_soon(until_the_end, _receive)


async def _send(socket: WebSocket, parts: Components, session: Session, viewer: Viewer) -> None:
    line = socket.scope.get("state", {}).get(LINE)
    if isinstance(line, Line):
        line.on_ack = viewer.acknowledge
        viewer.write_by(lambda: _write(line, parts.metrics, session, viewer))
    while True:
        await viewer.wait()
        for event in viewer.take_events():
            await socket.send_text(session.text_of(event))
        if viewer.ended is not None:
            await socket.close(*viewer.ended)
            return
        if viewer.take_frame(session.frame.tick):
            await socket.send_bytes(_encoded(parts.metrics, session, viewer))


def _write(line: Line, metrics: Metrics, session: Session, viewer: Viewer) -> bool:
    """Write the newest frame at once, if the one before is on its way."""
    if not line.is_free or not viewer.take_frame(session.frame.tick):
        return False
    line.write(_encoded(metrics, session, viewer))
    return True


def _encoded(metrics: Metrics, session: Session, viewer: Viewer) -> bytes:
    """Return the frame that a viewer has taken, and count it."""
    started = time.thread_time()
    data = session.frame_for(viewer)
    metrics.encoding_seconds.inc(time.thread_time() - started)
    metrics.frames_sent.inc()
    metrics.frame_bytes.inc(len(data))
    return data


async def _receive(socket: WebSocket, parts: Components, session: Session, viewer: Viewer) -> None:
    client = str(socket.scope.get("risorius.client", ""))
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return
        text = message.get("text")
        if text is None:
            viewer.offer(_error("invalid_message", "send JSON in text frames"))
        elif len(text) > parts.settings.max_message_bytes:
            viewer.end(_TOO_BIG, "the message is too big")
        else:
            # Done to its end though the socket ends meanwhile: a face must not obey what its
            # session does not know of.
            with anyio.CancelScope(shield=True):
                await _obey(text, client, parts, session, viewer)


async def _obey(
    text: str, client: str, parts: Components, session: Session, viewer: Viewer
) -> None:
    """Do what one message says; whatever is wrong with it is said back."""
    try:
        message = MESSAGE.validate_json(text)
        if isinstance(message, AckMessage):
            viewer.acknowledge(message.tick)
            return
        if not parts.rate.allow(client):
            viewer.offer(_TOO_MANY)
            return
        parts.sessions.check_commands()
        if isinstance(message, IdleMessage):
            await parts.sessions.live(session, _life(message, session))
            return
        if isinstance(message, ControlsMessage):
            keyframe = controls_keyframe(message, session.rig, replace=message.replace)
        else:
            keyframe = play_emotion(message, session.rig, session.turns).keyframe
        _, warnings = await parts.sessions.apply_unkept(session, keyframe)
        if isinstance(message, ControlsMessage):
            warnings += session.clashes_of(message, keyframe)
        for warning in warnings:
            viewer.offer({"type": "warning", "message": warning})
    except (ValidationError, UnicodeEncodeError) as error:
        if not parts.rate.allow(client):  # To say what is wrong takes longer than to obey.
            viewer.offer(_TOO_MANY)
            return
        details = error.errors() if isinstance(error, ValidationError) else []
        found = explain(list(details), _plain(text))
        viewer.offer(_error("invalid_message", found.message, found.known))
    except Refused as refused:
        viewer.offer({"type": "error", **refused.body()})


def _life(message: IdleMessage, session: Session) -> Idle | None:
    seed = session.idle.seed if session.idle else None
    return idle_of(message, seed=seed) if message.on else None


def _plain(text: str) -> object:
    """Return a message as plain data, None if it is not JSON."""
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return None


def _error(name: str, message: str, known: Sequence[str] | None = None) -> Mapping[str, Any]:
    return {"type": "error", **error_body(name, message, known=known)}


_TOO_MANY = _error("too_many_requests", "too many messages; slow down")
