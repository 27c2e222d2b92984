"""The parts drawn beside the skin: eyes, teeth, tongue, brows, lashes, hair."""

from __future__ import annotations

from ...arrays import FloatArray
from ..head import DrawnSurface, Part
from ..recipe import STANDARD, Recipe
from .brows import brow_line, brows_part
from .caruncle import caruncle_parts
from .eyes import eye_parts, eyes_of
from .gums import gum_parts
from .hair import hair_parts
from .iris import eye_texture
from .lashes import lashes_part
from .palate import palate_parts
from .tear_line import tear_line_part
from .teeth import teeth_parts
from .tongue import tongue_part


def head_parts(
    skin: DrawnSurface, lid_edge: FloatArray, recipe: Recipe = STANDARD
) -> tuple[Part, ...]:
    """Return every part of the built-in head but its hair, fitted to its drawn skin.

    The eyes are not yet painted (`eyes_of`).

    Args:
        skin: The drawn skin.
        lid_edge: Front edge of the left lids by spoke [mm], shape (16, 3).
        recipe: Whose parts.
    """
    return (
        *eye_parts(),
        *caruncle_parts(lid_edge),
        tear_line_part(skin, lid_edge),
        *teeth_parts(recipe),
        *gum_parts(),
        *palate_parts(),
        tongue_part(),
    )


__all__ = [
    "brow_line",
    "brows_part",
    "eye_texture",
    "eyes_of",
    "hair_parts",
    "head_parts",
    "lashes_part",
]
