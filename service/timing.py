"""How long things take: a histogram since the start, and quantiles of the latest ones."""

from __future__ import annotations

from bisect import bisect_left
from collections import deque
from itertools import accumulate

import numpy as np

BOUNDS = (
    0.0001,
    0.0002,
    0.0005,
    0.001,
    0.002,
    0.003,
    0.004,
    0.005,
    0.006,
    0.008,
    0.01,
    0.012,
    0.0142,
    0.0167,
    0.02,
    0.025,
    0.0333,
    0.05,
    0.1,
    0.25,
    1.0,
)
"""Upper ends of the histogram's buckets [s]: finest around a tick, 0.0167, and its usual share."""
_LATEST = 3600
"""Times that the quantiles are of: a minute of ticks."""


class Times:
    """Durations of one kind; one thread adds, any thread reads."""

    def __init__(self) -> None:
        self.total = 0.0
        self._counts = [0] * (len(BOUNDS) + 1)
        self._latest: deque[float] = deque(maxlen=_LATEST)

    def add(self, seconds: float) -> None:
        """Note one duration [s]."""
        self.total += seconds
        self._counts[bisect_left(BOUNDS, seconds)] += 1
        self._latest.append(seconds)

    @property
    def count(self) -> int:
        """How many were noted."""
        return sum(self._counts)

    def quantile(self, share: float) -> float:
        """Return the duration [s] that `share` of the latest ones did not exceed; 0 of none."""
        return self.quantiles(share)[0]

    def quantiles(self, *shares: float) -> list[float]:
        """Return the durations [s] that shares of the latest ones did not exceed; 0 of none.

        They are put in order once, and by numpy: live ticks wait for whoever asks meanwhile.
        """
        ordered = np.sort(np.array(self._copy()))
        count = len(ordered)
        return [float(ordered[min(count - 1, int(s * count))]) if count else 0.0 for s in shares]

    def buckets(self) -> list[tuple[str, float]]:
        """Return the upper end of each bucket and the count up to it, as Prometheus has them."""
        ends = [*(repr(bound) for bound in BOUNDS), "+Inf"]
        return list(zip(ends, map(float, accumulate(self._counts)), strict=True))

    def _copy(self) -> list[float]:
        while True:
            try:
                return list(self._latest)
            except RuntimeError:  # The other thread added one meanwhile.
                continue


def quantile_of(buckets: list[tuple[float, float]], share: float) -> float:
    """Return a quantile [s] of a histogram, by a straight line within its bucket.

    Args:
        buckets: Upper end [s] and count up to it, in order; the last end may be infinite.
        share: Of the counts, 0 to 1.
    """
    if not buckets or buckets[-1][1] <= 0:
        return 0.0
    wanted, below, start = share * buckets[-1][1], 0.0, 0.0
    for end, count in buckets:
        if count >= wanted and count > below:
            if end == float("inf"):
                return start
            return start + (end - start) * (wanted - below) / (count - below)
        below, start = count, end
    return start
