"""The parts drawn beside the skin: eyes, teeth, tongue, ears, brows, lashes, hair."""

from __future__ import annotations

from ..head import DrawnSurface, Part


def head_parts(skin: DrawnSurface) -> tuple[Part, ...]:
    """Return every part of the built-in head, fitted to its drawn skin."""
    return ()


__all__ = ["head_parts"]
