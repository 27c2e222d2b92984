"""The action units that a timeline commands, moment by moment: what a clip is asked to show.

It follows the rules by which a face mixes its layers, for intensities instead of muscles: a value
eases to its target over the command's fade, and a higher layer overrides a lower by its share.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from engine import (
    LAYERS,
    LIPS,
    Keyframe,
    Rig,
    Timeline,
    hold_units,
    part_name,
    unit_key,
    whole_of,
)


@dataclass
class _Ramp:
    """A number on its way from `start` to `target` [seconds]."""

    start: float = 0.0
    target: float = 0.0
    begin: float = 0.0
    length: float = 0.0

    def at(self, time: float) -> float:
        if self.length <= 0.0 or time >= self.begin + self.length:
            return self.target
        done = max(0.0, (time - self.begin) / self.length)
        return self.start + (self.target - self.start) * done * done * (3.0 - 2.0 * done)

    def move(self, target: float, time: float, length: float) -> None:
        if target != self.target:
            self.start, self.target, self.begin, self.length = self.at(time), target, time, length


@dataclass
class _Layer:
    """What one layer holds, by action unit, and how much of the lower layers it overrides."""

    units: dict[str, float] = field(default_factory=dict)
    values: dict[str, _Ramp] = field(default_factory=dict)
    shares: dict[str, _Ramp] = field(default_factory=dict)
    weight: float = 1.0
    expires: float | None = None
    fade_out: float = 0.0

    def apply(self, keyframe: Keyframe, recipe: Mapping[str, float] | None, rig: Rig) -> None:
        before = dict(self.units)
        if keyframe.replace or recipe is not None:
            self.units = {}
        hold_units(rig, self.units, recipe or {})
        hold_units(rig, self.units, keyframe.action_units)
        self.weight = keyframe.weight
        self.expires = None
        if keyframe.hold is not None:
            fade = max(self._fades(keyframe, before, rig).values(), default=0.0)
            self.expires = keyframe.time + fade + keyframe.hold
            self.fade_out = keyframe.fade_out
        self._retarget(keyframe.time, self._fades(keyframe, before, rig))

    def let_go(self, time: float) -> None:
        if self.expires is not None and time >= self.expires:
            self.units = {}
            self._retarget(self.expires, dict.fromkeys(self.shares, self.fade_out))
            self.expires = None

    def _fades(self, keyframe: Keyframe, before: Mapping[str, float], rig: Rig) -> dict[str, float]:
        """Return the seconds that each unit takes: the command's, or its own onset or offset."""
        keys = {*self.units, *self.values}
        if keyframe.fade is not None:
            return dict.fromkeys(keys, keyframe.fade)
        fades = {}
        for key in keys:
            unit, _ = rig.resolve_unit(key)
            rises = self.units.get(key, 0.0) > before.get(key, 0.0)
            fades[key] = unit.onset if rises else unit.offset
        return fades

    def _retarget(self, time: float, fades: Mapping[str, float]) -> None:
        for key in {*self.units, *self.values}:
            fade = fades.get(key, 0.0)
            value = self.values.setdefault(key, _Ramp())
            share = self.shares.setdefault(key, _Ramp())
            if key in self.units:
                fresh = share.at(time) == 0.0
                value.move(self.units[key], time, 0.0 if fresh else fade)
            share.move(self.weight if key in self.units else 0.0, time, fade)


def commanded_units(
    timeline: Timeline, rig: Rig, times: Sequence[float]
) -> tuple[list[str], npt.NDArray[np.float64]]:
    """Return names, and intensities 0..1 at `times` [s, rising], shape (times, names).

    Every unit of the rig has a column, and both sides of one, `L12` and `R12`, of which a side is
    commanded, and both lips, `T28` and `B28`.
    """
    recipes = [_recipe(keyframe, rig) for keyframe in timeline.keyframes]
    keys = {key for keyframe in timeline.keyframes for key in keyframe.action_units}
    keys |= {key for recipe in recipes for key in recipe or ()}
    asked = [rig.resolve_unit(key) for key in sorted(keys)]
    sided = {unit_key(unit.name, each) for unit, side in asked if side for each in "LR"}
    parts = {unit.name for unit, _ in asked} - set(rig.action_units)
    lips = {part_name(whole_of(name), each) for name in parts for each in LIPS}
    names = [*rig.action_units, *sorted(sided | lips)]
    layers = {layer: _Layer() for layer in LAYERS}
    coming = list(zip(timeline.keyframes, recipes, strict=True))
    rows = np.zeros((len(times), len(names)))
    for row, time in enumerate(times):
        while coming and coming[0][0].time <= time:
            keyframe, recipe = coming.pop(0)
            layers[keyframe.layer].let_go(keyframe.time)
            layers[keyframe.layer].apply(keyframe, recipe, rig)
        for layer in layers.values():
            layer.let_go(time)
            for column, name in enumerate(names):
                if name in layer.values:
                    share = layer.shares[name].at(time)
                    mixed = rows[row, column] * (1.0 - share) + layer.values[name].at(time) * share
                    rows[row, column] = mixed
    return names, rows


def _recipe(keyframe: Keyframe, rig: Rig) -> dict[str, float] | None:
    if keyframe.emotion is None:
        return None
    label, intensity = keyframe.emotion
    terms = rig.resolve_emotion(label).terms
    return {term.key: term.intensity * intensity for term in terms}
