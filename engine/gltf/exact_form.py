"""A clip with a morph target for every frame: nothing is fitted, and the file is large."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..clip import Clip
from ..errors import InvalidValue
from .accessors import metres
from .builder import Channel, GlbBuilder
from .drawn import DrawnFace
from .error import Check
from .form import Fit, promised
from .motion import ClipMotion
from .packing import Packing
from .scene import Pivot
from .skin import add_piece

MOST_FRAMES = 900
"""Different frames that a file may have: graphics processors take no more targets than some
thousand, and readers hold all of them."""


def every_frame(clip: Clip, motion: ClipMotion, packing: Packing, check: Check) -> Fit:
    """Return a target for each frame that differs from the one before.

    Raises:
        InvalidValue: There are too many.
    """
    count = len(motion.displacements)
    if count > MOST_FRAMES:
        raise InvalidValue(
            f"the clip has {count} different frames; the form 'exact' takes {MOST_FRAMES} at most. "
            "Choose the form 'basis', fewer frames a second, or a shorter clip"
        )
    grids = [packing.grid(metres(piece.rest)) for piece in motion.pieces]
    # Places at rest are rounded, and so are the moves from there.
    error = max(2.0 * grid.error * 1e3 for grid in grids)
    told = {
        "shapes": {piece.name: count for piece in motion.pieces},
        "max_error_mm": promised(error),
    }
    weights = np.eye(count, dtype=np.float32)[motion.shown].ravel()

    def add(builder: GlbBuilder, face: DrawnFace, pivots: Mapping[str, Pivot]) -> list[Channel]:
        channels = []
        turns = motion.drawer.turns(motion.displacements)
        for piece in motion.pieces:
            check()
            node = add_piece(
                builder,
                face,
                pivots["head"],
                piece,
                names=[f"frame_{number:03d}" for number in range(count)],
                moves=list(piece.motion[:]),
                turns=list(turns) if piece.part is None else (),
                smallest=0.0,
            )
            channels.append(Channel(node, "weights", weights))
        return channels

    return Fit(add, told)
