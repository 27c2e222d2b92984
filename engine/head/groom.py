"""A head's hair by recipe: scalp hair, brows and lashes, and the shade of the scalp."""

from __future__ import annotations

from dataclasses import replace

from ..cache import Arrays, cached_arrays
from .head import Head, Part
from .parts import brows_part, hair_parts, lashes_part
from .recipe import Recipe
from .storage import source_key

GROOMED = ("brows", "lashes", "hairline", "baby_hairs", "hair", "flyaways")
"""Parts of a head that are its hair; those that ride the skin come first."""
RIDING = GROOMED[:4]
FIELDS = ("sex", "age", "hair_style", "hair_color", "grayness", "seed")
"""What of a recipe hair depends on."""
_ARRAYS = ("vertices", "normals", "triangles", "colors", "roots", "uvs")


def groomed(head: Head, level: str, recipe: Recipe) -> Head:
    """Return the built-in head with the hair of a recipe, not yet warped.

    Args:
        head: The built-in head.
        level: Its level of detail.
        recipe: Whose hair.
    """
    key = source_key(f"{level}-{[getattr(recipe, field) for field in FIELDS]}")
    arrays = cached_arrays("groom", key, lambda: _to_arrays(_grown(head, recipe)))
    others = [part for part in head.parts if part.name not in GROOMED]
    return replace(head, parts=(*others, *_from_arrays(arrays)))


def _grown(head: Head, recipe: Recipe) -> list[Part]:
    lid_edge = head.points[[head.point(f"E1_{spoke}.L") for spoke in range(16)]]
    return [
        brows_part(head.drawn, recipe),
        lashes_part(head.drawn, lid_edge, recipe),
        *hair_parts(head.drawn, recipe),
    ]


def _to_arrays(parts: list[Part]) -> Arrays:
    return {
        f"{part.name}.{name}": getattr(part, name)
        for part in parts
        for name in _ARRAYS
        if getattr(part, name) is not None
    }


def _from_arrays(arrays: Arrays) -> list[Part]:
    return [
        Part(
            name,
            material="hair",
            follows="skin" if name in RIDING else "skull",
            **{key: arrays[f"{name}.{key}"] for key in _ARRAYS if f"{name}.{key}" in arrays},
        )
        for name in GROOMED
        if f"{name}.vertices" in arrays
    ]
