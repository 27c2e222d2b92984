"""The slight difference of the two sides that every face has: seen, not simulated.

A few broad swells, drawn by the recipe's seed, move the drawn skin and the parts beside it by about
half a millimetre, and one side against the other: what both sides would share is left out. Lids
and lips, where skin touches, stay as they are; so do tissue, muscles and measurements.
Means of healthy faces lie between 0.5 and 1 mm (Ferrario et al. 2001; Djordjevic et al. 2014).
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..recipe import Recipe
from .fields import Anchors

SWELLS = 14
WIDTH_MM = (16.0, 34.0)
"""Standard deviation of the narrowest and the widest swell."""
MEAN_MM = 0.55
"""Mean length of the difference over the face at asymmetry 1."""
_BOX = np.array([[-70.0, -120.0, 10.0], [70.0, 60.0, 105.0]])
_STREAM = 0xA5
_MIRROR = np.array([-1.0, 1.0, 1.0])


def asymmetry_at(recipe: Recipe, points: FloatArray, anchors: Anchors) -> FloatArray:
    """Return how far points (k, 3) of the built-in head lie from where symmetry has them, mm."""
    if recipe.asymmetry == 0.0:
        return np.zeros_like(points)
    draw = np.random.default_rng((recipe.seed, _STREAM))
    middles = draw.uniform(_BOX[0], _BOX[1], (SWELLS, 3))
    widths = draw.uniform(*WIDTH_MM, SWELLS)
    pushes = draw.normal(size=(SWELLS, 3)) * [1.0, 1.0, 0.7]
    probe = _odd(np.array(list(anchors.values())), middles, widths, pushes)
    size = recipe.asymmetry * MEAN_MM / float(np.linalg.norm(probe, axis=1).mean())
    free = _free(points, anchors)[:, None]
    return np.asarray(size * free * _odd(points, middles, widths, pushes))


def _odd(
    points: FloatArray, middles: FloatArray, widths: FloatArray, pushes: FloatArray
) -> FloatArray:
    """Return the part of the swells that is opposite on the two sides, shape (k, 3)."""
    total = np.zeros_like(points)
    for middle, width, push in zip(middles, widths, pushes, strict=True):
        here = _swell(points, middle, width)
        image = _swell(points * _MIRROR, middle, width)
        total[:, 0] += 0.5 * (here + image) * push[0]
        total[:, 1:] += 0.5 * (here - image)[:, None] * push[1:]
    return total


def _swell(points: FloatArray, middle: FloatArray, width: float) -> FloatArray:
    away = points - middle
    return np.asarray(np.exp(-0.5 / width**2 * np.einsum("ka,ka->k", away, away)))


def _free(points: FloatArray, anchors: Anchors) -> FloatArray:
    """Return 0 at lids and lips to 1 away from them, shape (k,)."""
    side = np.abs(points[:, 0])
    folded = np.column_stack([side, points[:, 1:]])
    from_eye = np.linalg.norm(folded - anchors["eye"], axis=1)
    seam, corner = anchors["M0_0"], anchors["M1_5"]
    along = np.clip(side / corner[0], 0.0, 1.0)
    line = seam + (along**2)[:, None] * (corner - seam)
    line[:, 0] = np.minimum(side, corner[0])
    from_lips = np.linalg.norm(folded - line, axis=1)
    return np.asarray(_rise((from_eye - 18.0) / 22.0) * _rise((from_lips - 5.0) / 18.0))


def _rise(share: FloatArray) -> FloatArray:
    t = np.clip(share, 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))
