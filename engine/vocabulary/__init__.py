"""Words for faces: labels of published vocabularies, scores and coordinates, as action units."""

from __future__ import annotations

from .lexicon import Lexicon, lexicon
from .meaning import Meaning, Vocabulary
from .recipe import Recipe, Variant
from .resolve import (
    Part,
    Resolved,
    Turn,
    resolve_coordinates,
    resolve_label,
    resolve_scores,
)

__all__ = [
    "Lexicon",
    "Meaning",
    "Part",
    "Recipe",
    "Resolved",
    "Turn",
    "Variant",
    "Vocabulary",
    "lexicon",
    "resolve_coordinates",
    "resolve_label",
    "resolve_scores",
]
