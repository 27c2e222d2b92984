"""Speech: visemes in time, made keyframes that cross-fade in the layer of that name.

Each viseme begins before its time and fades in while the one before it fades out, so the mouth is
on its way from one to the next all the time. In quick speech vowels fall short of their targets,
as living mouths do (Öhman 1966; Cohen and Massaro 1993); lips that close do not, or p, b and m
would not be seen, and they come at their own time: a vowel between two of them gives way, so that
quick speech never falls behind its sound. How fast jaw and lips follow is the tissue's and the
rates' matter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from .blend import Shape, blend
from .errors import InvalidTrack
from .timeline import MAX_SECONDS, TICKS_PER_SECOND, Keyframe, ticks
from .visemes import find_viseme

SPEAKER = "speech"
"""The owner of speech that names none."""
MOST_CUES = 10_000
LEAD = 0.16
"""Seconds by which a viseme begins before it is heard. Lips and jaw are on their way 0.1 to 0.2 s
before a vowel (Bell-Berti and Harris 1982); on this face open lips meet 0.16 to 0.2 s after the
command."""
FADE = 0.12
"""Seconds that the command of a viseme takes to come: a syllable's half at four a second."""
CLOSING_FADE = 0.04
"""Seconds that the command takes to close lips. Ours."""
STAYS_CLOSED = 0.06
"""Seconds for which lips that close are asked to before a vowel begins, unless the next ones close
before that: the tissue lags behind its command. Ours, the least with which they meet at six to
sixteen visemes a second, and open between them up to eleven."""
LAST_SECONDS = 0.2
"""How long the last of the visemes with times lasts, s."""
LETS_GO = 0.2
"""Seconds over which the mouth goes back to what lies beneath speech."""
_TICK = 1.0 / TICKS_PER_SECOND


@dataclass(frozen=True)
class Cue:
    """One viseme of a speech.

    Attributes:
        time: When it is heard, seconds from the start.
        viseme: Its name.
        weight: How strongly it is spoken, 0..1.
    """

    time: float
    viseme: str
    weight: float = 1.0


def cues_of(entries: Sequence[Mapping[str, object]]) -> tuple[list[Cue], float]:
    """Read `[{"time": 0.0, "viseme": "PP"}, …]` or `[{"viseme": "PP", "duration": 0.1}, …]`.

    Args:
        entries: Each with `viseme`, an optional `weight`, and either `time` or `duration`, s.

    Returns:
        The cues in order, and when the last one ends, s.

    Raises:
        InvalidTrack: If they are none or too many, mix both forms, or go back in time.
    """
    if not 0 < len(entries) <= MOST_CUES:
        raise InvalidTrack(f"a speech has {len(entries)} visemes; expected 1 to {MOST_CUES}")
    timed = [entry.get("time") is not None for entry in entries]
    for index, entry in enumerate(entries):
        if timed[index] == (entry.get("duration") is not None) or timed[index] != timed[0]:
            raise InvalidTrack(
                f"viseme {index}: give 'time' with every viseme, or 'duration' with every one"
            )
    cues, now = [], 0.0
    for index, entry in enumerate(entries):
        start = _number(index, "time", entry["time"]) if timed[0] else now
        if start < now:
            raise InvalidTrack(f"viseme {index}: its time, {start:g} s, is before the last one's")
        weight = _number(index, "weight", entry.get("weight", 1.0))
        if weight > 1.0:
            raise InvalidTrack(f"viseme {index}: weight is {weight:g}; expected 0 to 1")
        cues.append(Cue(start, find_viseme(str(entry.get("viseme"))).name, weight))
        now = start if timed[0] else start + _number(index, "duration", entry["duration"])
    end = now + LAST_SECONDS if timed[0] else now
    if end > MAX_SECONDS:
        raise InvalidTrack(f"the speech lasts {end:g} s; at most {MAX_SECONDS:g} s are played")
    return cues, end


