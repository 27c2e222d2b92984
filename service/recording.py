"""What a live face did last, as a clip to render: its commands again, on a face of its own."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from engine import TICKS_PER_SECOND, Keyframe, Model, Rig, Writers

from .bodies import KeyframeBody, NewClip
from .errors import Conflict
from .sessions import Session, Sessions
from .tail import Command, Resumed, Tail, follow

LEAD_SECONDS = 2.0
"""Played before what is kept, so that the face has come to where it was: longer than any lag."""
_MAPPINGS = ("action_units", "muscles", "jaw", "gaze", "head", "tongue")
_PLAIN = ("layer", "owner", "fade", "hold", "ttl", "fade_out", "weight", "replace", "expression")


async def record_last(
    sessions: Sessions, session: Session, *, last: float, fps: int, filled: float = 0.0
) -> NewClip:
    """Return the last seconds of a session as a clip, as `recorded_clip` does, in a thread.

    Args:
        sessions: All of them.
        session: Whose face.
        last: Seconds to record.
        fps: Frames a second.
        filled: Seconds that the clip has at least where the face sleeps: it goes on with the face
            as it stands, at most until a lease ends.

    Raises:
        Conflict: If nothing was ever set on the face.
    """
    view = await sessions.view(session)
    now = view.frame.tick
    ends = session.held.alarm() if view.frame.asleep else now
    tail, rig, model = session.tail.copy(), session.rig, session.model
    return await asyncio.to_thread(
        recorded_clip, tail, rig, model, now=now, last=last, fps=fps, filled=filled, ends=ends
    )


def recorded_clip(
    tail: Tail,
    rig: Rig,
    model: Model,
    *,
    now: int,
    last: float,
    fps: int,
    filled: float = 0.0,
    ends: int | None = None,
) -> NewClip:
    """Return the last seconds of a session's timeline as a clip.

    A session's time stands still while its face sleeps, and so does the clip's. A face younger
    than `last` is recorded from its first tick on, bit for bit. What a service told it that was
    stopped since is there too; the start of the next one is no gap, but what did not outlive it
    lets go there.

    Args:
        tail: The session's; what was held before it is played on.
        rig: Where it is now; earlier commands are played on it too.
        model: Its numerical model.
        now: Its tick.
        last: Seconds to record.
        fps: Frames a second.
        filled: Seconds that the clip has at least: it goes on with the face as it stands now.
        ends: Tick after which it stands so no more; None where nothing is to come.

    Raises:
        Conflict: If nothing was ever set on the face.
    """
    if now <= tail.begins or not tail.told:
        message = "nothing was ever set on that face, so there is nothing to record; set it first"
        raise Conflict("nothing_recorded", message)
    begin = max(tail.begins, now - round(last * TICKS_PER_SECOND))
    young = tail.whole and begin == tail.begins
    end = begin + round(filled * TICKS_PER_SECOND)
    end = max(now, end if ends is None else min(end, ends))
    # Before its first tick a face is at rest, so the lead may begin there.
    origin = begin if young else begin - round(LEAD_SECONDS * TICKS_PER_SECOND)
    held, early = tail.before, [each for each in tail.commands if each.tick < origin]
    for each in early:
        follow(held, each)
    for _ in held.expire(origin):
        pass
    before = [_body(keyframe, 0.0) for keyframe in held.keyframes(origin)]
    late = [each for each in tail.commands if origin <= each.tick < now]
    played = [
        _body(keyframe, (tick - origin) / TICKS_PER_SECOND)
        for tick, keyframe in _played(held, late)
    ]
    return NewClip.model_validate(
        {
            "rig": rig.id,
            "fps": fps,
            "timeline": [*before, *played],
            "start": (begin - origin) / TICKS_PER_SECOND,
            "duration": (end - origin) / TICKS_PER_SECOND,
            "model": asdict(model),
        }
    )


def _played(held: Writers, commands: Sequence[Command]) -> Iterator[tuple[int, Keyframe]]:
    """Yield what is played at which tick: where a face began anew, who holds nothing lets go.

    Args:
        held: By whom what is held before the first of them.
        commands: In order.
    """
    anew = any(isinstance(each.command, Resumed) for each in commands)
    for each in commands:
        if isinstance(each.command, Resumed):
            for over in held.keyframes(each.tick):
                yield (
                    each.tick,
                    Keyframe(layer=over.layer, owner=over.owner, fade=over.fade_out, replace=True),
                )
            yield from ((each.tick, keyframe) for keyframe in each.command.held)
        elif isinstance(each.command, Keyframe):
            yield each.tick, each.command
        if anew:
            follow(held, each)


def _body(keyframe: Keyframe, time: float) -> KeyframeBody:
    """Return a command as a client would send it in a clip, without what it does not say."""
    said: dict[str, Any] = {"time": time}
    said |= {name: dict(getattr(keyframe, name)) for name in _MAPPINGS if getattr(keyframe, name)}
    said |= {name: getattr(keyframe, name) for name in _PLAIN}
    if keyframe.emotion is not None:
        label, intensity = keyframe.emotion
        said["emotion"] = {"label": label, "intensity": intensity, "seed": 0}
    return KeyframeBody.model_validate(said)
