"""Layers of commands, mixed muscle by muscle, every change faded so that nothing snaps."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .channels import GROUPS
from .held import units_of
from .ramps import Ramp, merge
from .rig import Rig
from .timeline import LAYERS, Keyframe
from .writers import Writers

_DECIMALS = 4
"""Of what is reported: more would be noise of products and mixtures."""


class Mixer:
    """The commands of one face: what each layer holds, and the one vector they make together."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._writers = Writers(rig)
        self._take(np.zeros((len(LAYERS), 2, 4, rig.channels.count)))
        self._adds = np.zeros((len(LAYERS), rig.channels.count), bool)
        self._settled_at = 0
        self._merged: FloatArray | None = None
        self._merged_at = 0

    def apply(self, keyframe: Keyframe, tick: int) -> None:
        """Take a command that starts at `tick`; `Rig.check` has passed it.

        The latest command of a writer says how long it holds what it does and how much it weighs.

        Raises:
            InvalidValue: If the layer has as many writers as it may.
        """
        self._expire(tick)
        lengths = self._writers.take(keyframe, tick)
        self._retarget(keyframe.layer, tick, lengths)

    def at(self, tick: int) -> FloatArray:
        """Return the merged command at `tick`, shape (channels,)."""
        self._expire(tick)
        moving = self._merged_at <= self._settled_at and self._merged_at != tick
        if self._merged is None or moving:
            self._merged, self._merged_at = merge(self._ramps, self._adds, tick), tick
        return self._merged

    def changing(self, tick: int) -> bool:
        """Return whether the command still moves at `tick`."""
        return tick <= self._settled_at

    def due(self, tick: int) -> bool:
        """Return whether the command moves at `tick` or a writer's time is up: a face must wake."""
        alarm = self.alarm()
        return self.changing(tick) or (alarm is not None and tick >= alarm)

    def alarm(self) -> int | None:
        """Return the tick at which the first writer's time is up, None where all stay."""
        return self._writers.alarm()

    def report(self, tick: int) -> dict[str, object]:
        """Return what each layer and writer holds and the merged command, as plain data."""
        self._expire(tick)
        return {
            "layers": self._writers.report(tick),
            "merged": self._merged_report(tick),
        }

    def held(self, tick: int) -> list[Keyframe]:
        """Return commands that make a face at rest hold what this one does at `tick`."""
        return self._writers.keyframes(tick)

    def moved_to(self, rig: Rig, tick: int) -> Mixer:
        """Return these commands on a derived `rig`, where they stand, for a live edit."""
        moved = Mixer(rig)
        moved._writers = self._writers.on(rig)
        moved._take(self._ramps.copy())
        moved._adds = self._adds.copy()
        moved._settled_at = self._settled_at
        for layer in LAYERS:
            moved._retarget(layer, tick, moved._all(0))
        return moved

    def __deepcopy__(self, memo: dict[int, object]) -> Mixer:
        twin = Mixer(self._rig)
        twin._writers = self._writers.on(self._rig)
        twin._take(self._ramps.copy())
        twin._adds = self._adds.copy()
        twin._settled_at = self._settled_at
        return twin

    def _take(self, ramps: FloatArray) -> None:
        """Take ramps, shape (layers, 2, 4, channels), and look at them by layer."""
        self._ramps = ramps
        self._values = {layer: Ramp(*ramps[i, 0]) for i, layer in enumerate(LAYERS)}
        self._shares = {layer: Ramp(*ramps[i, 1]) for i, layer in enumerate(LAYERS)}

    def _expire(self, tick: int) -> None:
        for expired in self._writers.expire(tick):
            self._retarget(expired.layer, tick, self._all(expired.fade_out))

    def _all(self, length: int) -> FloatArray:
        """Return the same number of ticks for every channel, shape (channels,)."""
        return np.full(self._rig.channels.count, float(length))

    def _retarget(self, layer: str, tick: int, fade: FloatArray) -> None:
        """Point the layer's ramps at what it now holds, each channel over its `fade`, ticks."""
        values, shares = self._values[layer], self._shares[layer]
        target, share, claimed, touched = self._writers.vector(layer)
        # A channel that nobody claimed takes its value at once and fades in by its share; one
        # that is let go keeps its value and fades out by its share.
        fresh = claimed & (shares.at(tick) == 0.0)
        values.start[fresh] = values.target[fresh] = target[fresh]
        values.length[fresh] = 0.0
        values.move(np.where(claimed, target, values.target), tick, fade)
        shares.move(share, tick, fade)
        # What is let go goes as it was held.
        adds = self._adds[LAYERS.index(layer)]
        adds[claimed] = touched[claimed]
        _, _, begin, length = np.moveaxis(self._ramps, 2, 0)
        self._settled_at = max(tick, int((begin + length).max()))
        self._merged = None

    def _merged_units(self) -> dict[str, float]:
        """Return what the layers' units come to, each layer over the lower by its weight."""
        sides: dict[tuple[str, str], float] = {}
        for place, value, weight in self._writers.weighed_units():
            below = sides.get(place, 0.0)
            sides[place] = below + (value - below) * weight
        return units_of(sides)

    def _merged_report(self, tick: int) -> dict[str, object]:
        merged, channels = self.at(tick), self._rig.channels
        report: dict[str, object] = {
            "action_units": {
                key: round(value, _DECIMALS) for key, value in self._merged_units().items()
            },
            "muscles": {
                name: round(float(value), _DECIMALS)
                for name, value in zip(channels.muscle_names, merged, strict=False)
                if value != 0.0
            },
        }
        for group, axes in GROUPS.items():
            report[group] = {
                axis: round(float(merged[channels.index(group, axis)]), _DECIMALS) for axis in axes
            }
        return report
