"""Where scalp hair grows: inside an outline drawn on the head's profile, thinner with age."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray
from .anatomy import smoothstep
from .noise import noise
from .recipe import STANDARD, Recipe

# The hairline in the profile plane as (z, y), mm: forehead, temple, sideburn, round the ear, nape;
# closed far outside the head. All three go through the same stations, so they can be blended.
_BEHIND = (
    (4, 9), (-5, 17), (-18, 18), (-31, 10), (-38, -6), (-42, -28), (-46, -52), (-54, -72),
    (-75, -86), (-120, -88), (-120, 140), (110, 140),
)  # fmt: skip
FEMALE_OUTLINE = np.array([
    (101, 73.5), (88, 73), (80, 72.5), (71, 71.5), (63, 68.5), (57, 61), (53, 51), (49, 42),
    (44, 34), (36, 25), (27, 14), (20, 3), (15, -6), (11, -13), (10, -15), (9.5, -10),
    (8, -3), *_BEHIND,
], dtype=float)  # fmt: skip
MALE_OUTLINE = np.array([
    (101, 73.5), (88, 73.5), (80, 75.5), (70, 78), (62, 76), (56, 66), (51.5, 55), (47, 44),
    (43, 35), (35, 26), (27, 15), (21, 2), (18, -10), (16, -23), (13, -29), (11, -22),
    (9, -6), *_BEHIND,
], dtype=float)  # fmt: skip
RECEDED_OUTLINE = np.array([
    (101, 90), (78, 90), (66, 93), (54, 96), (44, 94), (40, 84), (43, 66), (44, 50), (41, 38),
    (34, 27), (26, 15), (20, 2), (17, -10), (16, -23), (13, -29), (11, -22),
    (9, -6), *_BEHIND,
], dtype=float)  # fmt: skip
FADE = (-5.0, 9.0)
"""Distance inside the outline [mm] over which hair grows from none to full."""
COVER_FADE = (-3.0, 8.0)
"""The same for the scalp's shade, which lies deeper in, so that no edge of paint shows."""
NAPE_TAPER = 0.5
"""How much farther in than elsewhere hair is full there."""
Unevenness = tuple[tuple[float, int, float], ...]
EDGE_NOISE: Unevenness = ((14.0, 6, 2.1), (5.0, 5, 1.5), (2.2, 7, 1.0))
"""Unevenness of the outline: size of its blobs [mm], seed, depth [mm]."""
COVER_NOISE: Unevenness = ((14.0, 6, 1.0),)
"""The same for the scalp's shade: it is known at vertices, up to nine millimetres apart, between
which what is finer or deeper comes out as steps and spikes."""

AT_ONCE = 1024
"""Points that are held against every side of the outline at once: what a cache has room for."""

RECESSION_BY_AGE = ((18, 25, 45, 65, 90), (0.0, 0.04, 0.16, 0.3, 0.4))
"""How far towards `RECEDED_OUTLINE` a man's hairline has gone (Norwood II to III by fifty)."""
RECEDING = 0.62
"""The same with the style "receding", at least."""
CROWN = np.array([0.0, 106.0, -46.0])
CROWN_BALD = (24.0, 58.0)
"""A receding head is bare this near to its crown, and full so far away, mm."""

STYLE_COVER = {"bald": 0.34, "buzz": 0.95}
"""How dark the scalp is shaded where hair is cut off; elsewhere it is hidden."""
HIDDEN_SCALP = 0.94


def hair_mask(points: FloatArray, recipe: Recipe = STANDARD) -> FloatArray:
    """Return how densely hair grows at points (n, 3) of reference space, 0..1, shape (n,)."""
    return np.asarray(
        smoothstep(*FADE, _distance(points, recipe, EDGE_NOISE)) * _thinning(points, recipe)
    )


