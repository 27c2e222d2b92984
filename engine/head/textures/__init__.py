"""Textures: a person's skin up close, baked from functions over the built-in head."""

from __future__ import annotations

from .bake import TEXTURE_NAMES, head_textures

__all__ = ["TEXTURE_NAMES", "head_textures"]
