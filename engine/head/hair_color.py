"""Colours of hair by recipe: of one hair, of many that differ, of brows, of the shaded scalp.

Linear RGB. Melanin never makes black: the darkest hair still reflects about a hundredth.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..arrays import FloatArray
from .recipe import STANDARD, Recipe

NATURAL: Mapping[str, tuple[float, float, float]] = {
    "black": (0.0155, 0.0125, 0.0115),
    "dark_brown": (0.056, 0.032, 0.0195),
    "brown": (0.105, 0.060, 0.034),
    "auburn": (0.120, 0.043, 0.021),
    "red": (0.265, 0.090, 0.030),
    "dark_blond": (0.215, 0.138, 0.076),
    "blond": (0.420, 0.292, 0.160),
    "gray": (0.270, 0.265, 0.260),
    "white": (0.600, 0.590, 0.565),
}
GRAY = np.array([0.43, 0.43, 0.43])
"""A hair without pigment among others, in shade of its neighbours."""
GRAY_AMONG = 1.6
"""A clump looks greyed by this power of its share of grey hairs: few of them hide in the shade."""
SHORN = ("bald", "buzz", "receding")
"""Styles through which light reaches the scalp; under all others, of it:"""
UNDER_LONG_HAIR = 0.4
DARKEST_BROW = 0.30
"""Brows and lashes of fair people are darker than their hair, towards this share of it."""


def hair_color(recipe: Recipe = STANDARD) -> FloatArray:
    """Return the mean colour of the scalp's hair, greyed, shape (3,)."""
    natural = np.array(NATURAL[recipe.hair_color])
    return np.asarray(natural + recipe.grayness * (GRAY - natural))


def scalp_color(recipe: Recipe = STANDARD) -> FloatArray:
    """Return what the scalp is shaded with under hair: roots in each other's shadow, shape (3,)."""
    shade = 1.0 if recipe.hair_style in SHORN else UNDER_LONG_HAIR
    return np.asarray(hair_color(recipe) * shade * np.array([0.62, 0.58, 0.56]))


def strand_colors(
    recipe: Recipe,
    count: int,
    noise: np.random.Generator,
    *,
    spread: float = 1.0,
    tone: float = 0.20,
) -> FloatArray:
    """Return the colours of `count` strands, shape (count, 3).

    Args:
        recipe: Whose hair.
        count: How many.
        noise: Where the differences come from.
        spread: 1 for single hairs, which are grey or not; less for clumps, which mix.
        tone: How much hairs differ in brightness.
    """
    natural = np.array(NATURAL[recipe.hair_color])
    shade = np.exp(noise.normal(0, tone, count))[:, None]
    warmth = 1 + np.outer(noise.normal(0, 0.06, count), [1.0, 0.1, -0.9])
    single = (noise.uniform(size=count) < recipe.grayness).astype(float)
    among = recipe.grayness**GRAY_AMONG
    grey = among + spread * (single - among)
    pigmented = natural * shade * warmth
    return np.asarray(pigmented + grey[:, None] * (GRAY * shade**0.5 - pigmented))


def brow_color(recipe: Recipe = STANDARD) -> FloatArray:
    """Return the natural colour of brows, shape (3,): darker than fair hair."""
    natural = np.array(NATURAL[recipe.hair_color])
    light = float(natural.mean())
    darker = np.interp(light, (0.015, 0.035, 0.06, 0.3), (1.0, 0.75, 0.65, DARKEST_BROW))
    return np.asarray(np.maximum(natural * darker, NATURAL["black"]))
