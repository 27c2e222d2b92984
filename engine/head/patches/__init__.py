"""The patches of the cage: each adds its derived points and its faces to half a head."""

from __future__ import annotations

from .cheek import add_cheek
from .crown import add_crown
from .ear import add_ear
from .eye import EYE_CENTER, EYE_RADIUS, add_eye
from .forehead import add_forehead
from .half import HalfCage
from .mouth import add_mouth
from .neck import add_neck
from .nose import add_nose
from .side import add_side

__all__ = [
    "EYE_CENTER",
    "EYE_RADIUS",
    "HalfCage",
    "add_cheek",
    "add_crown",
    "add_ear",
    "add_eye",
    "add_forehead",
    "add_mouth",
    "add_neck",
    "add_nose",
    "add_side",
]
