"""Values on their way: an ease from where each stands to where it is sent, and layers of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray
from .compiling import brief


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
def merge(ramps: FloatArray, adds: BoolArray, tick: int) -> FloatArray:
    """Return what layers come to at `tick`, each over the lower by its share, (channels,).

    Args:
        ramps: Shape (layers, 2, 4, channels): of values and of shares, the fields of `Ramp`.
        adds: Where a layer leaves the lower ones as they are and adds to them, (layers, channels).
        tick: When.
    """
    merged = np.zeros(ramps.shape[3])
    for layer in range(ramps.shape[0]):
        value, share = ramps[layer, 0], ramps[layer, 1]
        for c in range(merged.shape[0]):
            weight = eased(share[0, c], share[1, c], share[2, c], share[3, c], tick)
            if weight != 0.0:
                held = eased(value[0, c], value[1, c], value[2, c], value[3, c], tick)
                below = merged[c] if adds[layer, c] else merged[c] * (1.0 - weight)
                merged[c] = below + held * weight
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
