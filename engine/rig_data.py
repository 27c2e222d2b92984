"""The built-in muscles, action units, their combinations and emotions, read from the data files."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from importlib import resources
from typing import Any

from .combination import Combination
from .emotion import Emotion
from .facs import ActionUnit
from .head import Head
from .muscle import KINDS, Muscle, Point

_SIZED_FIELDS = ("radius", "semi_major", "upper", "lower")
_POINT_FIELDS = ("attachment", "insertion", "center", "plane")


def load_muscles(head: Head, fitted_on: Head | None = None) -> list[Muscle]:
    """Return the left and midline muscles on `head`.

    Ends are stored as a named point of the cage plus an offset, so that they follow the head's
    shape; a head without named points takes the stored head-frame coordinates instead.

    Args:
        head: Any head.
        fitted_on: The head on which their reaches were fitted; a muscle that is longer on `head`
            reaches farther in proportion. Without it reaches stay as they are stored.
    """
    entries = _read("muscles.json")["muscles"]
    return [
        _muscle(
            entry, head, 1.0 if fitted_on is None else _span(entry, head) / _span(entry, fitted_on)
        )
        for entry in entries
    ]


def load_action_units() -> dict[str, ActionUnit]:
    """Return the action units by name, in FACS order."""
    units = {}
    for entry in _read("action_units.json")["action_units"]:
        entry = dict(entry)
        entry["curve"] = tuple(tuple(knot) for knot in entry["curve"])
        unit = ActionUnit(**entry)
        units[unit.name] = unit
    return units


def load_reaches() -> Mapping[str, Mapping[str, float]]:
    """Return the factors on the units' curves by person, where the standard ones fall short."""
    reaches: Mapping[str, Mapping[str, float]] = _read("reaches.json")["people"]
    return reaches


def load_combinations() -> tuple[Combination, ...]:
    """Return the rules of units that act together."""
    entries = _read("combinations.json")["combinations"]
    return tuple(Combination(**{**entry, "units": tuple(entry["units"])}) for entry in entries)


def load_emotions() -> dict[str, Emotion]:
    """Return the emotions by name."""
    emotions = {}
    for entry in _read("emotions.json")["emotions"]:
        emotion = Emotion(**{**entry, "synonyms": tuple(entry.get("synonyms", ()))})
        emotions[emotion.name] = emotion
    return emotions


def _muscle(entry: Mapping[str, Any], head: Head, size: float) -> Muscle:
    values = dict(entry)
    if "force_scale" in values:
        values["force_scale"] = float(values["force_scale"])
    for name in _SIZED_FIELDS:
        if name in values:
            values[name] = values[name] * size
    kind = values.pop("kind")
    if values.pop("paired"):
        values["name"] = f"{values['name']}.L"
    for name in _POINT_FIELDS:
        if name in values:
            value = values[name]
            pair = isinstance(value, list)
            values[name] = (
                tuple(_place(end, head) for end in value) if pair else _place(value, head)
            )
    for name in ("normal", "extent"):
        if name in values:
            values[name] = tuple(float(value) for value in values[name])
    return KINDS[kind](**values)


def _span(entry: Mapping[str, Any], head: Head) -> float:
    """Return what of `head` the muscle's size goes with: a length, mm, or an angle."""
    if entry["name"] == "orbicularis_oculi_pretarsal":  # It closes the eye, however far it is open.
        edges = [
            head.points[head.point(f"E1_{spoke}.L")] - head.eyes[0].center for spoke in (4, 12)
        ]
        return math.atan2(edges[0][1], edges[0][2]) - math.atan2(edges[1][1], edges[1][2])
    if entry["name"].startswith("orbicularis_oris"):
        ends = [head.points[head.point(f"M1_5.{side}")] for side in "LR"]
        return math.dist(*ends)
    if "insertion" not in entry:
        return 1.0
    middles = []
    for name in ("attachment", "insertion"):
        ends = entry[name] if isinstance(entry[name], list) else [entry[name]]
        places = [_place(end, head) for end in ends]
        middles.append([sum(axis) / len(places) for axis in zip(*places, strict=True)])
    return math.dist(*middles)


def _place(end: Mapping[str, Any], head: Head) -> Point:
    if not any(head.names):
        x, y, z = end["at"]
        return (float(x), float(y), float(z))
    point = head.points[head.point(end["point"])]
    x, y, z = (float(p) + float(o) for p, o in zip(point, end["offset"], strict=True))
    return (x, y, z)


def _read(name: str) -> dict[str, Any]:
    text = resources.files("engine").joinpath("data", name).read_text(encoding="utf-8")
    data: dict[str, Any] = json.loads(text)
    return data
