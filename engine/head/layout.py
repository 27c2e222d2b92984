"""The skin's islands as they ship, laid flat: flattening takes seconds, and reading no time."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import numpy as np

from ..arrays import FloatArray
from ..cache import cached_arrays, content_key
from .cage import Cage
from .storage import source_key
from .subdivision import Limit
from .uv import ISLANDS, Pieces, Unwrap, flattened_islands, laid_out

GRAIN = 1e-3
"""To what the skin is compared with the skin that the islands were flattened for, mm."""
OFF_GRID = 0.3
"""Of a grain: authored places and their means, which are whole or a half, never lie between two."""


def unwrapped(cage: Cage, limit: Limit, points: FloatArray) -> Unwrap:
    """Return the map of the skin: as it ships, flattened anew where that is of another skin.

    Args:
        cage: The cage.
        limit: Its limit surface.
        points: The cage's points [mm], shape (v, 3).
    """
    pieces = Pieces.of(cage, limit, points)
    flat = shipped(pieces)
    if flat is None:
        key = source_key("islands", layout_key(pieces))
        flat = cached_arrays("islands", key, lambda: {"flat": flattened_islands(pieces)})["flat"]
    return laid_out(pieces, flat)


def shipped(pieces: Pieces) -> FloatArray | None:
    """Return the islands that ship [mm], shape (n, 2), or None where they are of another skin."""
    with np.load(layout_file(), allow_pickle=False) as stored:
        if str(stored["key"]) != layout_key(pieces):
            return None
        return np.asarray(stored["flat"], dtype=np.float64)


def layout_key(pieces: Pieces) -> str:
    """Return a hash of the islands' shape; what only rounding makes different has the same."""
    grains = np.rint(pieces.vertices / GRAIN + OFF_GRID).astype(np.int64)
    names = [(island.name, island.cut) for island in ISLANDS]
    return content_key(grains, pieces.keys, pieces.corners, names)


def layout_file() -> Path:
    """Return where the islands ship."""
    return Path(str(resources.files(__package__))) / "data" / "islands.npz"
