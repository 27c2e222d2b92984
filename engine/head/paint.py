"""Paint: the colours of the skin at its vertices, made by the same functions as its texture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .hairline import scalp_cover
from .head import DrawnSurface
from .recipe import STANDARD, Recipe
from .textures.albedo import vertex_colors
from .textures.zones import Surface, zones_of

BALD_SHADE = 0.3
"""What of a shaven scalp's shade counts as hair, which keeps light off it."""


def painted(drawn: DrawnSurface, recipe: Recipe = STANDARD) -> DrawnSurface:
    """Return a drawn skin in a person's colours, and with the mask of where hair grows.

    They are seen until the texture is there, and on heads and in files that have none.

    Args:
        drawn: The skin; without places on the built-in head, its vertices are taken for those.
        recipe: The person.
    """
    placed = drawn if drawn.reference is not None else replace(drawn, reference=drawn.vertices)
    surface = Surface.of(placed)
    shade = BALD_SHADE if recipe.hair_style == "bald" else 1.0
    hair = np.where(surface.inside("ear"), 0.0, shade * scalp_cover(surface.places, recipe))
    colors = vertex_colors(zones_of(surface, recipe), surface.places, recipe)
    return replace(drawn, colors=colors, hair=hair)
