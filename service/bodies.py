"""What clients may say: the body of every call and every message of the socket, checked.

Unknown fields, NaN and infinity are refused; numbers and sizes are bounded.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    JsonValue,
    StrictBool,
    TypeAdapter,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError

from engine import (
    ANYONE,
    LEAD,
    LETS_GO,
    MAX_ACTIVATION,
    MOST_LIFE,
    OWNER,
    SPEAKER,
    muscle_edit_schema,
    tissue_edit_schema,
    usual_layer,
)

from .explaining import UNKNOWN_FIELD

Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e9, le=1e9)]
Share = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
Seconds = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=3600)]
Coordinate = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1, le=1)]
Degrees = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-180, le=180)]
Millimetres = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-100, le=100)]
Activation = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1, le=MAX_ACTIVATION)]
Name = Annotated[str, Field(min_length=1, max_length=64)]
Letter = Annotated[
    Literal["A", "B", "C", "D", "E"],
    BeforeValidator(lambda value: value.upper() if isinstance(value, str) else value),
]
LayerName = Literal["idle", "mood", "emotion", "speech", "puppet"]
Scale = Literal["linear", "banded"]


def _named(owner: str) -> str:
    """Refuse a text that names no owner."""
    if re.fullmatch(OWNER, owner) is None:
        raise ValueError("expected 1 to 64 letters, digits and '_', '.', ':', '@' or '-'")
    return owner


Owner = Annotated[
    str, AfterValidator(_named), WithJsonSchema({"type": "string", "pattern": f"^{OWNER}$"})
]

_DEPTH_LIMIT = 8
_ITEM_LIMIT = 20_000
_MOST_VISEMES = 10_000
_MOST = 2**32 - 1
"""Greatest number in a change: a seed may be any of 32 bits."""


def _bounded(value: JsonValue) -> JsonValue:
    """Refuse JSON that is deep, long, or holds a number that is not finite."""
    items = 0
    pending: list[tuple[JsonValue, int]] = [(value, 0)]
    while pending:
        item, depth = pending.pop()
        items += 1
        if depth > _DEPTH_LIMIT or items > _ITEM_LIMIT:
            raise ValueError(f"at most {_DEPTH_LIMIT} levels and {_ITEM_LIMIT} items")
        if isinstance(item, bool):
            continue
        # Compared, not converted: an integer of 400 digits has no float. NaN compares false.
        if isinstance(item, (int, float)) and not abs(item) <= _MOST:
            raise ValueError("numbers are finite and below 2^32")
        if isinstance(item, dict):
            pending += [(child, depth + 1) for child in item.values()]
        elif isinstance(item, list):
            pending += [(child, depth + 1) for child in item]
    return value


Changes = Annotated[
    dict[Name, JsonValue], Field(max_length=256), AfterValidator(lambda value: _bounded(value))
]
TissueChanges = Annotated[Changes, WithJsonSchema(tissue_edit_schema())]
MuscleChanges = Annotated[Changes, WithJsonSchema(muscle_edit_schema())]
MusclesChanges = Annotated[
    Changes, WithJsonSchema({"type": "object", "additionalProperties": muscle_edit_schema()})
]
"""Changes of muscles by their full names."""


class Body(BaseModel):
    """Base of every body."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _has_no_other_fields(cls, given: object) -> object:
        """Refuse a field that there is not, naming those that there are."""
        known = cls.model_fields
        for name in given if isinstance(given, Mapping) else ():
            if name not in known:
                # Half a surrogate is no text that an answer could hold.
                shown = str(name).encode(errors="replace").decode()
                context = {"given": shown, "known": list(known)}
                raise PydanticCustomError(UNKNOWN_FIELD, "there is no such field", context)
        return given


class Jaw(Body):
    """Where the jaw goes: degrees of opening and turn, mm of forward thrust."""

    pitch: Degrees | None = None
    yaw: Degrees | None = None
    thrust: Millimetres | None = None


class Gaze(Body):
    """Where the eyes look, degrees: yaw to the face's left, pitch up; vergence crosses them."""

    yaw: Degrees | None = None
    pitch: Degrees | None = None
    vergence: Degrees | None = None


class HeadPose(Body):
    """How the head is held: degrees, and mm of forward thrust."""

    yaw: Degrees | None = None
    pitch: Degrees | None = None
    roll: Degrees | None = None
    thrust: Millimetres | None = None


