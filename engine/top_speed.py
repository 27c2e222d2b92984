"""How fast tissue may go: no command moves a point of a face faster than a face can.

Muscles, lids and jaw have their own top rates (`rates`). This holds what these leave: muscles that
pull against each other with more than they have, between which a lip jumps or buzzes.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from .arrays import Float32Array, FloatArray
from .timeline import TICKS_PER_SECOND

Points = TypeVar("Points", FloatArray, Float32Array)

FASTEST = 500.0
"""mm/s: no point of the tissue goes faster. It is ours: lids at a quick blink and the quickest lips
and jaws go 200 to 400 mm/s, so that only commands beyond what a face does come up to it."""
LEAP = FASTEST / TICKS_PER_SECOND
"""mm that a point goes in a tick at most."""
ALONG_AN_AXIS = LEAP / np.sqrt(3.0)
"""mm: a point that went less along every axis has gone less than `LEAP`."""


def held_back(x: Points, v: Points, before: Points) -> tuple[Points, Points]:
    """Return positions and velocities after a tick with no point farther on than `LEAP`.

    Args:
        x: Positions, mm, shape (3, nodes).
        v: Velocities, mm/s, the same shape.
        before: Positions before the tick, the same shape.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # A face that is lost is told elsewhere.
        way = x - before
        shares = _shares(way, LEAP)
        return np.where(shares < 1.0, before + way * shares, x), v * _shares(v, FASTEST)


def _shares(ways: Points, most: float) -> Points:
    """Return the factors that shorten each of `ways`, shape (3, n), to `most`, shape (n,)."""
    lengths = np.sqrt((ways * ways).sum(axis=0))
    shares: Points = np.minimum(1.0, most / np.maximum(lengths, most))
    return shares
