"""Shapes of other vocabularies, as units and axes: their tables, and what they come to together."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

from .channels import LIMITS
from .errors import InvalidNotation, InvalidValue
from .facs import split_side

_WHOLE = ""


@dataclass(frozen=True)
class Shape:
    """One name of another vocabulary.

    Attributes:
        name: As its makers write it.
        units: Intensity 0..1 by "AU18", "L12" or "B28", at weight 1.
        axes: Degrees or mm by "gaze.yaw", at weight 1.
        source: Who says so.
        aliases: Other names of it.
        note: What to know of it.
        stands_in: What is played in place of what no unit does; empty where the units fit.
        halves: Whether a side of it may be named, which its makers have not.
        closes: Whether it is seen only if it is reached: lips that close.
    """

    name: str
    source: str
    units: Mapping[str, float] = field(default_factory=dict)
    axes: Mapping[str, float] = field(default_factory=dict)
    aliases: tuple[str, ...] = ()
    note: str = ""
    stands_in: str = ""
    halves: bool = False
    closes: bool = False

    def half(self, side: str) -> Shape:
        """Return the side "L" or "R" of a shape of which both move alike."""
        units = {side + key.removeprefix("AU"): value for key, value in self.units.items()}
        return Shape(self.name, self.source, units)


@dataclass(frozen=True)
class ShapeTable:
    """A vocabulary of shapes, with a version that changes with any of its numbers."""

    version: str
    title: str
    source: str
    rule: str
    shapes: Mapping[str, Shape]

    def to_json(self) -> dict[str, object]:
        """Return the table as plain data: what each name plays, and who says so."""
        return {
            "version": self.version,
            "title": self.title,
            "source": self.source,
            "rule": self.rule,
            "shapes": {name: _plain(shape) for name, shape in self.shapes.items()},
        }


@dataclass(frozen=True)
class Blend:
    """What several shapes come to.

    Attributes:
        units: Intensity 0..1 by key; a 0 lets go.
        axes: Degrees or mm by axis, by "jaw", "gaze", "head" or "tongue".
    """

    units: Mapping[str, float] = field(default_factory=dict)
    axes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def without(self, named: Iterable[str]) -> Blend:
        """Return it without the units, or sides of them, that `named` keys say by themselves."""
        own = {place for key in named for place in _places(key)}
        units: dict[str, float] = {}
        for key, value in self.units.items():
            places = _places(key)
            left = [place for place in places if place not in own]
            if len(left) == len(places):
                units[key] = value
            else:
                units.update({_key(name, side): value for name, side in left})
        return Blend(units, self.axes)


def blend(parts: Iterable[tuple[Shape, float]]) -> Blend:
    """Return the sum of shapes at weights, 0..1.

    What several shapes ask of one unit is added and held to 1; of one axis, to its limits. A unit
    that is asked for both as a whole and by sides is told by sides.
    """
    sums: dict[tuple[str, str], float] = {}
    axes: dict[str, dict[str, float]] = {}
    for shape, weight in parts:
        for key, value in shape.units.items():
            place = split_name(key)
            sums[place] = sums.get(place, 0.0) + value * weight
        for key, value in shape.axes.items():
            group, axis = key.split(".")
            values = axes.setdefault(group, {})
            values[axis] = values.get(axis, 0.0) + value * weight
    return Blend(_units(sums), {group: _held_to(group, each) for group, each in axes.items()})


def check_weight(kind: str, name: str, value: float) -> float:
    """Return a weight that may be one.

    Raises:
        InvalidValue: If it is not from 0 to 1.
    """
    if not (math.isfinite(value) and 0.0 <= value <= 1.0):
        raise InvalidValue(f"{kind}.{name} is {value!r}; expected a weight from 0 to 1")
    return value


def read_table(name: str) -> ShapeTable:
    """Return the table in `engine/data` of that file name."""
    text = resources.files("engine").joinpath("data", name).read_text(encoding="utf-8")
    data: dict[str, Any] = json.loads(text)
    shapes = [Shape(**{**row, "aliases": tuple(row.get("aliases", ()))}) for row in data["shapes"]]
    by_name = {shape.name: shape for shape in shapes}
    return ShapeTable(data["version"], data["title"], data["source"], data["rule"], by_name)


def split_name(key: str) -> tuple[str, str]:
    """Return unit and side of a key, ("AU12", "L"); a lip, "T28", is a unit of its own."""
    with suppress(InvalidNotation):
        name, side = split_side(key)
        return (name, side) if side in ("", "L", "R") else (key, _WHOLE)
    return key, _WHOLE


def _units(sums: Mapping[tuple[str, str], float]) -> dict[str, float]:
    units: dict[str, float] = {}
    for name in dict.fromkeys(name for name, _ in sums):
        whole = sums.get((name, _WHOLE), 0.0)
        sides = [side for side in "LR" if (name, side) in sums]
        if not sides:
            units[name] = min(1.0, whole)
        elif whole:
            sides = ["L", "R"]
        units.update(
            {_key(name, side): min(1.0, whole + sums.get((name, side), 0.0)) for side in sides}
        )
    return units


def _held_to(group: str, axes: Mapping[str, float]) -> dict[str, float]:
    return {
        axis: min(max(value, LIMITS[group, axis][0]), LIMITS[group, axis][1])
        for axis, value in axes.items()
    }


def _places(key: str) -> list[tuple[str, str]]:
    name, side = split_name(key)
    return [(name, each) for each in side or "LR"]


def _key(name: str, side: str) -> str:
    return f"{side}{name.removeprefix('AU')}" if side else name


def _plain(shape: Shape) -> dict[str, object]:
    plain: dict[str, object] = {
        "units": dict(shape.units),
        "axes": dict(shape.axes),
        "source": shape.source,
    }
    told = {"aliases": list(shape.aliases), "note": shape.note, "stands_in": shape.stands_in}
    return {**plain, **{name: value for name, value in told.items() if value}}
