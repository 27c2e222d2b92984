"""Rows at any times onto an even grid of frames, on the fly; gaps bridged, or rested in."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray

RELAX = 0.3
"""Seconds in which a face that is lost goes to rest, and comes back. Ours: about an onset."""


class Resampler:
    """Takes rows with their times and gives frames at an even rate, each once.

    Attributes:
        count: Frames given so far.
    """

    def __init__(self, rate: int, most: int, max_gap: float, resting: BoolArray) -> None:
        """Start at 0 s.

        Args:
            rate: Frames a second.
            most: Frames that are given at most.
            max_gap: Seconds between rows that are bridged in a straight line.
            resting: Which signals go to 0 where the face is lost; the others stay, (signals,).
        """
        self._rate, self._most, self._max_gap, self._resting = rate, most, max_gap, resting
        self._time = 0.0
        self._value: FloatArray | None = None
        self.count = 0

    def frames(self, times: FloatArray, values: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return the frames up to the last of some rows, and which of them a row vouches for.

        Args:
            times: Seconds, rising, shape (n,).
            values: Shape (n, signals).
        """
        knots, points, seen = [self._time], [self._value], [True]
        if self._value is None and len(times):
            lost = times[0] > self._max_gap
            points = [self._rest(values[0]) if lost else values[0]]
        for time, value in zip(times, values, strict=True):
            gap = time - knots[-1]
            if gap > self._max_gap:
                relax = min(RELAX, gap / 2.0)
                knots += [knots[-1] + relax, time - relax]
                points += [self._rest(points[-1]), self._rest(value)]
                seen += [False, False]
            knots.append(float(time))
            points.append(value)
            seen.append(True)
        self._time, self._value = knots[-1], points[-1]
        return self._between(knots, points, seen)

    def finish(self, end: float) -> tuple[FloatArray, BoolArray]:
        """Return the frames up to the end, where rows without a face are the last."""
        if self._value is None or end <= self._time:
            return np.zeros((0, len(self._resting))), np.zeros(0, dtype=bool)
        lost = end - self._time > self._max_gap
        value = self._rest(self._value) if lost else self._value
        relaxed = self._time + min(RELAX, end - self._time)
        knots, points = [self._time, relaxed, end], [self._value, value, value]
        self._time, self._value = end, value
        return self._between(knots, points, [True, not lost, not lost])

    def _between(
        self, knots: list[float], points: Sequence[FloatArray | None], seen: list[bool]
    ) -> tuple[FloatArray, BoolArray]:
        """Return the frames that are due by the last knot, on straight lines between them."""
        last = min(math.floor(min(knots[-1], 1e9) * self._rate + 1e-6), self._most - 1)
        if last < self.count or (len(knots) < 2 and self.count):
            return np.zeros((0, len(self._resting))), np.zeros(0, dtype=bool)
        at = np.arange(self.count, last + 1) / self._rate
        table, axis = np.array(points), np.array(knots)
        frames = np.stack([np.interp(at, axis, signal) for signal in table.T], axis=1)
        after = np.clip(np.searchsorted(axis, at - 1e-9), 1, len(axis) - 1)
        vouched = np.array(seen)[after] & np.array(seen)[after - 1]
        self.count = last + 1
        return frames, vouched

    def _rest(self, value: FloatArray | None) -> FloatArray:
        return np.where(self._resting, 0.0, 0.0 if value is None else value)
