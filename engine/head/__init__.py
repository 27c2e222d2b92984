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
from .mesh import head_from_mesh, read_head
from .skin import LEVELS
from .standard import paper_head, standard_head

__all__ = [
    "BULGE_HEIGHT",
    "BULGE_POWER",
    "BULGE_RADIUS",
    "LEVELS",
    "LID_GAP",
    "DrawnSurface",
    "Eye",
    "Head",
    "LidContact",
    "Part",
    "head_from_mesh",
    "paper_head",
    "read_head",
    "standard_head",
]
