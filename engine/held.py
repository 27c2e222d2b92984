"""What one writer holds in a layer: units, muscles and axes by name, and for how long."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from .channels import GROUPS
from .facs import LIPS, ActionUnit, part_name, whole_of
from .rig import Rig
from .timeline import Keyframe, ticks

Name = TypeVar("Name", str, tuple[str, str])
Thing = tuple[str, str, str]
"""What can be held by itself: a unit's side, ("unit", "AU12", "L"); a muscle,
("muscle", "mentalis.L", ""); an axis, ("axis", "jaw", "pitch"); or `EXPRESSION`."""

EXPRESSION: Thing = ("expression", "", "")
"""That what is held is a whole expression."""


@dataclass
class Held:
    """What one writer has asked one layer for.

    Attributes:
        action_units, muscles, axes: Values by name.
        expression: Whether its units began as a whole expression.
        emotion: The emotion that this was, if it has a name.
        plays: What the expression is called and made of, as its command said.
        weight: How much of the lower layers it overrides, 0..1.
        since: Tick since which it has held anything.
        expires: Tick at which it lets go; None stays.
        fade_out: Ticks over which it lets go then.
        places: For each thing it holds, where that stands among the layer's writers: higher counts.
        written: For each thing it holds, the tick at which it said so last.
    """

    action_units: dict[str, float] = field(default_factory=dict)
    muscles: dict[str, float] = field(default_factory=dict)
    axes: dict[tuple[str, str], float] = field(default_factory=dict)
    expression: bool = False
    emotion: tuple[str, float] | None = None
    plays: Mapping[str, object] = field(default_factory=dict)
    weight: float = 1.0
    since: int = 0
    expires: int | None = None
    fade_out: int = 0
    places: dict[Thing, int] = field(default_factory=dict)
    written: dict[Thing, int] = field(default_factory=dict)

    @property
    def empty(self) -> bool:
        """True when it asks for nothing."""
        return not (self.action_units or self.muscles or self.axes or self.expression)

    @property
    def told(self) -> bool:
        """True when there is anything to tell: an expression may be without units and name."""
        named = self.emotion or self.plays
        return bool(self.action_units or self.muscles or self.axes or named)

    @property
    def newest(self) -> int:
        """Place of the thing of it that stands highest."""
        return max(self.places.values(), default=0)

    def axes_of(self, group: str) -> dict[str, float]:
        """Return the axes it holds of, say, the jaw."""
        return {axis: value for (name, axis), value in self.axes.items() if name == group}

    def clear(self) -> None:
        """Let go of everything."""
        self.action_units, self.muscles, self.axes = {}, {}, {}
        self.expression, self.emotion, self.plays = False, None, {}

    def take(self, keyframe: Keyframe, rig: Rig) -> set[Thing]:
        """Take a command; return the things that it names."""
        named: set[Thing] = set()
        if keyframe.emotion is not None or keyframe.expression:
            self.expression, self.action_units = True, {}
            self.emotion, self.plays = keyframe.emotion, keyframe.plays
            recipe = recipe_of(keyframe.emotion, rig)
            hold_units(rig, self.action_units, recipe)
            named |= {EXPRESSION, *sides_of(rig, recipe)}
        hold_units(rig, self.action_units, keyframe.action_units)
        _merge(self.muscles, keyframe.muscles)
        axes = {(g, axis): value for g in GROUPS for axis, value in getattr(keyframe, g).items()}
        _merge(self.axes, axes)
        named |= {("axis", group, axis) for group, axis in axes}
        self.weight, self.fade_out = keyframe.weight, ticks(keyframe.fade_out)
        named |= {*sides_of(rig, keyframe.action_units)}
        return named | {("muscle", name, "") for name in keyframe.muscles}

    def things(self, rig: Rig) -> dict[Thing, float]:
        """Return everything that it holds, one by one, with its value."""
        things: dict[Thing, float] = {EXPRESSION: 1.0} if self.expression else {}
        for key, value in self.action_units.items():
            things.update(dict.fromkeys(sides_of(rig, [key]), value))
        things.update({("muscle", name, ""): value for name, value in self.muscles.items()})
        things.update({("axis", *axis): value for axis, value in self.axes.items()})
        return things

    def only(self, own: Container[Thing], rig: Rig) -> Held:
        """Return what of this is among `own` things, without the rest that it says."""
        units: dict[str, float] = {}
        for key, value in self.action_units.items():
            sides = sides_of(rig, [key])
            there = [side for side in sides if side in own]
            # Under its own key where it is whole: two sides that are alike stay two.
            keys = [key] if len(there) == len(sides) else [unit_key(n, s) for _, n, s in there]
            units.update(dict.fromkeys(keys, value))
        return Held(
            action_units=units,
            muscles={n: value for n, value in self.muscles.items() if ("muscle", n, "") in own},
            axes={axis: value for axis, value in self.axes.items() if ("axis", *axis) in own},
            expression=EXPRESSION in own,
            emotion=self.emotion if EXPRESSION in own else None,
            plays=self.plays if EXPRESSION in own else {},
        )


def recipe_of(emotion: tuple[str, float] | None, rig: Rig) -> dict[str, float]:
    """Return the units of an emotion, label and intensity, by key."""
    if emotion is None:
        return {}
    label, intensity = emotion
    return {term.key: term.intensity * intensity for term in rig.resolve_emotion(label).terms}


def sides_of(rig: Rig, keys: Iterable[str]) -> list[Thing]:
    """Return the sides that units' keys stand for, two of them for "12"."""
    resolved = [rig.resolve_unit(key) for key in keys]
    return [("unit", unit.name, each) for unit, side in resolved for each in side or "LR"]


