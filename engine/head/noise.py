"""Smooth noise in space: it does not follow the mesh, so it does not streak."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import map_coordinates

from ..arrays import FloatArray

LATTICE = 40


def noise(points: FloatArray, size: float, seed: int) -> FloatArray:
    """Return noise of deviation about 0.5 and blobs of `size` mm at points (n, 3), shape (n,)."""
    values = np.random.default_rng(seed).normal(size=(LATTICE, LATTICE, LATTICE))
    return np.asarray(map_coordinates(values, (points / size).T, order=3, mode="grid-wrap"))
