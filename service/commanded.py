"""The action units that a timeline commands, moment by moment: what a clip is asked to show.

It follows the rules by which a face mixes its layers, for intensities instead of muscles: a value
eases to its target over the command's fade, and a higher layer overrides a lower by its share.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from engine import (
    LAYERS,
    LIPS,
    TICKS_PER_SECOND,
    Keyframe,
    Rig,
    Timeline,
    Writers,
    part_name,
    recipe_of,
    ticks,
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
    """What one layer comes to, by action unit, and how much of the lower layers it overrides."""

    values: dict[str, _Ramp] = field(default_factory=dict)
    shares: dict[str, _Ramp] = field(default_factory=dict)

    def go(
        self, units: Mapping[str, tuple[float, float]], time: float, fades: Mapping[str, float]
    ) -> None:
        """Send each unit to its value and share, over its fade, 0 if it has none [seconds]."""
        for key in {*units, *self.values}:
            fade = fades.get(key, 0.0)
            value = self.values.setdefault(key, _Ramp())
            share = self.shares.setdefault(key, _Ramp())
            target, weight = units.get(key, (value.target, 0.0))
            fresh = share.at(time) == 0.0
            value.move(target, time, 0.0 if fresh else fade)
            share.move(weight, time, fade)


class _Score:
    """What a timeline commands so far: who holds what, and the layers on their way there."""

    def __init__(self, rig: Rig) -> None:
        self.layers = {layer: _Layer() for layer in LAYERS}
        self._writers = Writers(rig)

    def apply(self, keyframe: Keyframe) -> None:
        tick, layer = ticks(keyframe.time), self.layers[keyframe.layer]
        before = self._writers.units(keyframe.layer)
        self._writers.take(keyframe, tick)
        units = self._writers.shared_units(keyframe.layer)
        layer.go(units, keyframe.time, self._fades(keyframe, before, {*units, *layer.values}))

    def let_go(self, time: float) -> None:
        """Let go of every writer whose time is up."""
        for expired in self._writers.expire(ticks(time)):
            layer = self.layers[expired.layer]
            fades = dict.fromkeys(layer.values, expired.fade_out / TICKS_PER_SECOND)
            units = self._writers.shared_units(expired.layer)
            layer.go(units, expired.tick / TICKS_PER_SECOND, fades)

    def _fades(
        self, keyframe: Keyframe, before: Mapping[str, float], keys: Iterable[str]
    ) -> dict[str, float]:
        """Return the seconds that each unit takes: the command's, or its own onset or offset."""
        if keyframe.fade is not None:
            return dict.fromkeys(keys, keyframe.fade)
        after, rig = self._writers.units(keyframe.layer), self._writers.rig
        fades = {}
        for key in keys:
            unit, _ = rig.resolve_unit(key)
            rises = after.get(key, 0.0) > before.get(key, 0.0)
            fades[key] = unit.onset if rises else unit.offset
        return fades


def commanded_units(
    timeline: Timeline, rig: Rig, times: Sequence[float]
) -> tuple[list[str], npt.NDArray[np.float64]]:
    """Return names, and intensities 0..1 at `times` [s, rising], shape (times, names).

    Every unit of the rig has a column, and both sides of one, `L12` and `R12`, of which a side is
    commanded, and both lips, `T28` and `B28`.
    """
    keys = {key for keyframe in timeline.keyframes for key in keyframe.action_units}
    keys |= {key for keyframe in timeline.keyframes for key in recipe_of(keyframe.emotion, rig)}
    asked = [rig.resolve_unit(key) for key in sorted(keys)]
    sided = {unit_key(unit.name, each) for unit, side in asked if side for each in "LR"}
    parts = {unit.name for unit, _ in asked} - set(rig.action_units)
    lips = {part_name(whole_of(name), each) for name in parts for each in LIPS}
    names = [*rig.action_units, *sorted(sided | lips)]
    score, coming = _Score(rig), list(timeline.keyframes)
    rows = np.zeros((len(times), len(names)))
    for row, time in enumerate(times):
        while coming and coming[0].time <= time:
            score.let_go(coming[0].time)
            score.apply(coming.pop(0))
        score.let_go(time)
        for layer in score.layers.values():
            for column, name in enumerate(names):
                if name in layer.values:
                    share = layer.shares[name].at(time)
                    mixed = rows[row, column] * (1.0 - share) + layer.values[name].at(time) * share
                    rows[row, column] = mixed
    return names, rows