def units_of(sides: Mapping[tuple[str, str], float]) -> dict[str, float]:
    """Return values by unit and side as units by key, both sides as one where they are equal."""
    units: dict[str, float] = {}
    for name in dict.fromkeys(name for name, _ in sides):
        left, right = (sides.get((name, each), 0.0) for each in "LR")
        named = {unit_key(name, "L"): left, unit_key(name, "R"): right}
        units.update({name: left} if left == right else {k: v for k, v in named.items() if v})
    return units


def hold_units(rig: Rig, held: dict[str, float], named: Mapping[str, float]) -> None:
    """Take the named units into `held`, each under one name; 0 lets go of a unit.

    A unit without side sets both sides and lets go of what each held by itself; one side sets its
    own and leaves the other where it was. So it is with the lips of a unit that has parts: two
    that do the same are the unit again. In one command, sides and lips come after both.
    """
    resolved = [(*rig.resolve_unit(key), value) for key, value in named.items()]
    parts = [(unit, side, _whole(rig, unit, side), value) for unit, side, value in resolved]
    for unit, side, whole, value in sorted(parts, key=lambda entry: entry[2] != ""):
        left, right = (unit_key(whole or unit.name, each) for each in "LR")
        top, bottom = (part_name(whole or unit.name, each) for each in LIPS)
        if whole in held:
            halves = (left, right) if side else (top, bottom)
            held.update(dict.fromkeys(halves, held.pop(whole)))
        for stale in () if whole else (left, right, top, bottom):
            held.pop(stale, None)
        _merge(held, {unit_key(unit.name, side): value})
        # Only lips rejoin: a side keeps the name under which it was set.
        alike = whole and not side and top in held and held[top] == held.get(bottom)
        if alike and not {left, right} & set(held):
            held[whole] = held.pop(top)
            del held[bottom]


def _whole(rig: Rig, unit: ActionUnit, side: str) -> str:
    """Return the unit that one side or lip is a part of, "" for what is no part."""
    if side:
        return unit.name
    return "" if unit.name in rig.action_units else whole_of(unit.name)


def unit_key(name: str, side: str) -> str:
    """Return the one key under which a unit is held: "AU12", or "L12" for a side."""
    return f"{side}{name.removeprefix('AU')}" if side else name


def _merge(held: dict[Name, float], named: Mapping[Name, float]) -> None:
    """Take the named values into `held`; 0 lets go of a name."""
    for name, value in named.items():
        if value == 0.0:
            held.pop(name, None)
        else:
            held[name] = value
