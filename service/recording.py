"""What a live face did last, as a clip to render: its commands again, on a face of its own."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from engine import TICKS_PER_SECOND, Keyframe, Model, Rig, Writers

from .bodies import KeyframeBody, NewClip
from .errors import Conflict
from .sessions import Command, Session, Sessions

LEAD_SECONDS = 2.0
"""Played before what is kept, so that the face has come to where it was: longer than any lag."""
_MAPPINGS = ("action_units", "muscles", "jaw", "gaze", "head", "tongue")
_PLAIN = ("layer", "owner", "fade", "hold", "ttl", "fade_out", "weight", "replace", "expression")


async def record_last(sessions: Sessions, session: Session, *, last: float, fps: int) -> NewClip:
    """Return the last seconds of a session as a clip, as `recorded_clip` does, in a thread.

    Raises:
        Conflict: If nothing was ever set on the face.
    """
    view = await sessions.view(session)
    commands, rig, model = session.performed, session.rig, session.model
    return await asyncio.to_thread(
        recorded_clip, commands, rig, model, now=view.frame.tick, last=last, fps=fps
    )


def recorded_clip(
    commands: Sequence[Command], rig: Rig, model: Model, *, now: int, last: float, fps: int
) -> NewClip:
    """Return the last seconds of a session's timeline as a clip.

    A session's time stands still while its face sleeps, and so does the clip's. A face younger
    than `last` is recorded from its first tick on, bit for bit.

    Args:
        commands: The session's, oldest first.
        rig: Where it is now; earlier commands are played on it too.
        model: Its numerical model.
        now: Its tick.
        last: Seconds to record.
        fps: Frames a second.

    Raises:
        Conflict: If nothing was ever set on the face.
    """
    told = [(each.tick, each.command) for each in commands if isinstance(each.command, Keyframe)]
    if now <= 0 or not told:
        message = "nothing was ever set on that face, so there is nothing to record; set it first"
        raise Conflict("nothing_recorded", message)
    begin = max(0, now - round(last * TICKS_PER_SECOND))
    # Before its first tick a face is at rest, so the lead may begin there.
    origin = begin - round(LEAD_SECONDS * TICKS_PER_SECOND) if begin else 0
    held = Writers(rig)
    played = []
    for tick, keyframe in told:
        if tick < origin:
            for _ in held.expire(tick):
                pass
            held.take(keyframe, tick)
        elif tick < now:
            played.append(_body(keyframe, (tick - origin) / TICKS_PER_SECOND))
    before = [_body(keyframe, 0.0) for keyframe in held.keyframes(origin)]
    return NewClip.model_validate(
        {
            "rig": rig.id,
            "fps": fps,
            "timeline": [*before, *played],
            "start": (begin - origin) / TICKS_PER_SECOND,
            "duration": (now - origin) / TICKS_PER_SECOND,
            "model": asdict(model),
        }
    )


def _body(keyframe: Keyframe, time: float) -> KeyframeBody:
    """Return a command as a client would send it in a clip, without what it does not say."""
    said: dict[str, Any] = {"time": time}
    said |= {name: dict(getattr(keyframe, name)) for name in _MAPPINGS if getattr(keyframe, name)}
    said |= {name: getattr(keyframe, name) for name in _PLAIN}
    if keyframe.emotion is not None:
        label, intensity = keyframe.emotion
        said["emotion"] = {"label": label, "intensity": intensity, "seed": 0}
    return KeyframeBody.model_validate(said)
