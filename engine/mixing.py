"""Layers of commands, mixed muscle by muscle, every change faded so that nothing snaps."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from .arrays import FloatArray
from .channels import GROUPS
from .compiling import brief
from .facs import LIPS, ActionUnit, part_name, whole_of
from .rig import Rig
from .timeline import LAYERS, Keyframe, ticks

Name = TypeVar("Name", str, tuple[str, str])


@dataclass
class Held:
    """What one layer's writers have asked for, by name, and how much of the face they claim."""

    action_units: dict[str, float] = field(default_factory=dict)
    muscles: dict[str, float] = field(default_factory=dict)
    axes: dict[tuple[str, str], float] = field(default_factory=dict)
    emotion: tuple[str, float] | None = None
    weight: float = 1.0
    expires: int | None = None
    fade_out: int = 0

    @property
    def empty(self) -> bool:
        """True when the layer asks for nothing."""
        return not (self.action_units or self.muscles or self.axes)


@brief
def ramps_at(
    start: FloatArray, target: FloatArray, begin: FloatArray, length: FloatArray, tick: int
) -> FloatArray:
    """Return the values of ramps at `tick`, shape (channels,): see `Ramp`."""
    values = np.empty(start.shape[0])
    for channel in range(start.shape[0]):
        values[channel] = eased(
            start[channel], target[channel], begin[channel], length[channel], tick
        )
    return values


@brief
def eased(start: float, target: float, begin: float, length: float, tick: int) -> float:
    """Return where a ramp stands at `tick`: an ease in and out, level at both ends."""
    if tick >= begin + length:
        return target
    done = max((tick - begin) / length, 0.0)
    return start + (target - start) * done * done * (3.0 - 2.0 * done)


@brief
def merge(ramps: FloatArray, tick: int) -> FloatArray:
    """Return what layers come to at `tick`, each over the lower by its share, (channels,).

    Args:
        ramps: Shape (layers, 2, 4, channels): of values and of shares, the fields of `Ramp`.
        tick: When.
    """
    merged = np.zeros(ramps.shape[3])
    for layer in range(ramps.shape[0]):
        value, share = ramps[layer, 0], ramps[layer, 1]
        for c in range(merged.shape[0]):
            weight = eased(share[0, c], share[1, c], share[2, c], share[3, c], tick)
            if weight != 0.0:
                held = eased(value[0, c], value[1, c], value[2, c], value[3, c], tick)
                merged[c] = merged[c] * (1.0 - weight) + held * weight
    return merged


@dataclass
class Ramp:
    """A vector on its way from `start` to `target`, each entry in its own time.

    Attributes:
        start, target: Values, shape (channels,).
        begin: Tick at which each entry's way began, shape (channels,).
        length: Ticks it takes, shape (channels,); 0 is at once.
    """

    start: FloatArray
    target: FloatArray
    begin: FloatArray
    length: FloatArray

    def at(self, tick: int) -> FloatArray:
        """Return the values at `tick`: an ease in and out, level at both ends."""
        return ramps_at(self.start, self.target, self.begin, self.length, tick)

    def end(self) -> int:
        """Return the tick at which the last entry arrives."""
        return int((self.begin + self.length).max())

    def move(self, target: FloatArray, tick: int, length: FloatArray) -> None:
        """Send the entries whose target changes on a new way from where they are.

        Args:
            target: New values, shape (channels,).
            tick: Now.
            length: Ticks that each entry takes, shape (channels,).
        """
        changed = target != self.target
        self.start[changed] = self.at(tick)[changed]
        self.target[changed] = target[changed]
        self.begin[changed] = tick
        self.length[changed] = length[changed]


