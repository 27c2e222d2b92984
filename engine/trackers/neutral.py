"""A person's neutral face, taken off: trackers tell some intensity of a face at rest."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray

FULL = 0.98
"""A unit whose neutral is beyond this tells nothing: it is left at rest. Ours."""


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