class Tongue(Body):
    """Where the tongue goes: mm out of the mouth."""

    thrust: Millimetres | None = None


class Units(Body):
    """Action units, by name and as a FACS string; where both name one, the name counts."""

    action_units: dict[Name, Share | Letter] | None = Field(
        default=None, max_length=128, examples=[{"AU12": 0.8, "L4": "B"}]
    )
    facs: str | None = Field(default=None, max_length=2048, examples=["1C+2C+L12D+26"])
    scale: Scale = Field(
        default="linear",
        description="How letters are read: in even steps (A 0.2 to E 1), or by FACS' uneven bands "
        "(0.1, 0.2, 0.55, 0.9, 1).",
    )


class FacsRequest(Units):
    """FACS to read for a rig, or units to write as FACS."""

    rig: Name = "standard"


class Write(Body):
    """What every command says of itself: where it goes, how strongly, for how long, and whose."""

    owner: Owner = Field(
        default=ANYONE,
        examples=["dialogue-agent"],
        description="Whose command it is: any name. In a layer each owner holds a set of its own; "
        "the last to come counts, and what it held over returns when it lets go.",
    )
    weight: Share = Field(
        default=1.0, description="How much of what lies beneath is overridden, 0 to 1."
    )
    hold: Seconds | None = Field(
        default=None,
        description="Seconds that it stays once reached; then all that its owner holds in the "
        "layer lets go. Without it and without ttl it stays.",
    )
    ttl: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=3600)] | None = Field(
        default=None,
        description="Lease: seconds from now after which all that its owner holds in the layer "
        "lets go, unless the owner writes again.",
    )
    fade_out: Seconds = Field(
        default=0.4, description="Seconds over which it lets go after hold or ttl."
    )


class Controls(Units, Write):
    """Commands to one layer of a face; what is not named stays as it is."""

    muscles: dict[Name, Activation] | None = Field(
        default=None, max_length=256, description="Below 0 only for air and lids."
    )
    jaw: Jaw | None = None
    gaze: Gaze | None = None
    head: HeadPose | None = None
    tongue: Tongue | None = None
    arkit: dict[Name, Number] | None = Field(
        default=None,
        max_length=128,
        examples=[{"jawOpen": 0.4, "mouthSmileLeft": 0.7}],
        description="ARKit's blend shapes, 0 to 1; GET /api/maps/arkit says what each plays.",
    )
    visemes: dict[Name, Number] | None = Field(
        default=None,
        max_length=64,
        examples=[{"aa": 0.7}],
        description="Oculus' visemes, 0 to 1: the whole mouth, of which what they do not name is "
        "let go. A command of visemes alone goes to the layer speech.",
    )
    fade: Seconds | None = Field(
        default=0.0,
        description="Seconds until the commands are reached; null gives each unit its own.",
    )
    fade_in: Seconds | None = Field(default=0.0, description="Another name of fade.")
    layer: LayerName = Field(
        default="puppet",
        description="idle < mood < emotion < speech < puppet: a higher one overrides a lower, "
        "muscle by muscle, where it asks for anything.",
    )

    @property
    def into(self) -> str:
        """The layer that it goes to: the one it names, or the usual one of what it moves."""
        named = self.model_fields_set
        return self.layer if "layer" in named or "emotion" in named else usual_layer(named)

    @property
    def reached(self) -> float | None:
        """Seconds until the commands are reached, by either name; None is each unit's own time."""
        return self.fade_in if "fade_in" in self.model_fields_set else self.fade

    @property
    def names_fade(self) -> bool:
        """Whether the client said how long it takes."""
        return bool({"fade", "fade_in"} & self.model_fields_set)


class Score(Body):
    """One label of a scored distribution."""

    label: Name
    score: Share