class Mixer:
    """The commands of one face: what each layer holds, and the one vector they make together."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._held = {layer: Held() for layer in LAYERS}
        self._take(np.zeros((len(LAYERS), 2, 4, rig.channels.count)))
        self._settled_at = 0
        self._merged: FloatArray | None = None
        self._merged_at = 0

    def apply(self, keyframe: Keyframe, tick: int) -> None:
        """Take a command that starts at `tick`; `Rig.check` has passed it.

        The latest command says how long its layer holds and how much it weighs.
        """
        self._expire(tick)
        held = self._held[keyframe.layer]
        before = dict(held.action_units)
        if keyframe.replace:
            held.action_units, held.muscles, held.axes, held.emotion = {}, {}, {}, None
        if keyframe.emotion is not None:
            held.emotion = keyframe.emotion
            held.action_units = self._emotion_units(*keyframe.emotion)
        hold_units(self._rig, held.action_units, keyframe.action_units)
        _merge(held.muscles, keyframe.muscles)
        for group in GROUPS:
            for axis, value in getattr(keyframe, group).items():
                _merge(held.axes, {(group, axis): value})
        held.weight = keyframe.weight
        held.expires = None
        lengths = self._lengths(before, held.action_units, keyframe)
        if keyframe.hold is not None:
            held.expires = tick + int(lengths.max()) + ticks(keyframe.hold)
            held.fade_out = ticks(keyframe.fade_out)
        self._retarget(keyframe.layer, tick, lengths)

    def at(self, tick: int) -> FloatArray:
        """Return the merged command at `tick`, shape (channels,)."""
        self._expire(tick)
        if self._merged is None or self._merged_at <= self._settled_at:
            self._merged, self._merged_at = merge(self._ramps, tick), tick
        return self._merged

    def changing(self, tick: int) -> bool:
        """Return whether the command still moves at `tick`."""
        return tick <= self._settled_at

    def due(self, tick: int) -> bool:
        """Return whether the command moves at `tick` or a layer's time is up: a face must wake."""
        return self.changing(tick) or any(
            h.expires is not None and tick >= h.expires for h in self._held.values()
        )

    def alarm(self) -> int | None:
        """Return the tick at which the first layer's time is up, None where all hold for ever."""
        return min((h.expires for h in self._held.values() if h.expires is not None), default=None)

    def report(self, tick: int) -> dict[str, object]:
        """Return what each layer holds and the merged command, as plain data."""
        self._expire(tick)
        return {
            "layers": {
                layer: self._layer_report(held)
                for layer, held in self._held.items()
                if not held.empty or held.emotion is not None
            },
            "merged": self._merged_report(tick),
        }

    def moved_to(self, rig: Rig, tick: int) -> Mixer:
        """Return these commands on a derived `rig`, where they stand, for a live edit."""
        moved = copy.deepcopy(self)
        moved._rig = rig
        for layer in LAYERS:
            moved._retarget(layer, tick, moved._all(0))
        return moved

    def __deepcopy__(self, memo: dict[int, object]) -> Mixer:
        twin = Mixer(self._rig)
        twin._held = copy.deepcopy(self._held, memo)
        twin._take(self._ramps.copy())
        twin._settled_at = self._settled_at
        return twin

    def _take(self, ramps: FloatArray) -> None:
        """Take ramps, shape (layers, 2, 4, channels), and look at them by layer."""
        self._ramps = ramps
        self._values = {layer: Ramp(*ramps[i, 0]) for i, layer in enumerate(LAYERS)}
        self._shares = {layer: Ramp(*ramps[i, 1]) for i, layer in enumerate(LAYERS)}

    def _emotion_units(self, label: str, intensity: float) -> dict[str, float]:
        terms = self._rig.resolve_emotion(label).terms
        units: dict[str, float] = {}
        hold_units(self._rig, units, {term.key: term.intensity * intensity for term in terms})
        return units

    def _expire(self, tick: int) -> None:
        for layer, held in self._held.items():
            if held.expires is not None and tick >= held.expires:
                self._held[layer] = Held()
                self._retarget(layer, tick, self._all(held.fade_out))

    def _all(self, length: int) -> FloatArray:
        """Return the same number of ticks for every channel, shape (channels,)."""
        return np.full(self._rig.channels.count, float(length))

    def _lengths(
        self, before: Mapping[str, float], after: Mapping[str, float], keyframe: Keyframe
    ) -> FloatArray:
        """Return the ticks that each channel takes from one set of units to another, (channels,).

        With no fade, a channel takes the onset of the unit that moves it most as it rises, and
        the offset as it falls; what the command names by itself is there at once.
        """
        if keyframe.fade is not None:
            return self._all(ticks(keyframe.fade))
        channels = self._rig.channels
        lengths, most = self._all(0), np.zeros(channels.count)
        for key in sorted({*before, *after}):
            change = after.get(key, 0.0) - before.get(key, 0.0)
            if change == 0.0:
                continue
            unit, _ = self._rig.resolve_unit(key)
            moved = np.abs(self._rig.contraction({key: abs(change)}))
            leads = moved > most
            lengths[leads] = ticks(unit.onset if change > 0.0 else unit.offset)
            most = np.maximum(most, moved)
        # What units move only together, by a rule, goes with the slowest of them.
        lengths[most == 0.0] = lengths.max()
        for name in keyframe.muscles:
            lengths[channels.muscle_names.index(name)] = 0.0
        for group in GROUPS:
            for axis in getattr(keyframe, group):
                lengths[channels.index(group, axis)] = 0.0
        return lengths

    def _retarget(self, layer: str, tick: int, fade: FloatArray) -> None:
        """Point the layer's ramps at what it now holds, each channel over its `fade`, ticks."""
        held, values, shares = self._held[layer], self._values[layer], self._shares[layer]
        target, claimed = self._vector(held)
        # A channel that nobody claimed takes its value at once and fades in by its share; one
        # that is let go keeps its value and fades out by its share.
        fresh = claimed & (shares.at(tick) == 0.0)
        values.start[fresh] = values.target[fresh] = target[fresh]
        values.length[fresh] = 0.0
        values.move(np.where(claimed, target, values.target), tick, fade)
        shares.move(np.where(claimed, held.weight, 0.0), tick, fade)
        ramps = (*self._values.values(), *self._shares.values())
        self._settled_at = max(tick, *(ramp.end() for ramp in ramps))
        self._merged = None

    def _vector(self, held: Held) -> tuple[FloatArray, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
        channels = self._rig.channels
        target = self._rig.contraction(held.action_units)
        claimed = target != 0.0
        for name, value in held.muscles.items():
            index = channels.muscle_names.index(name)
            target[index], claimed[index] = value, True
        for (group, axis), value in held.axes.items():
            index = channels.index(group, axis)
            target[index], claimed[index] = value, True
        return target, claimed

    def _layer_report(self, held: Held) -> dict[str, object]:
        report: dict[str, object] = {
            "action_units": dict(held.action_units),
            "muscles": dict(held.muscles),
            "weight": held.weight,
        }
        for group in GROUPS:
            axes = {axis: v for (name, axis), v in held.axes.items() if name == group}
            if axes:
                report[group] = axes
        if held.emotion is not None:
            report["emotion"] = {"label": held.emotion[0], "intensity": held.emotion[1]}
        return report

    def _merged_units(self) -> dict[str, float]:
        """Return what the layers' units come to, each layer over the lower by its weight."""
        sides: dict[tuple[str, str], float] = {}
        for held in (self._held[layer] for layer in LAYERS):
            for key, value in held.action_units.items():
                unit, side = self._rig.resolve_unit(key)
                for place in ((unit.name, each) for each in side or "LR"):
                    below = sides.get(place, 0.0)
                    sides[place] = below + (value - below) * held.weight
        units: dict[str, float] = {}
        for name in dict.fromkeys(name for name, _ in sides):
            left, right = (sides.get((name, each), 0.0) for each in "LR")
            named = {unit_key(name, "L"): left, unit_key(name, "R"): right}
            units.update({name: left} if left == right else {k: v for k, v in named.items() if v})
        return units

    def _merged_report(self, tick: int) -> dict[str, object]:
        merged, channels = self.at(tick), self._rig.channels
        units = self._merged_units()
        report: dict[str, object] = {
            "action_units": units,
            "muscles": {
                name: round(float(value), 4)
                for name, value in zip(channels.muscle_names, merged, strict=False)
                if value != 0.0
            },
        }
        for group, axes in GROUPS.items():
            report[group] = {axis: float(merged[channels.index(group, axis)]) for axis in axes}
        return report


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
