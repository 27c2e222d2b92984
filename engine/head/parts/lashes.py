"""The lashes: two rows of curved hairs along the front edges of the lids, in small clumps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ..hair_color import brow_color
from ..head import DrawnSurface, Part
from ..patches import EYE_CENTER
from ..recipe import STANDARD, Recipe
from .strands import Strands, strand_part

POINTS = 5
DARKENING = 0.55
"""Lashes are darker than brows."""
FEMALE_LENGTH = 1.16
"""A woman's lashes, of a man's length, groomed."""


@dataclass(frozen=True)
class Row:
    """One lid's lashes.

    Attributes:
        count: How many.
        length: Of the longest [mm].
        width: At the root [mm].
        forward: How far they reach out of the lid before they curl, of their length.
        dip: How far they first lean against their curl, of their length.
        curl: How far the tips go up, or down if negative, of their length.
        clump: How many grow towards one another.
    """

    count: int
    length: float
    width: float
    forward: float
    dip: float
    curl: float
    clump: int


UPPER = Row(count=128, length=8.4, width=0.165, forward=0.80, dip=-0.16, curl=0.74, clump=4)
LOWER = Row(count=58, length=4.8, width=0.1, forward=0.62, dip=0.0, curl=-0.60, clump=3)

LENGTH_ALONG = ((0.0, 1.0, 2.5, 5.0, 7.0, 8.0), (0.40, 0.55, 0.82, 1.0, 1.0, 0.78))
"""Relative length by spoke from the inner corner (0) to the outer (8)."""
FAN = ((0.0, 2.0, 4.0, 6.0, 8.0), (-0.36, -0.14, 0.06, 0.34, 0.62))
"""How far lashes lean outwards, of their length, by spoke."""
GATHER = 0.6
"""How near the tips of a clump come to one another, of the way."""


def lashes_part(skin: DrawnSurface, lid_edge: FloatArray, recipe: Recipe = STANDARD) -> Part:
    """Return both eyes' lashes, riding the skin.

    Args:
        skin: The drawn skin.
        lid_edge: Front edge of the left lids by spoke [mm], shape (16, 3).
        recipe: Whose lashes.
    """
    upper_edge = lid_edge[:9]
    lower_edge = lid_edge[[0, *range(15, 7, -1)]]
    longer = FEMALE_LENGTH + recipe.sex * (1 - FEMALE_LENGTH)
    color = DARKENING * brow_color(recipe)
    sides = []
    for seed in (21, 22):
        noise = np.random.default_rng([seed, recipe.seed])
        rows = [
            _row(row, edge, longer, color, noise)
            for row, edge in ((UPPER, upper_edge), (LOWER, lower_edge))
        ]
        sides.append(rows[0] + rows[1])
    return strand_part("lashes", sides[0] + sides[1].reflected(), skin)


def _row(
    row: Row, edge: FloatArray, longer: float, color: FloatArray, noise: np.random.Generator
) -> Strands:
    from scipy.interpolate import CubicSpline  # Here: a start does without.

    jitter = noise.uniform(-0.45, 0.45, row.count)
    spoke = 0.7 + 7.2 * (np.arange(row.count) + jitter) / row.count
    root = np.asarray(CubicSpline(np.arange(9), edge)(spoke))
    outward = root - EYE_CENTER
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    # Two or three rows deep: roots stand a little before and behind the edge.
    root = root + outward * noise.uniform(-0.1, 0.12, row.count)[:, None]
    length = row.length * longer * np.interp(spoke, *LENGTH_ALONG)
    length *= noise.uniform(0.62, 1.08, row.count)

    clump = np.arange(row.count) // row.clump
    middle = np.bincount(clump, spoke) / np.bincount(clump)
    sideways = np.interp(spoke, *FAN) + noise.normal(0, 0.05, row.count)
    sideways += GATHER * (middle[clump] - spoke) * 3.6 / length
    sideways += noise.normal(0, 0.07, len(middle))[clump]
    curl = row.curl * noise.uniform(0.8, 1.15, row.count)

    along = np.linspace(0, 1, POINTS)[None, :, None]
    lines = row.forward * outward[:, None] * along * (1 - 0.22 * along)
    up = row.dip * along * (1 - along) * 2 + curl[:, None, None] * along**1.9
    lines = lines + up * np.array([0.0, 1.0, 0.0])
    lines = lines + sideways[:, None, None] * along**1.1 * np.array([1.0, 0.0, -0.25])
    facing = np.array([0.0, 0.6 * np.sign(row.curl), 0.8])
    shade = noise.uniform(0.7, 1.3, row.count)[:, None]
    return Strands(
        lines=root[:, None] + length[:, None, None] * lines,
        normals=np.broadcast_to(facing, (row.count, POINTS, 3)).copy(),
        width=row.width * noise.uniform(0.8, 1.15, row.count),
        colors=shade * color,
    )
