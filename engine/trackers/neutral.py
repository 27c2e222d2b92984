"""A person's neutral face, taken off: trackers tell some intensity of a face at rest."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..errors import InvalidTrack

FULL = 0.98
"""A unit whose neutral is beyond this tells nothing: it is left at rest. Ours."""


class Neutral:
    """Finds the neutral face as it is asked for, while rows stream by."""

    def __init__(self, asked: float | tuple[int, int] | None) -> None:
        """Start with a quantile of the clip, the frames that show it, or None for no such face."""
        self._asked = asked
        self._times: tuple[float, float] | None = None

    def take(self, frames: FloatArray, times: FloatArray, counts: BoolArray) -> None:
        """Take rows: their frames' numbers, their times [s], and which of them count, (n,)."""
        if not isinstance(self._asked, tuple):
            return
        first, last = self._asked
        inside = times[counts & (frames >= first) & (frames <= last)]
        if len(inside):
            begin, end = self._times or (np.inf, -np.inf)
            self._times = min(begin, float(inside.min())), max(end, float(inside.max()))

    def found(
        self, intensities: FloatArray, seen: BoolArray, rate: int
    ) -> tuple[FloatArray, str | None]:
        """Return each unit's neutral, shape (units,), and how it was found.

        Args:
            intensities: Of a clip, shape (frames, units).
            seen: Which frames rows vouch for, shape (frames,).
            rate: Frames a second.

        Raises:
            InvalidTrack: If no row of the frames that should show it counts.
        """
        asked = self._asked
        if asked is None:
            return np.zeros(intensities.shape[1]), None
        if not isinstance(asked, tuple):
            return neutral_of(intensities, seen, asked), f"the clip's quantile {asked:g}"
        if self._times is None:
            raise InvalidTrack(
                f"no row of the frames {asked[0]} to {asked[1]} counts; name frames of the file "
                "on which the face is found and neutral"
            )
        first, last = (round(time * rate) for time in self._times)
        window = slice(min(first, len(intensities) - 1), last + 1)
        told = f"the median of the frames {asked[0]} to {asked[1]}"
        return neutral_of(intensities[window], seen[window], 0.5), told


def neutral_of(intensities: FloatArray, seen: BoolArray, quantile: float) -> FloatArray:
    """Return each unit's neutral, shape (units,): a quantile of the frames that rows vouch for.

    Args:
        intensities: Of a clip, shape (frames, units).
        seen: Which frames rows vouch for, shape (frames,).
        quantile: 0..1.
    """
    frames = intensities[seen] if seen.any() else intensities
    return np.asarray(np.quantile(frames, quantile, axis=0))


def without_neutral(intensities: FloatArray, neutral: FloatArray) -> FloatArray:
    """Return intensities of which 0 is neutral and 1 is still full, shape (frames, units)."""
    span = np.where(neutral < FULL, 1.0 - neutral, np.inf)
    return np.clip((intensities - neutral) / span, 0.0, None)
