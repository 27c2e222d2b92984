"""What a form of a clip is: how its motion becomes morph targets and weights."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ..clip import Clip
from .builder import Channel, GlbBuilder
from .drawn import DrawnFace
from .error import Check
from .motion import ClipMotion
from .packing import Packing
from .scene import Pivot

ROUNDING = 1e-4
"""What single precision in metres may add to an error, mm."""

Add = Callable[[GlbBuilder, DrawnFace, Mapping[str, Pivot]], list[Channel]]
"""Puts meshes with morph targets into a file, and returns the channels that move them."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A clip's motion in some form, ready to be written.

    Attributes:
        add: Puts it into a file.
        told: What the file's extras say of it.
        carried: Pivots that do not move, for their parts have morph targets.
    """

    add: Add
    told: Mapping[str, object]
    carried: tuple[str, ...] = field(default=())


Form = Callable[[Clip, ClipMotion, Packing, Check], Fit]
"""Finds morph targets and weights for the motion of a clip."""


def promised(error: float) -> float:
    """Return an error [mm] as it is stated: rounded up, for it is a promise."""
    return math.ceil((error + ROUNDING) * 1e4) / 1e4
