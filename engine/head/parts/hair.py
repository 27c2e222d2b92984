"""Cropped hair."""

from __future__ import annotations

from ..head import DrawnSurface, Part


def hair_part(skin: DrawnSurface) -> list[Part]:
    """Return the cropped hair."""
    return []
