"""Commands in time: keyframes in layers, and the timelines they make."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any

from .arkit import arkit_blend
from .blend import Blend
from .errors import EngineError, InvalidNotation, InvalidTrack, InvalidValue, UnknownName
from .facs import LETTERS, parse_facs, scale_named
from .visemes import viseme_blend

LAYERS = ("idle", "mood", "emotion", "speech", "puppet")
"""Layers from the lowest to the highest; a higher one overrides a lower, muscle by muscle."""
ANYONE = "anyone"
"""The owner of a command that names none."""
OWNER = r"[A-Za-z0-9_.:@-]{1,64}"
"""What an owner may be called, a regular expression."""
TICKS_PER_SECOND = 60
MAX_SECONDS = 3600.0
LONGEST_ONSET = 1.0
"""No action unit takes longer than this from rest to full, or back, in its own time, s."""
SECONDS_AFTER_LAST = 1.0
"""How long a timeline without a duration goes on after its last keyframe has played."""

_NOTHING: Mapping[str, float] = MappingProxyType({})


@dataclass(frozen=True)
class Keyframe:
    """One command to a face. It moves only what it names, unless `replace` is set.

    Attributes:
        time: Seconds from the start of a timeline; ignored by a live face.
        layer: One of `LAYERS`.
        owner: Whose command it is: in a layer each owner holds a set of its own.
        action_units: Intensity 0..1 by "AU12" (both sides), "L12" or "R12"; 0 lets go.
        muscles: Raw activation 0..1 by muscle name; 0 lets go.
        jaw: "pitch" and "yaw", degrees, "thrust", mm; as in gaze and head, 0 lets go.
        gaze: "yaw" and "pitch", degrees: left and up are positive; "vergence" crosses the eyes.
        head: "yaw", "pitch" and "roll", degrees: left, up, to the left shoulder; "thrust", mm.
        tongue: "thrust", mm out of the mouth.
        emotion: Label and intensity: an expression by name.
        expression: True if its units are a whole expression, as an emotion's are: they replace
            those that the owner held in the layer, and cover those that others hold there.
        plays: What an expression is called and made of, as plain data: it is told back with what
            is held, and moves nothing.
        fade: Seconds over which the face moves there; None gives each action unit its own onset or
            offset, and everything else none.
        hold: Seconds to stay, once reached, before all that the owner holds there lets go; None
            stays. Each command of an owner says it anew.
        ttl: Seconds from now after which it lets go at the latest; each command says it anew.
        fade_out: Seconds over which it lets go after `hold` or `ttl`.
        weight: How much of the lower layers is overridden, 0..1.
        replace: True to let go of everything else that the owner holds in the layer; without an
            owner, of everything that anybody does.
    """

    time: float = 0.0
    layer: str = "puppet"
    owner: str = ANYONE
    action_units: Mapping[str, float] = field(default_factory=dict)
    muscles: Mapping[str, float] = field(default_factory=dict)
    jaw: Mapping[str, float] = field(default_factory=dict)
    gaze: Mapping[str, float] = field(default_factory=dict)
    head: Mapping[str, float] = field(default_factory=dict)
    tongue: Mapping[str, float] = field(default_factory=dict)
    emotion: tuple[str, float] | None = None
    fade: float | None = 0.0
    hold: float | None = None
    ttl: float | None = None
    fade_out: float = 0.4
    weight: float = 1.0
    replace: bool = False
    expression: bool = False
    plays: Mapping[str, object] = field(default_factory=dict)

    def to_json(self) -> dict[str, object]:
        """Return the keyframe as plain data, without what it does not say."""
        data: dict[str, object] = {
            name: value
            for name, value in vars(self).items()
            if name == "time" or value != _UNSAID[name]
        }
        if self.emotion is not None:
            data["emotion"] = {"label": self.emotion[0], "intensity": self.emotion[1]}
        return data


_UNSAID = vars(Keyframe())
"""What a keyframe says that says nothing."""


@dataclass(frozen=True)
class Timeline:
    """Keyframes in order of time, and how long the whole lasts, seconds."""

    keyframes: tuple[Keyframe, ...]
    duration: float

    def __post_init__(self) -> None:
        times = [keyframe.time for keyframe in self.keyframes]
        for index, time in enumerate(times):
            if not (math.isfinite(time) and time >= 0.0):
                raise InvalidTrack(f"keyframe {index}: time is {time!r}; it must be 0 or more")
        if not (math.isfinite(self.duration) and 0.0 < self.duration <= MAX_SECONDS):
            raise InvalidTrack(
                f"the duration is {self.duration!r} s; it must lie between 0 and {MAX_SECONDS:g}"
            )
        if times != sorted(times):
            object.__setattr__(
                self, "keyframes", tuple(sorted(self.keyframes, key=lambda k: k.time))
            )

    @classmethod
    def from_json(cls, data: Mapping[str, object]) -> Timeline:
        """Read `{"timeline": [{"time": 0.0, …}, …], "duration": 10}`.

        Without a duration it ends as `of` says.

        Raises:
            InvalidTrack: With the keyframe and field that cannot be read.
        """
        entries = data.get("timeline")
        if not isinstance(entries, list) or not entries:
            raise InvalidTrack("a timeline needs 'timeline': a list of one or more keyframes")
        keyframes = tuple(_keyframe(index, entry) for index, entry in enumerate(entries))
        duration = data.get("duration")
        return cls.of(keyframes, None if duration is None else _finite("'duration'", duration))

    @classmethod
    def of(cls, keyframes: Sequence[Keyframe], duration: float | None = None) -> Timeline:
        """Return a timeline of `duration` seconds, or one that ends when all has been seen.

        Without a duration that is a second after the last keyframe has played, its hold and its
        fade-out included.

        Raises:
            InvalidTrack: For a time or a duration outside its range.
        """
        if duration is None:
            duration = max(map(_end, keyframes), default=0.0) + SECONDS_AFTER_LAST
        return cls(tuple(keyframes), duration)

    def to_json(self) -> dict[str, object]:
        """Return the timeline as `from_json` reads it."""
        return {
            # With its layer, for one that is left out depends on what else is said.
            "timeline": [{**each.to_json(), "layer": each.layer} for each in self.keyframes],
            "duration": self.duration,
        }


def check_owner(owner: object) -> str:
    """Return what names an owner.

    Raises:
        InvalidValue: If it is no such text.
    """
    if not isinstance(owner, str) or re.fullmatch(OWNER, owner) is None:
        raise InvalidValue(
            f"owner is {owner!r}; expected 1 to 64 letters, digits and '_', '.', ':', '@' or '-'"
        )
    return owner


def usual_layer(named: Collection[str]) -> str:
    """Return the layer of a command that names none, by the fields that it has."""
    if "emotion" in named:
        return "emotion"
    moves = {*_MAPPINGS, "facs", *_SHAPES}.intersection(named)
    return "speech" if moves == {"visemes"} else "puppet"


def ticks(seconds: float) -> int:
    """Return the nearest whole number of ticks in `seconds`."""
    return round(seconds * TICKS_PER_SECOND)


_MAPPINGS = ("action_units", "muscles", "jaw", "gaze", "head", "tongue")
_NUMBERS = ("time", "fade_out", "weight")
_SHAPES = {"arkit": arkit_blend, "visemes": viseme_blend}
_KNOWN = {f.name for f in fields(Keyframe)} | {"facs", "scale", "fade_in", *_SHAPES}


def _keyframe(index: int, entry: object) -> Keyframe:
    if not isinstance(entry, Mapping):
        raise InvalidTrack(f"keyframe {index}: is {entry!r}; expected an object")
    unknown = sorted(set(entry) - _KNOWN)
    if unknown:
        raise InvalidTrack(
            f"keyframe {index}: field {unknown[0]!r} is not known; known are {sorted(_KNOWN)}"
        )
    values: dict[str, Any] = {}
    scale = _scale(index, entry.get("scale", "linear"))
    for name in _MAPPINGS:
        letters = scale_named(scale) if name == "action_units" else LETTERS
        values[name] = _numbers(index, name, entry.get(name, _NOTHING), letters)
    if "facs" in entry:
        values["action_units"] = {**_facs(index, entry["facs"], scale), **values["action_units"]}
    for name in _SHAPES:
        if name in entry:
            _add_shapes(values, _blend(index, name, entry[name]))
    for name in _NUMBERS:
        if name in entry:
            values[name] = _number(index, name, entry[name])
    for name in ("fade_in", "fade"):
        if name in entry:
            values["fade"] = None if entry[name] is None else _number(index, name, entry[name])
    for name in ("hold", "ttl"):
        if entry.get(name) is not None:
            values[name] = _number(index, name, entry[name])
    layer = entry.get("layer", usual_layer(entry))
    if layer not in LAYERS:
        raise InvalidTrack(f"keyframe {index}: layer is {layer!r}; expected one of {LAYERS}")
    values["layer"] = layer
    values["owner"] = _owner(index, entry.get("owner", ANYONE))
    values["replace"] = bool(entry.get("replace", False))
    values["expression"] = bool(entry.get("expression", False))
    if "emotion" in entry:
        values["emotion"] = _emotion(index, entry["emotion"])
    if "plays" in entry:
        values["plays"] = _plain(index, "plays", entry["plays"])
    return Keyframe(**values)


def _blend(index: int, name: str, value: object) -> Blend:
    try:
        return _SHAPES[name](_numbers(index, name, value, {}))
    except InvalidTrack:
        raise
    except EngineError as error:
        raise InvalidTrack(f"keyframe {index}: {name}: {error}") from error


def _add_shapes(values: dict[str, Any], shapes: Blend) -> None:
    """Add what shapes of another vocabulary come to; what is named by itself counts."""
    units: Mapping[str, float] = values["action_units"]
    values["action_units"] = {**shapes.without(units).units, **units}
    for group, axes in shapes.axes.items():
        values[group] = {**axes, **values[group]}


def _owner(index: int, value: object) -> str:
    try:
        return check_owner(value)
    except InvalidValue as error:
        raise InvalidTrack(f"keyframe {index}: {error}") from error


def _scale(index: int, value: object) -> str:
    try:
        scale_named(str(value))
    except UnknownName as error:
        raise InvalidTrack(f"keyframe {index}: {error}; known are {error.known}") from error
    return str(value)


def _facs(index: int, value: object, scale: str) -> dict[str, float]:
    if not isinstance(value, str):
        raise InvalidTrack(f"keyframe {index}: facs is {value!r}; expected a string")
    try:
        return {term.key: term.intensity for term in parse_facs(value, scale)}
    except InvalidNotation as error:
        raise InvalidTrack(f"keyframe {index}: facs: {error}") from error


def _emotion(index: int, value: object) -> tuple[str, float]:
    if isinstance(value, str):
        return value, 1.0
    if isinstance(value, Mapping) and isinstance(value.get("label"), str):
        return str(value["label"]), _number(index, "emotion.intensity", value.get("intensity", 1.0))
    raise InvalidTrack(
        f"keyframe {index}: emotion is {value!r}; expected a label or "
        "{'label': 'happiness', 'intensity': 0.8}"
    )


def _plain(index: int, name: str, value: object) -> dict[str, object]:
    if not isinstance(value, Mapping):
        raise InvalidTrack(f"keyframe {index}: {name} is {value!r}; expected an object")
    return {str(key): each for key, each in value.items()}


def _numbers(
    index: int, name: str, value: object, letters: Mapping[str, float]
) -> dict[str, float]:
    items = _plain(index, name, value).items()
    return {key: _intensity(index, f"{name}.{key}", number, letters) for key, number in items}


def _intensity(index: int, name: str, value: object, letters: Mapping[str, float]) -> float:
    if isinstance(value, str) and value.upper() in letters:
        return letters[value.upper()]
    return _number(index, name, value)


def _number(index: int, name: str, value: object) -> float:
    return _finite(f"keyframe {index}: {name}", value)


def _finite(place: str, value: object) -> float:
    if not isinstance(value, bool) and isinstance(value, int | float):
        with suppress(OverflowError):  # An integer beyond every float is not finite either.
            if math.isfinite(value):
                return float(value)
    raise InvalidTrack(f"{place} is {value!r}; expected a finite number")


def _end(keyframe: Keyframe) -> float:
    """Return when a keyframe has played, its fade-out included if it lets go [s]."""
    fade = LONGEST_ONSET if keyframe.fade is None else keyframe.fade
    ends = [] if keyframe.ttl is None else [keyframe.ttl]
    ends += [] if keyframe.hold is None else [fade + keyframe.hold]
    lets_go = min(ends) + keyframe.fade_out if ends else 0.0
    return keyframe.time + max(lets_go, fade)