class EmotionCommand(Write):
    """An emotion to play: one label, scores of several, or coordinates."""

    label: Name | None = Field(
        default=None, description="A label of any vocabulary, another form of it, or an emoji."
    )
    vocabulary: Name | None = Field(
        default=None,
        description="Whose labels are meant, such as goemotions; GET /api/emotions lists them.",
    )
    intensity: Share = 1.0
    scores: Annotated[list[Score], Field(min_length=1, max_length=64)] | None = Field(
        default=None,
        description="A classifier's list; what is missing to 1, and neutral, is rest.",
    )
    valence: Coordinate | None = Field(default=None, description="Pleasure; takes arousal too.")
    arousal: Coordinate | None = None
    dominance: Coordinate | None = Field(
        default=None, description="Or potency; what goes with the other two if left out."
    )
    seed: Annotated[int, Field(strict=True, ge=0, le=_MOST)] | None = Field(
        default=None,
        description="Chooses among a recipe's variants, 0 the first; without it, a label that is "
        "played again takes the next one, and scores and coordinates the first.",
    )
    fade_in: Seconds | None = Field(
        default=None,
        description="Seconds until it is reached; without it each unit takes its own.",
    )
    layer: LayerName = "emotion"


class TimedViseme(Body):
    """One viseme of a speech: when it is heard, or how long."""

    viseme: Name = Field(examples=["PP"])
    time: Seconds | None = Field(default=None, description="Seconds from the start.")
    duration: Seconds | None = Field(default=None, description="Seconds, one after another.")
    weight: Share = Field(default=1.0, description="How strongly it is spoken.")


class SpeechCommand(Body):
    """Visemes in time, played in the layer speech from now on."""

    visemes: Annotated[list[TimedViseme], Field(min_length=1, max_length=_MOST_VISEMES)] = Field(
        examples=[[{"viseme": "PP", "time": 0.1}, {"viseme": "aa", "time": 0.2}]],
        description="All with time, rising, or all with duration.",
    )
    owner: Owner = Field(
        default=SPEAKER,
        description="Whose speech it is; a new one of the same owner takes the place of the last.",
    )
    delay: Seconds = Field(
        default=LEAD,
        description="Seconds from now until time 0 is heard; a mouth needs as much to get ready.",
    )
    intensity: Share = Field(default=1.0, description="1 speaks clearly, 0.5 mumbles.")
    weight: Share = Field(
        default=1.0, description="How much of what lies beneath is overridden, 0 to 1."
    )
    ttl: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=3600)] | None = Field(
        default=None, description="Lease: seconds from now after which the mouth lets go."
    )
    fade_out: Seconds = Field(default=LETS_GO, description="Seconds over which it lets go.")


class ModelChoice(Body):
    """The numerical model of a session or clip; the defaults are the rig's own."""

    integrator: Literal["rk2", "heun", "symplectic_euler", "rk4", "verlet"] = Field(
        default="rk2",
        description='A session or a clip that names none runs "verlet", on the kernel for many '
        'faces; the paper\'s is "rk2".',
    )
    forces: Literal["rest", "current"] = "rest"
    springs: Literal["continuous", "literal"] = "continuous"
    sphincter: Literal["ring", "literal"] = "ring"


Amount = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=MOST_LIFE)]


class IdleLife(Body):
    """What a face does while nobody asks anything of it: parts times the usual, none below 0.01."""

    seed: Annotated[int, Field(strict=True, ge=0, le=_MOST)] | None = Field(
        default=None,
        description="Chooses when and where; without it a session takes one and tells it, and a "
        "clip takes 0.",
    )
    blinks: Amount = Field(default=1.0, description="How many blinks.")
    gaze: Amount = Field(default=1.0, description="How far the eyes go.")
    head: Amount = Field(default=1.0, description="How far the head sways and goes with glances.")
    micro: Amount = Field(default=0.3, description="How many brief faint expressions.")


def _switched(value: object) -> object:
    """Read true as a life of which nothing is said, and false as none."""
    if isinstance(value, bool):
        return {} if value else None
    return value


Life = Annotated[
    IdleLife | None,
    BeforeValidator(_switched, json_schema_input_type=bool | IdleLife | None),
    Field(description="Idle life: true, or how much of it; none by default."),
]


class NewSession(Body):
    """A session to open."""

    rig: Name = "standard"
    model: ModelChoice = ModelChoice()
    idle: Life = None


class Palsy(Body):
    """A one-sided weakness of the facial nerve's muscles."""

    side: Literal["left", "right", "both"]
    grade: Literal["I", "II", "III", "IV", "V", "VI"] | None = Field(
        default=None, description="House and Brackmann's: I is normal, VI total paralysis."
    )
    gain: Share | None = Field(
        default=None, description="Share of the force that is left, in place of a grade."
    )


class Relaxed(Body):
    """Share of its force that each half of a muscle has lost."""

    left: Share = 0.0
    right: Share = 0.0


