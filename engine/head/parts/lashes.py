"""The lashes: two short rows of curved hairs along the front edges of the lids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import FloatArray
from ..head import DrawnSurface, Part
from ..patches import EYE_CENTER
from .strands import Strands, strand_part

POINTS = 5
COLOR = np.array([0.030, 0.020, 0.015])


@dataclass(frozen=True)
class Row:
    """One lid's lashes: how many, how long and wide [mm], and +1 to curl up, -1 down."""

    count: int
    length: float
    width: float
    curl: int


UPPER = Row(count=96, length=6.2, width=0.17, curl=1)
LOWER = Row(count=38, length=2.9, width=0.11, curl=-1)

LENGTH_ALONG = ((0.0, 2.0, 5.0, 7.0, 8.0), (0.40, 0.75, 1.0, 1.0, 0.75))
"""Relative length by spoke from the inner corner (0) to the outer (8)."""


def lashes_part(skin: DrawnSurface, lid_edge: FloatArray) -> Part:
    """Return both eyes' lashes, riding the skin.

    Args:
        skin: The drawn skin.
        lid_edge: Front edge of the left lids by spoke [mm], shape (16, 3).
    """
    upper_edge = lid_edge[:9]
    lower_edge = lid_edge[[0, *range(15, 7, -1)]]
    sides = []
    for seed in (21, 22):
        noise = np.random.default_rng(seed)
        sides.append(_row(UPPER, upper_edge, noise) + _row(LOWER, lower_edge, noise))
    return strand_part("lashes", sides[0] + sides[1].reflected(), skin)


def _row(row: Row, edge: FloatArray, noise: np.random.Generator) -> Strands:
    jitter = noise.uniform(-0.35, 0.35, row.count)
    spoke = 0.8 + 7.1 * (np.arange(row.count) + jitter) / row.count
    root = np.asarray(CubicSpline(np.arange(9), edge)(spoke))
    outward = root - EYE_CENTER
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    fan = np.zeros((row.count, 3))
    fan[:, 0] = (root[:, 0] - 30) / 16 * 0.55
    length = row.length * np.interp(spoke, *LENGTH_ALONG) * noise.uniform(0.7, 1.12, row.count)

    # Lashes clump: neighbours lean to the same side, in threes.
    lean = np.repeat(noise.normal(0, 0.16, row.count // 3 + 1), 3)[: row.count]
    lean = lean + noise.normal(0, 0.06, row.count) - 0.12 * (np.arange(row.count) % 3 - 1)
    along = np.linspace(0, 1, POINTS)[None, :, None]
    rise = row.curl * (-0.14 * along + 0.66 * along**2)
    lines = outward[:, None] * along * (1 - 0.25 * along) * 0.85 + fan[:, None] * along
    lines = lines + rise * np.array([0.0, 1.0, 0.0])
    lines = lines + (lean[:, None, None] * along) * np.array([1.0, 0.0, 0.0])
    facing = np.array([0.0, 0.6 * row.curl, 0.8])
    return Strands(
        lines=root[:, None] + length[:, None, None] * lines,
        normals=np.broadcast_to(facing, (row.count, POINTS, 3)).copy(),
        width=row.width * noise.uniform(0.8, 1.15, row.count),
        colors=np.tile(COLOR, (row.count, 1)),
    )
