"""The tools of a live face: open it, set what it shows, and look at it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from ..bodies import Controls, EmotionCommand, IdleLife, LayerName, ModelChoice
from ..commands import controls_keyframe, live_model
from ..components import Components
from ..emotions import play_emotion
from ..errors import QuotaExceeded, Unprocessable
from ..facs import with_facs, written
from ..idle import idle_of
from ..sessions import Session
from .answered import EmotionSet, FaceNow, LayerState, OpenedFace, UnitsSet, WriterState
from .asked import GetState, OpenFace, SetActionUnits, SetEmotion
from .caller import Caller

LAYER: LayerName = "emotion"
"""Where all that agents set goes: so the latest call is what is seen, whichever tool it was."""
_POSED = ("jaw", "gaze", "head", "tongue")


async def open_face(asked: OpenFace, parts: Components, caller: Caller) -> OpenedFace:
    """Open a session, a face at rest."""
    rig = await parts.rigs.get(asked.rig)
    idle = idle_of(IdleLife() if asked.alive else None)
    session = await parts.sessions.open(rig, live_model(ModelChoice(), rig), idle)
    sockets = caller.base_url.replace("http", "ws", 1)
    return OpenedFace(
        session_id=session.id,
        viewer_url=_page_of(session, parts, caller),
        stream_url=f"{sockets}/api/sessions/{session.id}/stream",
        rig=rig.name or rig.id,
        owner=caller.owner,
    )


async def set_emotion(asked: SetEmotion, parts: Components, caller: Caller) -> EmotionSet:
    """Play an emotion in place of what this client has set before."""
    session = await parts.sessions.get(asked.session_id)
    command = EmotionCommand(
        **asked.model_dump(exclude={"session_id"}), layer=LAYER, owner=caller.owner
    )
    played = play_emotion(command, session.rig, session.turns)
    tick, warnings = await parts.sessions.apply(session, replace(played.keyframe, replace=True))
    resolved = played.resolved
    return EmotionSet(
        recipe=resolved.facs,
        action_units=dict(played.action_units),
        source=resolved.source,
        label=resolved.label or None,
        found=resolved.found,
        tick=tick,
        owner=caller.owner,
        warnings=warnings,
    )


async def set_action_units(asked: SetActionUnits, parts: Components, caller: Caller) -> UnitsSet:
    """Set action units, in place of what this client has set before or beside it."""
    if asked.facs is None and asked.action_units is None:
        message = "give 'facs' such as 6C+12D, or 'action_units' such as {\"AU12\": 0.8}"
        raise Unprocessable("invalid_body", message)
    session = await parts.sessions.get(asked.session_id)
    controls = Controls(
        facs=asked.facs,
        action_units=asked.action_units,
        scale=asked.scale,
        fade=asked.fade_in,
        hold=asked.hold,
        fade_out=asked.fade_out,
        layer=LAYER,
        owner=caller.owner,
    )
    keyframe = controls_keyframe(controls, session.rig, replace=not asked.keep)
    if not asked.keep and any(keyframe.action_units.values()):
        keyframe = replace(keyframe, expression=True)
    tick, warnings = await parts.sessions.apply(session, keyframe)
    warnings += session.clashes_of(controls, keyframe)
    units = _held_by(session, caller.owner, tick)
    return UnitsSet(
        facs=written(units, asked.scale),
        action_units=units,
        scale=asked.scale,
        tick=tick,
        owner=caller.owner,
        warnings=warnings,
    )


async def get_state(asked: GetState, parts: Components, caller: Caller) -> FaceNow:
    """Return what a face is told to show, by whom."""
    session = await parts.sessions.get(asked.session_id)
    view = await parts.sessions.view(session)
    report: Any = with_facs(view.report)
    merged = report["merged"]
    return FaceNow(
        session_id=session.id,
        viewer_url=_page_of(session, parts, caller),
        rig=session.rig.name or session.rig.id,
        facs=merged["facs"],
        action_units=merged["action_units"],
        pose={
            group: commanded
            for group in _POSED
            if (commanded := {axis: v for axis, v in merged.get(group, {}).items() if v != 0.0})
        },
        layers=[_layer(name, held) for name, held in report["layers"].items()],
        writers=merged["writers"],
        asleep=view.frame.asleep,
        viewers=len(session.viewers),
        tick=view.frame.tick,
    )


def _layer(name: Any, held: Mapping[str, Any]) -> LayerState:
    return LayerState(
        layer=name,
        facs=written(held["action_units"]),
        weight=held["weight"],
        writers=[
            WriterState(
                owner=writer["owner"],
                facs=written(writer["action_units"]),
                emotion=_named(writer["emotion"]) if "emotion" in writer else None,
                expires_in=writer["expires_in"],
            )
            for writer in held["writers"]
        ],
    )


def _named(emotion: Mapping[str, Any]) -> str:
    """Return an emotion's label, or what is mixed: "0.6 happiness + 0.3 surprise"."""
    if emotion["label"] is not None:
        return str(emotion["label"])
    return " + ".join(f"{part['weight']:.2g} {part['recipe']}" for part in emotion["parts"])


def _held_by(session: Session, owner: str, tick: int) -> dict[str, float]:
    """Return the action units that an owner holds among those that agents set."""
    layer: Any = session.held.report(tick).get(LAYER, {"writers": []})
    return next((w["action_units"] for w in layer["writers"] if w["owner"] == owner), {})


def _page_of(session: Session, parts: Components, caller: Caller) -> str:
    """Return the page of a session; where keys are set, with a ticket that lasts half a day."""
    page = caller.viewer_of(session.id)
    if not session.made_by:
        return page
    with suppress(QuotaExceeded):  # Whoever has so many links out can make one when one is over.
        return f"{page}&ticket={parts.tickets.of_page(session.id, key=session.made_by)}"
    return page
