"""Speech as clients ask for it, visemes in time, made keyframes for one rig."""

from __future__ import annotations

from dataclasses import dataclass

from engine import (
    EngineError,
    Keyframe,
    Rig,
    cues_of,
    speech_keyframes,
)

from .bodies import SpeechCommand
from .errors import refused_by_engine


@dataclass(frozen=True)
class Speech:
    """A speech as it is played.

    Attributes:
        keyframes: At their times, seconds from its start.
        seconds: How long it lasts from the command on, without the fade-out.
        warnings: What of it moves nothing on the rig.
    """

    keyframes: list[Keyframe]
    seconds: float
    warnings: list[str]


def spoken(command: SpeechCommand, rig: Rig) -> Speech:
    """Return what a speech plays on `rig`.

    Raises:
        Unprocessable: For a name that is no viseme, or times that cannot be played.
    """
    try:
        cues, end = cues_of([cue.model_dump(exclude_none=True) for cue in command.visemes])
        keyframes = speech_keyframes(
            cues,
            end,
            delay=command.delay,
            owner=command.owner,
            intensity=command.intensity,
            weight=command.weight,
            ttl=command.ttl,
            fade_out=command.fade_out,
        )
        warnings = [warning for keyframe in keyframes for warning in rig.check(keyframe)]
    except EngineError as error:
        raise refused_by_engine(error) from error
    seconds = command.delay + end
    if command.ttl is not None:
        seconds = min(seconds, command.ttl)
    return Speech(keyframes, seconds, list(dict.fromkeys(warnings)))


def silence(owner: str, fade: float) -> Keyframe:
    """Return the command with which an owner's speech lets go of the mouth, over `fade` s."""
    return Keyframe(layer="speech", owner=owner, fade=fade, replace=True)
