"""The eyebrows: hundreds of hairs a side, upright by the nose and swept outwards."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..hair_color import GRAY, brow_color
from ..head import DrawnSurface, Part
from ..recipe import STANDARD, Recipe
from .strands import FrontView, Strands, strand_part

HAIRS = 640
POINTS = 3
WIDTH = 0.165


class Shape(NamedTuple):
    """A brow in the front view at `SHARES` of the way outwards; all in mm, angles in degrees."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    width: tuple[float, ...]
    length: tuple[float, ...]


SHARES = (0.0, 0.12, 0.3, 0.55, 0.75, 0.9, 1.0)
# A man's brow is broad and lies flat on the orbit's rim; a woman's is finer, higher and arched.
MALE = Shape(
    x=(11.6, 16.4, 24.0, 35.0, 44.6, 51.4, 55.8),
    y=(15.6, 16.8, 18.6, 20.7, 21.0, 18.9, 15.4),
    width=(7.0, 8.6, 8.4, 7.2, 5.2, 3.4, 1.6),
    length=(6.6, 8.4, 9.6, 9.4, 8.6, 7.0, 5.0),
)
FEMALE = Shape(
    x=(13.4, 17.6, 24.6, 35.2, 44.4, 50.8, 55.0),
    y=(17.2, 18.4, 20.5, 23.4, 23.9, 21.4, 17.9),
    width=(5.2, 6.4, 6.2, 5.2, 4.0, 2.6, 1.1),
    length=(5.4, 6.8, 7.6, 7.2, 6.6, 5.4, 4.0),
)
LOWER_ANGLES = (96.0, 84.0, 62.0, 38.0, 14.0, -8.0, -22.0)
"""Which way the lowest hairs grow, by `SHARES`: 0 is outwards, 90 up, degrees."""
UPPER_ANGLES = (74.0, 40.0, 8.0, -10.0, -24.0, -36.0, -42.0)
"""Which way the topmost hairs grow."""
ARCH = 14.0
"""How far a hair bends towards the tail on its way, degrees."""
LIFT = 1.15
"""How far a hair's middle stands off the skin, mm."""
GRAY_LAG = 0.7
"""Brows grey later than the scalp."""


def brow_shape(recipe: Recipe = STANDARD) -> Shape:
    """Return the left brow of a recipe: by its sex, and sparser and lower in old age."""
    mixed = [
        tuple(float(f + recipe.sex * (m - f)) for f, m in zip(female, male, strict=True))
        for female, male in zip(FEMALE, MALE, strict=True)
    ]
    return Shape(*mixed)


def brow_line(
    share: FloatArray, recipe: Recipe = STANDARD
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return x, y of the left brow's middle line and its width [mm] at shares 0..1 outwards."""
    shape = brow_shape(recipe)
    return (
        np.interp(share, SHARES, shape.x),
        np.interp(share, SHARES, shape.y),
        np.interp(share, SHARES, shape.width),
    )


def brows_part(skin: DrawnSurface, recipe: Recipe = STANDARD) -> Part:
    """Return both brows, laid on the skin and riding it."""
    vertices = skin.vertices[skin.triangles].mean(axis=1)
    region = (vertices[:, 2] > 30) & (np.abs(vertices[:, 1] - 20) < 25)
    view = FrontView(skin, region)
    left = _left_brow(view, recipe, np.random.default_rng([7, recipe.seed]))
    # The right brow is laid on the mirrored skin with hairs of its own: nobody's brows are alike.
    right = _left_brow(view, recipe, np.random.default_rng([8, recipe.seed])).reflected()
    return strand_part("brows", left + right, skin, root_light=0.8)


def _left_brow(view: FrontView, recipe: Recipe, noise: np.random.Generator) -> Strands:
    shape = brow_shape(recipe)
    count = round(HAIRS * (0.85 + 0.15 * recipe.sex) * (1 - 0.3 * float(_elder(recipe))))
    share = noise.uniform(0, 1, count) ** 0.95
    # Densest a little under the middle line, thinning to both edges without one.
    across = np.clip(noise.normal(-0.05, 0.52, count), -1.25, 1.2)
    x, y, width = brow_line(share, recipe)
    # Few hairs at the head of the brow: it begins as a haze.
    kept = noise.uniform(size=count) < 0.35 + 0.65 * smoothstep(0.0, 0.16, share)
    start = np.column_stack(
        [x + noise.normal(0, 0.5, count), y + 0.5 * across * width + noise.normal(0, 0.25, count)]
    )
    height = np.clip(0.5 + 0.5 * across, 0, 1)
    lower, upper = (np.interp(share, SHARES, angles) for angles in (LOWER_ANGLES, UPPER_ANGLES))
    angle = lower + (upper - lower) * height + noise.normal(0, 9, count)
    length = np.interp(share, SHARES, shape.length) * noise.uniform(0.5, 1.05, count)
    length *= 1 - 0.25 * np.abs(across)

    along = np.linspace(0, 1, POINTS)
    turning = np.radians(angle[:, None] - ARCH * noise.uniform(0.4, 1.6, count)[:, None] * along)
    step = (length[:, None] * along)[..., None]
    flat = start[:, None, :] + step * np.stack([np.cos(turning), np.sin(turning)], axis=2)
    position, normal, hit = view.project(flat.reshape(-1, 2))
    complete = hit.reshape(count, POINTS).all(axis=1) & kept
    lift = LIFT * along * (1 - 0.55 * along) * noise.uniform(0.4, 1.3, count)[:, None]
    position = position.reshape(count, POINTS, 3) + normal.reshape(count, POINTS, 3) * (
        0.04 + lift[..., None]
    )
    thin = (1 - 0.35 * np.abs(across)) * (0.8 + 0.2 * smoothstep(0, 0.2, share))
    return Strands(
        lines=position[complete],
        normals=normal.reshape(count, POINTS, 3)[complete],
        width=(WIDTH * thin * noise.uniform(0.75, 1.25, count))[complete],
        colors=_colors(recipe, count, noise)[complete],
    )


def _colors(recipe: Recipe, count: int, noise: np.random.Generator) -> FloatArray:
    tone = np.exp(noise.normal(0, 0.28, count))[:, None]
    pigmented = brow_color(recipe) * tone
    gray = noise.uniform(size=count) < GRAY_LAG * recipe.grayness
    return np.where(gray[:, None], GRAY * tone**0.5, pigmented)


def _elder(recipe: Recipe) -> FloatArray:
    return np.asarray(smoothstep(55, 90, np.array(recipe.age)))
