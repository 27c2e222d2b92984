"""Identity: how a recipe makes a person's head of the built-in one."""

from __future__ import annotations

from .ageing import muscle_strength, tissue_of_life
from .people import Person, people
from .person import moved_arrays, person_from, with_moved
from .shape import Warp, warp_of

__all__ = [
    "Person",
    "Warp",
    "moved_arrays",
    "muscle_strength",
    "people",
    "person_from",
    "tissue_of_life",
    "warp_of",
    "with_moved",
]
