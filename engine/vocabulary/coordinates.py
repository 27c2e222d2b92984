"""Faces for coordinates of feeling: the shares of the recipes that lie around a point."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray
from .recipe import Recipe

REACH = 1.6
"""Distance at which an anchor has no share any more; every point of the cube has one within it."""
SHARPNESS = 2.0
"""Power of nearness: how much of the face is that of the nearest anchor."""
_AT = 1e-9
"""Distance at which a point is the anchor itself."""


def dominance_with(valence: float, arousal: float, recipes: Iterable[Recipe]) -> float:
    """Return the dominance that goes with a point of the plane, -1..1, smooth in it.

    The mean of the anchors' by inverse squared distance on the plane, at an anchor its own.
    Happiness and surprise, fear and anger lie beside one another there and differ by it: with none,
    joy would be surprise.

    Args:
        valence: Pleasure, -1..1.
        arousal: -1..1.
        recipes: Those that are no anchors are left out.
    """
    places = np.array([recipe.place for recipe in recipes if recipe.anchor])
    away = np.linalg.norm(places[:, :2] - np.array([valence, arousal]), axis=1)
    nearest = int(away.argmin())
    if away[nearest] < _AT:
        return float(places[nearest, 2])
    # Taken by the nearest one's, so that no power overflows close to it.
    weights = (away[nearest] / away) ** 2.0
    return float(weights @ places[:, 2] / weights.sum())


def shares_around(point: FloatArray, recipes: Iterable[Recipe]) -> list[tuple[str, float]]:
    """Return the anchors near `point` with their shares, which add up to 1, greatest first.

    Inverse distance weighting with bounded reach (Shepard 1968; Franke and Nielson 1980): an
    anchor's own place gives its face alone, and shares change continuously in between. The face at
    rest is the anchor of the origin, so that intensity falls towards it.

    Args:
        point: Valence, arousal and dominance, -1..1, shape (3,).
        recipes: Those that are no anchors are left out.
    """
    anchors = [recipe for recipe in recipes if recipe.anchor]
    distances = np.array([float(np.linalg.norm(point - anchor.place)) for anchor in anchors])
    nearest = int(distances.argmin())
    if distances[nearest] < _AT:
        return [(anchors[nearest].name, 1.0)]
    # Taken by the nearest one's, so that no power overflows close to it.
    nearness = np.maximum(REACH - distances, 0.0) / distances
    weights = (nearness / nearness[nearest]) ** SHARPNESS
    weights /= weights.sum()
    pairs = [(a.name, float(w)) for a, w in zip(anchors, weights, strict=True) if w > 0.0]
    return sorted(pairs, key=lambda pair: -pair[1])