def speech_keyframes(
    cues: Sequence[Cue],
    end: float,
    *,
    delay: float = LEAD,
    owner: str = SPEAKER,
    intensity: float = 1.0,
    weight: float = 1.0,
    ttl: float | None = None,
    fade_out: float = LETS_GO,
) -> list[Keyframe]:
    """Return the keyframes of a speech, the last of which lets go of the mouth.

    Each says all that its owner holds in the layer, with a lease to the end of the speech: what
    stops half way lets go too.

    Args:
        cues: In order of time.
        end: When the last of them ends, s.
        delay: Seconds from time 0 of the keyframes until time 0 of the cues is heard. Below `LEAD`
            the first visemes have no time to come, and are run through.
        owner: Whose speech it is.
        intensity: Of the whole, times each cue's weight: 1 is clear, 0.5 mumbles.
        weight: How much of the layers beneath is overridden.
        ttl: Lease of the whole, s; what comes after is not played.
        fade_out: Seconds over which the mouth lets go.
    """
    shapes = [find_viseme(cue.viseme) for cue in cues]
    starts = _starts(cues, shapes, delay)
    played = [
        (start, shape, cue.weight) for start, shape, cue in zip(starts, shapes, cues, strict=True)
    ]
    end = max(end + delay, starts[-1] + 2.0 * _TICK)
    keyframes = [
        _mouth(start, shape, share * intensity, owner, weight, fade_out, end)
        for start, shape, share in played
    ]
    keyframes.append(Keyframe(time=end, layer="speech", owner=owner, fade=fade_out, replace=True))
    return keyframes if ttl is None else _leased(keyframes, ttl)


def _starts(cues: Sequence[Cue], shapes: Sequence[Shape], delay: float) -> list[float]:
    """Return when each viseme begins to come, s, on ticks: before its time, each after the last.

    Lips that close begin at their own time. What comes after them waits until they have met, but
    no longer than until those that close next begin.
    """
    own = [max(0, ticks(cue.time + delay - LEAD)) for cue in cues]
    starts: list[int] = []
    closed_until = 0
    for time, shape, latest in zip(own, shapes, _latest(own, shapes), strict=True):
        start = time if shape.closes else max(time, min(closed_until, latest))
        starts.append(max(start, starts[-1] + 1) if starts else start)
        if shape.closes:
            closed_until = starts[-1] + ticks(CLOSING_FADE + STAYS_CLOSED)
    return [start / TICKS_PER_SECOND for start in starts]


def _latest(own: Sequence[int], shapes: Sequence[Shape]) -> list[int]:
    """Return until when each viseme may wait, ticks: one for each before a closing one."""
    latest: list[int] = []
    free = ticks(MAX_SECONDS)
    for time, shape in zip(reversed(own), reversed(shapes), strict=True):
        free = time if shape.closes else free - 1
        latest.append(free)
    return latest[::-1]


def _mouth(
    start: float,
    shape: Shape,
    intensity: float,
    owner: str,
    weight: float,
    fade_out: float,
    end: float,
) -> Keyframe:
    """Return the keyframe of one viseme; its lease ends with the speech."""
    mouth = blend([(shape, intensity)])
    return Keyframe(
        time=start,
        layer="speech",
        owner=owner,
        action_units=mouth.units,
        jaw=mouth.axes.get("jaw", {}),
        tongue=mouth.axes.get("tongue", {}),
        fade=CLOSING_FADE if shape.closes else FADE,
        ttl=end - start + _TICK,
        fade_out=fade_out,
        weight=weight,
        replace=True,
    )


def _leased(keyframes: Sequence[Keyframe], ttl: float) -> list[Keyframe]:
    """Return what of a speech is played within a lease, s."""
    return [_until(keyframe, ttl - keyframe.time) for keyframe in keyframes if keyframe.time < ttl]


def _until(keyframe: Keyframe, left: float) -> Keyframe:
    return keyframe if keyframe.ttl is None else replace(keyframe, ttl=min(keyframe.ttl, left))


def _number(index: int, name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidTrack(f"viseme {index}: {name} is {value!r}; expected a number")
    if not 0.0 <= value <= MAX_SECONDS:
        raise InvalidTrack(f"viseme {index}: {name} is {value!r}; expected 0 to {MAX_SECONDS:g}")
    return float(value)
