"""What is counted while rows stream by: peaks, speeds, gaps, in memory that does not grow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray

LEAST_ROWS = 30
"""So many rows tell whether a unit is stuck: a second of most cameras'."""


@dataclass
class Gaps:
    """Rows that are missing between those that count.

    Attributes:
        max_gap: Seconds that are bridged.
        filled: Rows bridged.
        lost: Rows in longer gaps.
        count, longest: Of these longer gaps, s.
    """

    max_gap: float
    filled: int = 0
    lost: int = 0
    count: int = 0
    longest: float = 0.0
    _place: int = -1
    _time: float = 0.0

    def take(self, places: IntArray, times: FloatArray) -> None:
        """Take the rows that count: which of the face's they are, and when, shape (n,)."""
        if len(places) == 0:
            return
        runs = np.diff(places, prepend=self._place) - 1
        gaps = np.diff(times, prepend=self._time)
        long = gaps > self.max_gap
        self.filled += int(runs[~long].sum())
        self.lost += int(runs[long].sum())
        self.count += int(long.sum())
        self.longest = max(self.longest, float(gaps.max()))
        self._place, self._time = int(places[-1]), float(times[-1])

    def finish(self, places: int, end: float) -> None:
        """Take the end: how many rows the face has, and when the last one is."""
        runs, gap = places - 1 - self._place, end - self._time
        if runs > 0:
            self.filled += runs if gap <= self.max_gap else 0
            self.lost += runs if gap > self.max_gap else 0
            self.count += gap > self.max_gap
            self.longest = max(self.longest, gap)


class Peaks:
    """The least, the most and the fastest of signals.

    Attributes:
        rows: How many were taken.
        least, most: Shape (signals,).
        speed: Between two rows no further apart than a gap that is bridged, a second.
    """

    def __init__(self, signals: int, max_gap: float) -> None:
        self.rows = 0
        self.least, self.most = np.full(signals, np.inf), np.full(signals, -np.inf)
        self.speed = np.zeros(signals)
        self._max_gap = max_gap
        self._last: tuple[float, FloatArray] | None = None

    def take(self, times: FloatArray, values: FloatArray) -> None:
        """Take rows, shape (n,) and (n, signals)."""
        if len(times) == 0:
            return
        self.rows += len(times)
        self.least = np.minimum(self.least, values.min(axis=0))
        self.most = np.maximum(self.most, values.max(axis=0))
        if self._last is not None:
            times = np.concatenate([[self._last[0]], times])
            values = np.concatenate([self._last[1][None], values])
        steps = np.diff(times)
        near = (steps > 0.0) & (steps <= max(self._max_gap, 1e-9))
        if near.any():
            speeds = np.abs(np.diff(values, axis=0)[near]) / steps[near, None]
            self.speed = np.maximum(self.speed, speeds.max(axis=0))
        self._last = float(times[-1]), values[-1].copy()

    @property
    def stuck(self) -> list[bool]:
        """Whether each signal is the same in every row, and not 0."""
        if self.rows < LEAST_ROWS:
            return [False] * len(self.most)
        return [bool(m > 0.0 and m - n < 1e-9) for m, n in zip(self.most, self.least, strict=True)]
