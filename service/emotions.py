"""Emotions as clients ask for them, by label, scores or coordinates, made keyframes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from engine import (
    EngineError,
    Keyframe,
    Resolved,
    Rig,
    resolve_coordinates,
    resolve_label,
    resolve_scores,
)

from .bodies import EmotionCommand
from .errors import Unprocessable, refused_by_engine

Turns = Counter[str]
"""How often each recipe was played: by it a label that is played again looks different."""

_DECIMALS = 6
"""Of an intensity that is a product: more would be noise of the arithmetic."""


@dataclass(frozen=True)
class Played:
    """An emotion as it is played.

    Attributes:
        keyframe: The command.
        resolved: What it plays at intensity 1, and how that was found.
        action_units: What it plays, by name: as told, so held.
    """

    keyframe: Keyframe
    resolved: Resolved
    action_units: Mapping[str, float]

    def describe(self) -> dict[str, Any]:
        """Return what the API says of it."""
        resolved = self.resolved
        return {
            "recipe": resolved.facs,
            "action_units": dict(self.action_units),
            "source": resolved.source,
            "label": resolved.label or None,
            "vocabulary": resolved.vocabulary or None,
            "found": resolved.found,
            "parts": [
                {
                    "recipe": part.recipe,
                    "weight": round(part.weight, 4),
                    "variant": part.variant,
                    "facs": part.facs,
                    "source": part.source,
                }
                for part in resolved.parts
            ],
        }


def play_emotion(command: EmotionCommand, rig: Rig, turns: Turns) -> Played:
    """Return what a label, a scored list of labels or coordinates play.

    What is chosen stands in the keyframe as plain units, so that a replay needs no choice; the
    measured faces of the rig stand there under their name, for they are the rig's own.

    Args:
        command: As a client asks.
        rig: Whose face.
        turns: Of the face; a label without a seed takes its recipe's next turn, and is counted.

    Raises:
        Unprocessable: If not exactly one way of asking is used, or a label is not known.
    """
    _check(command)
    resolved = _resolved(command, rig, turns)
    if command.seed is None and command.label is not None:
        turns.update({part.recipe for part in resolved.parts})
    units = {
        key: round(value * command.intensity, _DECIMALS) for key, value in resolved.units.items()
    }
    keyframe = Keyframe(
        layer=command.layer,
        owner=command.owner,
        fade=command.fade_in,
        hold=command.hold,
        ttl=command.ttl,
        fade_out=command.fade_out,
        weight=command.weight,
        plays=_plays(resolved, command.intensity),
    )
    name = _measured(resolved, rig)
    if name is not None:
        keyframe = replace(keyframe, emotion=(name, command.intensity))
    else:
        keyframe = replace(keyframe, action_units=units, expression=True)
    return Played(keyframe, resolved, units)


def _plays(resolved: Resolved, intensity: float) -> dict[str, object]:
    """Return what a session tells of an emotion for as long as it is held."""
    return {
        "label": resolved.label or None,
        "intensity": intensity,
        "vocabulary": resolved.vocabulary or None,
        "found": resolved.found,
        "recipe": resolved.facs,
        "parts": [
            {"recipe": part.recipe, "weight": round(part.weight, 4), "variant": part.variant}
            for part in resolved.parts
        ],
    }


def _check(command: EmotionCommand) -> None:
    """Refuse a command that does not ask in exactly one way."""
    at_all = command.valence, command.arousal, command.dominance
    ways = (command.label, command.scores, None if at_all == (None,) * 3 else at_all)
    if sum(way is not None for way in ways) != 1:
        raise Unprocessable(
            "invalid_body", "give one of 'label', 'scores', or 'valence' with 'arousal'"
        )
    if ways[2] is not None and (command.valence is None or command.arousal is None):
        raise Unprocessable("invalid_body", "coordinates take both 'valence' and 'arousal'")
    if ways[2] is not None and command.vocabulary is not None:
        raise Unprocessable("invalid_body", "'vocabulary' goes with a label or scores")


def _resolved(command: EmotionCommand, rig: Rig, turns: Turns) -> Resolved:
    seed, own, vocabulary = command.seed or 0, rig.emotions, command.vocabulary
    try:
        if command.label is not None:
            return resolve_label(
                command.label,
                own=own,
                vocabulary=vocabulary,
                turn=lambda recipe: turns[recipe] if command.seed is None else seed,
            )
        if command.scores is not None:
            scores = [(score.label, score.score) for score in command.scores]
            return resolve_scores(scores, own=own, vocabulary=vocabulary, turn=lambda _: seed)
        return resolve_coordinates(
            command.valence or 0.0,
            command.arousal or 0.0,
            command.dominance,
            turn=lambda _: seed,
        )
    except EngineError as error:
        raise refused_by_engine(error) from error


def _measured(resolved: Resolved, rig: Rig) -> str | None:
    """Return the name of the rig's emotion that is played as it is, if it is one."""
    if len(resolved.parts) != 1 or resolved.parts[0].weight != 1.0:
        return None
    part = resolved.parts[0]
    emotion = rig.emotions.get(part.recipe)
    return part.recipe if emotion is not None and emotion.recipe == part.facs else None