class NewRig(Body):
    """A rig to derive from another one."""

    base: Name = "standard"
    name: Name | None = None
    recipe: Changes | None = Field(
        default=None, examples=[{"age": 60, "skin": "dark"}], description="What the person is like."
    )
    tissue: TissueChanges | None = Field(
        default=None,
        examples=[{"region_laxity": {"cheek": 0.5}, "tissue_depth": {"C5_2": 14.0}}],
        description="Tissue constants, factors by region, and thickness maps by point or node.",
    )
    tissue_age: Literal["young", "middle", "old"] | Number | None = Field(
        default=None, description="Age of skin and muscles alone: a preset, or years."
    )
    palsy: Palsy | None = None
    relaxed: dict[Name, Share | Relaxed] | None = Field(
        default=None,
        max_length=256,
        examples=[{"corrugator_supercilii": 0.8, "frontalis_medial.L": 1.0}],
        description="Share of its force that each muscle has lost, as by botulinum toxin.",
    )
    muscles: MusclesChanges | None = None
    action_units: Changes | None = None
    emotions: Changes | None = None
    passing: StrictBool = Field(
        default=False,
        description="Whether it is one step of an edit: it may go once no session is on it.",
    )


class KeyframeBody(Controls):
    """One keyframe of a clip: the time at which it starts, and the controls it moves."""

    time: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=3600)]
    replace: StrictBool = False
    expression: StrictBool = Field(
        default=False,
        description="Whether its units are a whole expression, as an emotion's are: they replace "
        "those of their owner in the layer, and cover those of others.",
    )
    emotion: Name | EmotionCommand | None = None
    speech: SpeechCommand | None = Field(
        default=None, description="Visemes in time, spoken from this keyframe on."
    )


class ClipForm(Body):
    """Who performs in a clip, and what its file is like, whatever is played."""

    rig: Name = "standard"
    fps: Annotated[int, Field(ge=1, le=60, description="Frames a second.")] = 30
    level: Literal["low", "medium", "high"] = Field(
        default="medium", description="Detail of the drawn skin and hair."
    )
    form: Literal["basis", "arkit", "exact"] = Field(
        default="basis",
        description="How the file tells the motion: few morph targets made of it, ARKit's 52 by "
        "name with weights fitted to it, or a morph target a frame.",
    )
    tolerance: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.01, le=10)] = Field(
        default=0.1, description="Largest error of any vertex with the form basis, mm."
    )
    quantize: StrictBool = Field(
        default=True, description="Whether numbers are stored by KHR_mesh_quantization."
    )
    sparse: StrictBool = Field(
        default=True, description="Whether accessors may be sparse, where that is smaller."
    )
    textures: StrictBool = Field(
        default=True, description="Whether the maps of skin and eyes are embedded."
    )


class NewClip(ClipForm):
    """A clip to render."""

    timeline: list[KeyframeBody]
    duration: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=3600)] | None = None
    start: Seconds = Field(
        default=0.0,
        description="Seconds of the timeline that are played and left out of the file.",
    )
    model: ModelChoice = ModelChoice()
    idle: Life = None

    @model_validator(mode="after")
    def _speaks_in_bounds(self) -> NewClip:
        """Refuse more visemes than one speech may have."""
        visemes = sum(len(each.speech.visemes) for each in self.timeline if each.speech)
        if visemes > _MOST_VISEMES:
            raise ValueError(f"{visemes} visemes in its speeches; at most {_MOST_VISEMES}")
        return self


class ControlsMessage(Controls):
    """Controls over the socket: as PATCH, or as PUT with `replace`."""

    type: Literal["controls"]
    replace: StrictBool = False


class EmotionMessage(EmotionCommand):
    """An emotion over the socket."""

    type: Literal["emotion"]


class IdleMessage(IdleLife):
    """Idle life over the socket: as PUT, or as DELETE where it is not on."""

    type: Literal["idle"]
    on: StrictBool = True


class AckMessage(Body):
    """The viewer has drawn the frame of this tick."""

    type: Literal["ack"]
    tick: Annotated[int, Field(ge=0, le=2**32 - 1)]


Said = ControlsMessage | EmotionMessage | IdleMessage | AckMessage
Message = Annotated[Said, Field(discriminator="type")]
MESSAGE: TypeAdapter[Said] = TypeAdapter(Message)
