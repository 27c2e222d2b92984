"""How muscles, jaw, gaze and head follow their command: each with its own inertia and top speed."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray

ARRIVED = 1.0e-4
"""Distance, activation or degrees, at which a lagging channel takes its command's value."""


def lagged(
    signals: FloatArray, command: FloatArray, smoothing: FloatArray, stride: FloatArray
) -> FloatArray:
    """Return `signals` a tick on, by first-order lags, each no faster than it can.

    Args:
        signals: Activations, degrees and mm as they are, shape (…, channels).
        command: What they are asked to be, the same shape.
        smoothing: Share of the way that each goes in a tick, shape (channels,).
        stride: The most that each goes in a tick, shape (channels,).
    """
    gap = command - signals
    way = np.clip(smoothing * gap, -stride, stride)
    return np.where(np.abs(gap) < ARRIVED, command, signals + way)
