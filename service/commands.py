"""From what clients say to keyframes that the engine plays."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

from engine import (
    EngineError,
    Keyframe,
    Model,
    Rig,
    Timeline,
    hold_units,
    unit_key,
)

from .bodies import (
    Controls,
    EmotionCommand,
    KeyframeBody,
    ModelChoice,
    NewClip,
)
from .clashes import clashes
from .emotions import Turns, play_emotion
from .errors import Unprocessable, refused_by_engine
from .facs import playable


def controls_keyframe(controls: Controls, rig: Rig, *, replace: bool) -> Keyframe:
    """Return the keyframe that `controls` ask for; with `replace`, the layer holds nothing else.

    Units of FACS that the rig does not have are left out; `clashes` names them.

    Raises:
        Unprocessable: For a FACS string that cannot be read, a unit that neither FACS nor the rig
            has, or what is not available yet.
    """
    for name in ("arkit", "visemes"):
        if getattr(controls, name) is not None:
            raise Unprocessable(
                "not_available", f"{name} controls are not available yet; use action_units"
            )
    return Keyframe(
        layer=controls.layer,
        action_units=playable(controls, rig).units,
        muscles=dict(controls.muscles or {}),
        jaw=_given(controls.jaw),
        gaze=_given(controls.gaze),
        head=_given(controls.head),
        tongue=_given(controls.tongue),
        fade=controls.fade,
        hold=controls.ttl,
        weight=controls.weight,
        replace=replace,
    )


def clip_timeline(clip: NewClip, rig: Rig) -> tuple[Timeline, list[str]]:
    """Return the timeline of a clip, checked against its rig, and what the check warns of.

    Raises:
        Unprocessable: With the first keyframe that cannot be played.
    """
    keyframes = []
    warnings = []
    turns: Turns = Counter()
    for index, body in enumerate(clip.timeline):
        try:
            keyframe = _clip_keyframe(body, rig, turns)
            found = rig.check(keyframe) + [str(clash) for clash in clashes(body, keyframe, rig)]
            warnings += [f"keyframe {index}: {warning}" for warning in found]
        except EngineError as error:
            refused = refused_by_engine(error)
            refused.message = f"keyframe {index}: {refused.message}"
            raise refused from error
        keyframes.append(keyframe)
    try:
        return Timeline.of(keyframes, clip.duration), warnings
    except EngineError as error:
        raise refused_by_engine(error) from error


def model_of(choice: ModelChoice, rig: Rig) -> Model:
    """Return the rig's own model with what a client chose in place."""
    return Model.for_rig(rig, **choice.model_dump(exclude_unset=True))


def live_model(choice: ModelChoice, rig: Rig) -> Model:
    """Return the model of a session: of no integrator chosen, the one for many faces at once.

    It draws what the paper's does (`tests/engine/test_accuracy.py`); a rig with the paper's own
    forms of springs and forces keeps the paper's integrator too.
    """
    model = model_of(choice, rig)
    if "integrator" in choice.model_fields_set or not model.runs_together:
        return model
    return replace(model, integrator="verlet")


def hold(held: dict[str, Keyframe], keyframe: Keyframe, rig: Rig) -> None:
    """Take `keyframe` into `held`: for each layer one keyframe with all that it holds.

    A command that lets go by itself takes the whole layer with it, and so leaves nothing.
    """
    before = held.get(keyframe.layer)
    if keyframe.hold is not None:
        held.pop(keyframe.layer, None)
        return
    if before is None or keyframe.replace:
        before = Keyframe(layer=keyframe.layer)
    units = {} if keyframe.emotion is not None else before.action_units
    held[keyframe.layer] = replace(
        keyframe,
        action_units=_held_units(units, keyframe.action_units, rig),
        muscles={**before.muscles, **keyframe.muscles},
        jaw={**before.jaw, **keyframe.jaw},
        gaze={**before.gaze, **keyframe.gaze},
        head={**before.head, **keyframe.head},
        tongue={**before.tongue, **keyframe.tongue},
        emotion=keyframe.emotion or before.emotion,
        fade=0.0,
        replace=False,
    )


def _held_units(
    before: Mapping[str, float], named: Mapping[str, float], rig: Rig
) -> dict[str, float]:
    """Return the units a layer holds; a unit at 0 is kept, for it lets go of an emotion's."""
    units = dict(before)
    hold_units(rig, units, named)
    for key in (key for key, value in named.items() if value == 0.0):
        unit, side = rig.resolve_unit(key)
        sides = [unit_key(unit.name, each) for each in "LR"]
        split = not side and any(each in units for each in sides)
        for each in sides if split else [unit_key(unit.name, side)]:
            units.setdefault(each, 0.0)
    return units


def held_to_json(held: Mapping[str, Keyframe]) -> list[Any]:
    """Return what the layers hold as plain data."""
    return [{**keyframe.to_json(), "layer": layer} for layer, keyframe in held.items()]


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
    if body.emotion is not None:
        keyframe = _with_emotion(keyframe, body, rig, turns)
    return replace(keyframe, time=body.time)


def _with_emotion(keyframe: Keyframe, body: KeyframeBody, rig: Rig, turns: Turns) -> Keyframe:
    """Return `keyframe` with the emotion of `body`; fields that `body` gives itself win."""
    command = body.emotion
    if isinstance(command, str):
        fade = body.fade if "fade" in body.model_fields_set else None
        command = EmotionCommand(label=command, fade_in=fade, hold=body.ttl)
    played = play_emotion(command or EmotionCommand(), rig, turns).keyframe
    given = body.model_fields_set
    return replace(
        keyframe,
        layer=body.layer if "layer" in given else played.layer,
        emotion=played.emotion,
        action_units={**played.action_units, **keyframe.action_units},
        fade=body.fade if "fade" in given else played.fade,
        hold=body.ttl if "ttl" in given else played.hold,
        fade_out=played.fade_out,
        replace=keyframe.replace or played.replace,
    )