def scalp_cover(points: FloatArray, recipe: Recipe = STANDARD) -> FloatArray:
    """Return how far hair and its roots hide the skin's own colour at points (n, 3), 0..1.

    The scalp is to be painted so far towards `engine.head.hair_color.scalp_color`.
    """
    inside = _distance(points, recipe, COVER_NOISE)
    grown = smoothstep(*COVER_FADE, inside) * _thinning(points, recipe)
    # The nape and the sideburns are cut shortest, and skin shows through.
    shorn = 1 - 0.35 * smoothstep(-10, -70, points[:, 1])
    cover = STYLE_COVER.get(recipe.hair_style, HIDDEN_SCALP)
    return np.asarray(cover * grown * (shorn if recipe.hair_style not in ("bob", "curly") else 1))


def recession(recipe: Recipe) -> float:
    """Return how far the hairline has gone back, 0 to 1."""
    usual = recipe.sex * float(np.interp(recipe.age, *RECESSION_BY_AGE))
    return max(usual, RECEDING) if recipe.hair_style == "receding" else usual


def outline(recipe: Recipe) -> FloatArray:
    """Return the hairline in the profile plane as (z, y) [mm], closed, shape (k, 2)."""
    grown = FEMALE_OUTLINE + recipe.sex * (MALE_OUTLINE - FEMALE_OUTLINE)
    return np.asarray(grown + recession(recipe) * (RECEDED_OUTLINE - grown))


def _distance(points: FloatArray, recipe: Recipe, uneven: Unevenness) -> FloatArray:
    """Return how far inside the uneven hairline points (n, 3) lie [mm], shape (n,)."""
    distance = distance_inside(points[:, [2, 1]], outline(recipe))
    # At the nape hair tapers off over a longer way.
    distance *= 1 - NAPE_TAPER * smoothstep(-15, -55, points[:, 1])
    for size, seed, depth in uneven:
        distance += depth * noise(points, size, seed + recipe.seed)
    return distance


def _thinning(points: FloatArray, recipe: Recipe) -> FloatArray:
    """Return the share of hair that is left at points (n, 3), shape (n,)."""
    left = np.ones(len(points))
    if recipe.hair_style == "receding":
        bare = smoothstep(*CROWN_BALD, np.linalg.norm(points - CROWN, axis=1))
        top = smoothstep(62, 95, points[:, 1])
        left *= (0.1 + 0.9 * bare) * (1 - 0.45 * top)
    elder = smoothstep(50, 90, np.array(recipe.age)) * (0.25 + 0.25 * recipe.sex)
    return np.asarray(left * (1 - float(elder) * smoothstep(60, 100, points[:, 1])))


def distance_inside(points: FloatArray, outline: FloatArray) -> FloatArray:
    """Return the distance from points (n, 2) to a closed outline (k, 2), negative outside."""
    found = np.empty(len(points))
    for start in range(0, len(points), AT_ONCE):
        chosen = slice(start, start + AT_ONCE)
        gap = _gap(points[chosen], outline)
        found[chosen] = np.where(inside_outline(points[chosen], outline), gap, -gap)
    return found


def _gap(points: FloatArray, outline: FloatArray) -> FloatArray:
    """Return the distance from points (n, 2) to the nearest side of an outline (k, 2)."""
    side = np.roll(outline, -1, axis=0) - outline
    offset_z, offset_y = (np.subtract.outer(points[:, a], outline[:, a]) for a in range(2))
    share = offset_z * side[:, 0] + offset_y * side[:, 1]
    share = np.clip(share / (side**2).sum(axis=1), 0, 1)
    square = (offset_z - share * side[:, 0]) ** 2 + (offset_y - share * side[:, 1]) ** 2
    return np.asarray(np.sqrt(square.min(axis=1)))


def inside_outline(points: FloatArray, outline: FloatArray) -> BoolArray:
    """Return which points (n, 2) lie inside a closed outline (k, 2): an odd number of crossings."""
    x, y = points[:, :1], points[:, 1:]
    (x1, y1), (x2, y2) = outline.T, np.roll(outline, -1, axis=0).T
    spans = (y1 > y) != (y2 > y)
    rise = np.where(y2 == y1, 1.0, y2 - y1)
    crossing = x1 + (y - y1) * (x2 - x1) / rise
    return np.asarray((spans & (x < crossing)).sum(axis=1) % 2 == 1)
