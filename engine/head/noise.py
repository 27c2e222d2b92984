"""Smooth noise in space: it does not follow the mesh, so it does not streak."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..arrays import FloatArray
from ..compiling import kept

LATTICE = 40


def noise(points: FloatArray, size: float, seed: int) -> FloatArray:
    """Return noise of deviation about 0.5 and blobs of `size` mm at points (n, 3), shape (n,)."""
    from scipy.ndimage import map_coordinates  # Here: a start does without.

    places = (points / size).T
    return np.asarray(
        map_coordinates(_spline(seed), places, order=3, mode="grid-wrap", prefilter=False)
    )


@lru_cache(maxsize=8)
def _spline(seed: int) -> FloatArray:
    """Return the coefficients of a seed's splines, half a megabyte; a few take turns."""
    from scipy.ndimage import spline_filter

    values = np.random.default_rng(seed).normal(size=(LATTICE, LATTICE, LATTICE))
    return np.asarray(spline_filter(values, order=3, mode="grid-wrap"))


@kept(nogil=True)
def hashed(x: int, y: int, z: int, seed: int) -> float:
    """Return a number in 0..1 that cell (x, y, z) always gets for one seed."""
    h = np.uint32(x) * np.uint32(0x8DA6B343)
    h ^= np.uint32(y) * np.uint32(0xD8163841)
    h ^= np.uint32(z) * np.uint32(0xCB1AB31F)
    h ^= np.uint32(seed) * np.uint32(0x9E3779B1)
    h ^= h >> np.uint32(15)
    h = np.uint32(h * np.uint32(0x2C1B3C6D))
    h ^= h >> np.uint32(12)
    h = np.uint32(h * np.uint32(0x297A2D39))
    h ^= h >> np.uint32(15)
    return float(h) * 2.3283064365386963e-10


@kept(nogil=True)
def value_noise(x: float, y: float, z: float, seed: int) -> float:
    """Return smooth noise in -1..1 with blobs of about one unit (quintic value noise)."""
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    u, v, w = x - i, y - j, z - k
    u = u * u * u * (u * (u * 6 - 15) + 10)
    v = v * v * v * (v * (v * 6 - 15) + 10)
    w = w * w * w * (w * (w * 6 - 15) + 10)
    low0 = hashed(i, j, k, seed) + u * (hashed(i + 1, j, k, seed) - hashed(i, j, k, seed))
    low1 = hashed(i, j + 1, k, seed)
    low1 += u * (hashed(i + 1, j + 1, k, seed) - low1)
    high0 = hashed(i, j, k + 1, seed)
    high0 += u * (hashed(i + 1, j, k + 1, seed) - high0)
    high1 = hashed(i, j + 1, k + 1, seed)
    high1 += u * (hashed(i + 1, j + 1, k + 1, seed) - high1)
    low = low0 + v * (low1 - low0)
    high = high0 + v * (high1 - high0)
    return 2 * (low + w * (high - low)) - 1


@kept(nogil=True)
def spot_noise(
    x: float, y: float, z: float, chance: float, least: float, most: float, seed: int
) -> float:
    """Return how deep a point lies inside the nearest of scattered balls: 1 middle, 0 outside.

    Each unit cell holds a ball with probability `chance`; radii lie between `least` and `most`
    (below 1), small ones being the more frequent.
    """
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    best = 0.0
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                a, b, c = i + di, j + dj, k + dk
                if hashed(a, b, c, seed) >= chance:
                    continue
                size = hashed(a, b, c, seed + 1)
                radius = least + (most - least) * size * size
                dx = a + hashed(a, b, c, seed + 2) - x
                dy = b + hashed(a, b, c, seed + 3) - y
                dz = c + hashed(a, b, c, seed + 4) - z
                inside = 1 - (dx * dx + dy * dy + dz * dz) / (radius * radius)
                if inside > best:
                    best = inside
    return best


@kept(nogil=True)
def cell_edges(x: float, y: float, z: float, seed: int) -> float:
    """Return the distance to the border between the two nearest scattered points (Worley 1996)."""
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    first, second = 9.0, 9.0
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                a, b, c = i + di, j + dj, k + dk
                dx = a + hashed(a, b, c, seed) - x
                dy = b + hashed(a, b, c, seed + 1) - y
                dz = c + hashed(a, b, c, seed + 2) - z
                square = dx * dx + dy * dy + dz * dz
                if square < first:
                    first, second = square, first
                elif square < second:
                    second = square
    return float(np.sqrt(second) - np.sqrt(first))
