"""What is asked of a clip, as the table of jobs keeps it, and what is played for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from engine import Rig, Timeline

from .bodies import ModelChoice, NewClip
from .commands import clip_timeline
from .errors import Unprocessable
from .idle import seed_of, with_life
from .store import ClipRow
from .track_file import TrackFile
from .tracks import TrackClip

Source = TypeVar("Source", Timeline, TrackFile)
_USUAL = ModelChoice()


@dataclass(frozen=True)
class Bounds:
    """Longest clip, in seconds and in keyframes."""

    seconds: float
    keyframes: int


@dataclass(frozen=True)
class Played(Generic[Source]):
    """What a clip plays: by which physics, from when on, by which seed, and what is said of it."""

    timeline: Source
    model: ModelChoice = _USUAL
    start: float = 0.0
    seed: int | None = None
    scales: Sequence[str] = ()
    warnings: Sequence[str] = ()


def played_by(clip: NewClip, rig: Rig, bounds: Bounds) -> Played[Timeline]:
    """Return what a clip of a timeline plays on `rig`.

    Raises:
        Unprocessable: If it cannot be played, or is too long.
    """
    if len(clip.timeline) > bounds.keyframes:
        message = f"timeline: {len(clip.timeline)} keyframes; at most {bounds.keyframes}"
        raise Unprocessable("too_many_keyframes", message)
    timeline, warnings = clip_timeline(clip, rig)
    if timeline.duration > bounds.seconds:
        message = f"the clip lasts {timeline.duration:g} s; at most {bounds.seconds:g} s"
        if clip.start:
            message += f", with the {clip.start:g} s that are played before it begins"
        raise Unprocessable("clip_too_long", message)
    scales = sorted({keyframe.scale for keyframe in clip.timeline})
    lively = with_life(timeline, clip, rig)
    return Played(lively, clip.model, clip.start, seed_of(clip), scales, warnings)


def request_of(row: ClipRow) -> NewClip | TrackClip:
    """Return what was asked for.

    Raises:
        ValidationError: If it was another version that was asked.
    """
    if "timeline" in row.request:
        return NewClip.model_validate(row.request)
    # How long it is was read of its file, and is kept for what its key may take.
    asked = {name: value for name, value in row.request.items() if name != "duration"}
    return TrackClip.model_validate(asked)
