"""The built-in muscles, action units and emotions, read from the data files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import resources
from typing import Any

from .emotion import Emotion
from .facs import ActionUnit
from .head import Head
from .muscle import KINDS, Muscle, Point

_POINT_FIELDS = ("attachment", "insertion", "center", "plane")


def load_muscles(head: Head) -> list[Muscle]:
    """Return the left and midline muscles on `head`.

    Ends are stored as a named point of the cage plus an offset, so that they follow the head's
    shape; a head without named points takes the stored head-frame coordinates instead.
    """
    entries = _read("muscles.json")["muscles"]
    return [_muscle(entry, head) for entry in entries]


def load_action_units() -> dict[str, ActionUnit]:
    """Return the action units by name, in FACS order."""
    units = {}
    for entry in _read("action_units.json")["action_units"]:
        entry = dict(entry)
        entry["curve"] = tuple(tuple(knot) for knot in entry["curve"])
        unit = ActionUnit(**entry)
        units[unit.name] = unit
    return units


def load_emotions() -> dict[str, Emotion]:
    """Return the emotions by name."""
    emotions = {}
    for entry in _read("emotions.json")["emotions"]:
        emotion = Emotion(**{**entry, "synonyms": tuple(entry.get("synonyms", ()))})
        emotions[emotion.name] = emotion
    return emotions


def _muscle(entry: Mapping[str, Any], head: Head) -> Muscle:
    values = dict(entry)
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
    if "normal" in values:
        values["normal"] = tuple(values["normal"])
    return KINDS[kind](**values)


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
