"""What an agent may ask of each tool: few fields, each with a meaning and what it may be."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, WithJsonSchema

from engine import BUILTIN_RIGS, lexicon, people

from ..bodies import Body, Coordinate, Letter, Name, Scale, Score, Seconds, Share

Part = Literal["emotions", "action_units", "people"]


def _open_enum(known: tuple[str, ...], other: str) -> dict[str, Any]:
    """Return the schema of a text that is best one of `known`, and may be another one."""
    rest = {"type": "string", "minLength": 1, "maxLength": 64, "description": other}
    return {"anyOf": [{"type": "string", "enum": list(known)}, rest]}


Label = Annotated[
    Name,
    WithJsonSchema(
        _open_enum(
            tuple(lexicon().recipes),
            "any other emotion word, its inflection (joyful, angrily), or a face emoji",
        )
    ),
]
RigName = Annotated[
    Name,
    WithJsonSchema(_open_enum((*BUILTIN_RIGS, *people()), "id of a rig that was derived")),
]
Vocabulary = Annotated[
    Name, WithJsonSchema({"type": "string", "enum": list(lexicon().vocabularies)})
]
SessionId = Annotated[
    str,
    Field(
        pattern="^[a-z0-9_-]{1,64}$",
        description="session_id as open_face answered it.",
    ),
]
Facs = Annotated[
    str,
    Field(
        min_length=1,
        max_length=2048,
        description="FACS string: units joined by +, each an optional side (L, R), a number and an "
        "intensity A (trace) to E (full), such as 6C+12D, 1C+4B or R12D+46; 0 is the face at rest.",
        examples=["6C+12D", "1C+2C+5B+26B", "0"],
    ),
]


class ListExpressions(Body):
    """Arguments of `list_expressions`."""

    parts: list[Part] = Field(
        default=["emotions", "action_units", "people"],
        min_length=1,
        max_length=3,
        description="What to list.",
    )
    vocabulary: Vocabulary | None = Field(
        default=None,
        description="List the labels of this published set in place of the 62 built-in emotions.",
    )


class OpenFace(Body):
    """Arguments of `open_face`."""

    rig: RigName = Field(
        default="standard",
        description="Whose face: standard, one of the people, or paper, the literal model of the "
        "paper.",
    )
    alive: StrictBool = Field(
        default=False,
        description="Whether it blinks, glances and sways by itself while somebody watches; what "
        "is set comes first.",
    )


class SetEmotion(Body):
    """Arguments of `set_emotion`."""

    session_id: SessionId
    label: Label | None = Field(
        default=None, description="The emotion. Give this, or scores, or valence and arousal."
    )
    scores: Annotated[list[Score], Field(min_length=1, max_length=64)] | None = Field(
        default=None,
        description="A mixture, as a classifier gives it: what is missing to a sum of 1 is rest.",
        examples=[[{"label": "happiness", "score": 0.6}, {"label": "surprise", "score": 0.3}]],
    )
    valence: Coordinate | None = Field(
        default=None, description="Unpleasant -1 to pleasant 1; takes arousal too."
    )
    arousal: Coordinate | None = Field(default=None, description="Calm -1 to excited 1.")
    vocabulary: Vocabulary | None = Field(
        default=None, description="Which published set the labels are of, if one is meant."
    )
    intensity: Share = Field(
        default=1.0,
        description="0 nothing, 0.3 a hint, 0.6 clear, 1 the strongest that a face makes.",
    )
    hold: Seconds | None = Field(
        default=None,
        description="Seconds to stay before it fades by itself; without it, it stays until the "
        "next call.",
    )
    fade_in: Seconds | None = Field(
        default=None, description="Seconds until it is reached; without it, as quick as natural."
    )
    fade_out: Seconds = Field(default=0.6, description="Seconds over which it goes after hold.")


class SetActionUnits(Body):
    """Arguments of `set_action_units`."""

    session_id: SessionId
    facs: Facs | None = Field(default=None, description="Give this, or action_units, or both.")
    action_units: dict[Name, Share | Letter] | None = Field(
        default=None,
        max_length=128,
        description="The same by name: AU12 moves both sides, L12 or R12 one; 0 to 1, or A to E.",
        examples=[{"AU12": 0.8, "L4": "B"}],
    )
    scale: Scale = Field(
        default="linear",
        description="How letters are read: linear 0.2, 0.4, 0.6, 0.8, 1; banded 0.1, 0.2, 0.55, "
        "0.9, 1.",
    )
    keep: StrictBool = Field(
        default=False,
        description="false: this is the whole face that you want. true: add it to what you set "
        "before, for example a wink to a smile.",
    )
    hold: Seconds | None = Field(
        default=None,
        description="Seconds to stay before all that you set fades; without it, it stays.",
    )
    fade_in: Seconds | None = Field(
        default=None, description="Seconds until it is reached; without it, as quick as natural."
    )
    fade_out: Seconds = Field(default=0.6, description="Seconds over which it goes after hold.")


class GetState(Body):
    """Arguments of `get_state`."""

    session_id: SessionId


class Beat(Body):
    """One moment of a timeline: the whole face from then on."""

    time: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=3600)] = Field(
        description="Seconds from the start."
    )
    emotion: Label | None = Field(default=None, description="Give this, or facs.")
    intensity: Share = Field(default=1.0, description="Of the emotion.")
    facs: Facs | None = None
    fade: Seconds | None = Field(
        default=None, description="Seconds until it is reached; without it, as quick as natural."
    )


class ExportClip(Body):
    """Arguments of `export_clip`."""

    timeline: Annotated[list[Beat], Field(min_length=1, max_length=1000)] | None = Field(
        default=None,
        description="What to perform, on a fresh face. Give this, or session_id, or clip_id.",
        examples=[
            [
                {"time": 0.0, "emotion": "surprise"},
                {"time": 1.5, "emotion": "happiness", "intensity": 0.8},
                {"time": 4.0, "facs": "0"},
            ]
        ],
    )
    session_id: SessionId | None = Field(
        default=None, description="Render what this live face did last."
    )
    last: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=3600)] = Field(
        default=10.0,
        description="Seconds of the live face, from its last movements on; a face that stands "
        "still is shown so to their end.",
    )
    clip_id: SessionId | None = Field(
        default=None, description="Wait on for a clip that was not done; as answered before."
    )
    rig: RigName = Field(default="standard", description="Who performs the timeline.")
    duration: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=3600)] | None = (
        Field(default=None, description="Seconds; without it, until the last beat is reached.")
    )
    fps: Annotated[int, Field(strict=True, ge=1, le=60)] = Field(
        default=30, description="Frames a second."
    )
    wait: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=60)] = Field(
        default=30.0, description="Most seconds to wait for it."
    )
