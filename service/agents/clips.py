"""The tool that renders a performance to a file."""

from __future__ import annotations

from ..bodies import Controls, EmotionCommand, KeyframeBody, NewClip
from ..components import Components
from ..errors import Refused, Unprocessable
from ..recording import record_last
from ..store import ClipRow
from .answered import ExportedClip
from .asked import Beat, ExportClip
from .caller import Caller
from .faces import LAYER

_ENDED = ("done", "failed", "cancelled")


async def export_clip(asked: ExportClip, parts: Components, caller: Caller) -> ExportedClip:
    """Render a timeline or what a face did last, or wait on for a clip."""
    ways = (asked.timeline, asked.session_id, asked.clip_id)
    if sum(way is not None for way in ways) != 1:
        raise Unprocessable(
            "invalid_body",
            "give one of 'timeline' (to perform it), 'session_id' (for what that face did last), "
            "or 'clip_id' (to wait on)",
        )
    clip = asked.clip_id or (await parts.clips.submit(await _clip(asked, parts, caller))).id
    row = await parts.clips.wait(clip, asked.wait)
    if row.status == "failed":
        raise Refused("clip_failed", row.message or "the clip could not be rendered")
    return _answer(row, parts, caller)


async def _clip(asked: ExportClip, parts: Components, caller: Caller) -> NewClip:
    if asked.session_id is not None:
        session = await parts.sessions.get(asked.session_id)
        # A model expects the seconds that it asked for, however short the face was awake.
        filled = min(asked.last, parts.settings.max_clip_seconds)
        return await record_last(
            parts.sessions, session, last=asked.last, fps=asked.fps, filled=filled
        )
    beats = sorted(asked.timeline or [], key=lambda beat: beat.time)
    return NewClip(
        rig=asked.rig,
        fps=asked.fps,
        timeline=[_keyframe(index, beat, caller.owner) for index, beat in enumerate(beats)],
        duration=asked.duration,
    )


def _keyframe(index: int, beat: Beat, owner: str) -> KeyframeBody:
    """Return the keyframe of a beat: the whole face, so that nothing of an earlier one stays.

    Raises:
        Unprocessable: If it does not say one face.
    """
    if (beat.emotion is None) == (beat.facs is None):
        message = f"timeline, entry {index}: give one of 'emotion' and 'facs'"
        raise Unprocessable("invalid_body", message)
    whole = Controls(layer=LAYER, owner=owner, fade=beat.fade, facs=beat.facs)
    emotion = None
    if beat.emotion is not None:
        emotion = EmotionCommand(
            label=beat.emotion, intensity=beat.intensity, fade_in=beat.fade, owner=owner
        )
    return KeyframeBody(
        **whole.model_dump(exclude_unset=True), time=beat.time, emotion=emotion, replace=True
    )


def _answer(row: ClipRow, parts: Components, caller: Caller) -> ExportedClip:
    line = parts.clips.describe(row)
    report = row.report or {}
    address = f"{caller.base_url}/api/clips/{row.id}"
    waiting = f"call export_clip with clip_id {row.id!r} to wait on"
    return ExportedClip(
        clip_id=row.id,
        status=row.status,  # type: ignore[arg-type]
        progress=line["progress"],  # type: ignore[arg-type]
        url=f"{address}.glb",
        csv_url=f"{address}.csv",
        duration=report.get("duration"),
        frames=report.get("frames"),
        bytes=report.get("bytes"),
        warnings=report.get("warnings", []),
        next_step=None if row.status in _ENDED else waiting,
    )
