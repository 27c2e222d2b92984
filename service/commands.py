"""From what clients say to keyframes that the engine plays."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

from engine import EngineError, Keyframe, Model, Rig, Timeline

from .bodies import (
    ClipForm,
    Controls,
    EmotionCommand,
    KeyframeBody,
    ModelChoice,
    NewClip,
)
from .clashes import clashes
from .emotions import Turns, play_emotion
from .errors import Refused, Unprocessable, refused_by_engine
from .facs import playable
from .shapes import shaped
from .speech import spoken

_OF_BOTH = ("layer", "owner", "weight", "hold", "ttl", "fade_out")
"""What a keyframe of a clip and the emotion in it may both say."""
_MOVES = (
    "facs",
    "action_units",
    "muscles",
    "jaw",
    "gaze",
    "head",
    "tongue",
    "arkit",
    "visemes",
    "emotion",
)
"""The fields of a keyframe that name something of a rig."""


def controls_keyframe(controls: Controls, rig: Rig, *, replace: bool) -> Keyframe:
    """Return the keyframe that `controls` ask for; with `replace`, the layer holds nothing else.

    Units of FACS that the rig does not have are left out; `clashes` names them.

    Raises:
        Unprocessable: For a FACS string that cannot be read, a unit that neither FACS nor the rig
            has, or a shape that its vocabulary does not have.
    """
    if {"fade", "fade_in"} <= controls.model_fields_set:
        raise Unprocessable("invalid_body", "give either 'fade' or 'fade_in': they are the same")
    shapes = shaped(controls, rig)
    return Keyframe(
        layer=controls.into,
        action_units={**shapes.units, **playable(controls, rig).units},
        muscles=dict(controls.muscles or {}),
        jaw={**shapes.axes.get("jaw", {}), **_given(controls.jaw)},
        gaze={**shapes.axes.get("gaze", {}), **_given(controls.gaze)},
        head=_given(controls.head),
        tongue={**shapes.axes.get("tongue", {}), **_given(controls.tongue)},
        owner=controls.owner,
        fade=controls.reached,
        hold=controls.hold,
        ttl=controls.ttl,
        fade_out=controls.fade_out,
        weight=controls.weight,
        replace=replace,
    )


def clip_timeline(clip: NewClip, rig: Rig) -> tuple[Timeline, list[str]]:
    """Return the timeline of a clip, checked against its rig, and what the check warns of.

    Raises:
        Unprocessable: With the first keyframe that cannot be played.
    """
    keyframes = []
    speeches = []
    warnings = []
    turns: Turns = Counter()
    for index, body in enumerate(clip.timeline):
        try:
            keyframe = _clip_keyframe(body, rig, turns)
            if body.speech is not None:
                speech = spoken(body.speech, rig)
                speeches.append((body.time, speech.keyframes))
                warnings += [f"keyframe {index}: {warning}" for warning in speech.warnings]
            found = rig.check(keyframe) + [str(clash) for clash in clashes(body, keyframe, rig)]
            warnings += [f"keyframe {index}: {warning}" for warning in found]
        except (EngineError, Refused) as error:
            refused = refused_by_engine(error) if isinstance(error, EngineError) else error
            place = _field_at_fault(body, rig)
            where = f"{place}: " if place and not refused.message.startswith(place) else ""
            refused.message = f"keyframe {index}: {where}{refused.message}"
            raise refused from error
        if body.speech is None or body.model_fields_set - {"time", "speech"}:
            keyframes.append(keyframe)
    try:
        timeline = Timeline.of([*keyframes, *_said(speeches)], clip.duration)
    except EngineError as error:
        raise refused_by_engine(error) from error
    if clip.start >= timeline.duration:
        raise Unprocessable(
            "invalid_body",
            f"start: the clip lasts {timeline.duration:g} s, so it must be below that; "
            f"{clip.start:g} was given",
        )
    return timeline, warnings


def model_of(choice: ModelChoice, rig: Rig) -> Model:
    """Return the rig's own model with what a client chose in place."""
    return Model.for_rig(rig, **choice.model_dump(exclude_unset=True))


