"""Heads: the built-in one, the paper's, and those read from files."""

from __future__ import annotations

from .head import (
    BULGE_HEIGHT,
    BULGE_POWER,
    BULGE_RADIUS,
    LID_GAP,
    DrawnSurface,
    Eye,
    Head,
    LidContact,
    Part,
)
from .identity import Person, muscle_strength, people, tissue_of_life
from .mesh import head_from_mesh, read_head
from .recipe import STANDARD, Recipe, recipe_attributes
from .skin import LEVELS
from .standard import paper_head, person_head, reference_head, standard_head

__all__ = [
    "BULGE_HEIGHT",
    "BULGE_POWER",
    "BULGE_RADIUS",
    "LEVELS",
    "LID_GAP",
    "STANDARD",
    "DrawnSurface",
    "Eye",
    "Head",
    "LidContact",
    "Part",
    "Person",
    "Recipe",
    "head_from_mesh",
    "muscle_strength",
    "paper_head",
    "people",
    "person_head",
    "read_head",
    "recipe_attributes",
    "reference_head",
    "standard_head",
    "tissue_of_life",
]