def live_model(choice: ModelChoice, rig: Rig) -> Model:
    """Return the model of a session or a clip: without a choice, the one of live faces."""
    model = model_of(choice, rig)
    return model if "integrator" in choice.model_fields_set else model.live


def how_told(clip: ClipForm) -> dict[str, Any]:
    """Return how a clip's file is to tell its motion."""
    return clip.model_dump(include={"form", "tolerance", "quantize", "sparse"})


def held_to_json(held: Iterable[Keyframe]) -> list[Any]:
    """Return the commands that hold what a face's writers do as plain data."""
    return [{**keyframe.to_json(), "layer": keyframe.layer} for keyframe in held]


def held_from_json(data: Sequence[Mapping[str, Any]], rig: Rig) -> list[Keyframe]:
    """Read what `held_to_json` wrote, leaving out what this rig no longer plays."""
    known = {f.name for f in fields(Keyframe)}
    keyframes = []
    for entry in data:
        values = {name: value for name, value in entry.items() if name in known}
        if "emotion" in values:
            values["emotion"] = (values["emotion"]["label"], values["emotion"]["intensity"])
        keyframe = Keyframe(**values)
        try:
            rig.check(keyframe)
        except EngineError:
            continue
        keyframes.append(keyframe)
    return keyframes


def _given(part: Any) -> dict[str, float]:
    return {} if part is None else dict(part.model_dump(exclude_none=True))


def _clip_keyframe(body: KeyframeBody, rig: Rig, turns: Turns) -> Keyframe:
    keyframe = controls_keyframe(body, rig, replace=body.replace)
    keyframe = replace(keyframe, expression=body.expression)
    if body.emotion is not None:
        keyframe = _with_emotion(keyframe, body, rig, turns)
    return replace(keyframe, time=body.time)


def _field_at_fault(body: KeyframeBody, rig: Rig) -> str:
    """Return the field by which alone a keyframe cannot be played; none where it is no single one.

    A rig says what is wrong, and not where that was said: each field is tried by itself.
    """
    for name in _MOVES:
        if name in body.model_fields_set:
            given = {"time": body.time, "scale": body.scale, name: getattr(body, name)}
            try:
                rig.check(_clip_keyframe(KeyframeBody.model_validate(given), rig, Counter()))
            except (EngineError, Refused):
                return name
    try:
        if body.speech is not None:
            spoken(body.speech, rig)
    except Refused:
        return "speech"
    return ""


def _said(speeches: Iterable[tuple[float, Sequence[Keyframe]]]) -> list[Keyframe]:
    """Return the keyframes of speeches, each from its time on.

    A speech takes the place of what its owner has still to say, as it does live.
    """
    said: list[Keyframe] = []
    for time, keyframes in sorted(speeches, key=lambda speech: speech[0]):
        owners = {keyframe.owner for keyframe in keyframes}
        said = [each for each in said if each.time < time or each.owner not in owners]
        said += [replace(keyframe, time=time + keyframe.time) for keyframe in keyframes]
    return said


def _with_emotion(keyframe: Keyframe, body: KeyframeBody, rig: Rig, turns: Turns) -> Keyframe:
    """Return `keyframe` with the emotion of `body`; fields that `body` gives itself win."""
    command = body.emotion
    if isinstance(command, str):
        fade = body.reached if body.names_fade else None
        command = EmotionCommand(label=command, fade_in=fade)
    played = play_emotion(command or EmotionCommand(), rig, turns).keyframe
    given = body.model_fields_set
    return replace(
        keyframe,
        emotion=played.emotion,
        expression=played.expression,
        plays=played.plays,
        action_units={**played.action_units, **keyframe.action_units},
        fade=body.reached if body.names_fade else played.fade,
        **{name: getattr(played, name) for name in _OF_BOTH if name not in given},
    )
