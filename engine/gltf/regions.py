"""Regions of a mesh that move by themselves: fewer shapes each than all of them together.

A smile beside a raised brow is a shape for the mouth and one for the brows, however the two go
together in time. Where the borders lie changes how large a file is and never how true.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray, IntArray

BROWS, LIDS, NOSE = 8.0, -15.0, -45.0
"""Lower borders of forehead, lids and cheeks: heights above the pupils of the built-in head, mm."""
CHIN, CORNERS, DEPTH = -85.0, 36.0, 40.0
"""Lower border of the mouth, how far to each side, and how far back it reaches, mm."""


def regions_of(skin: FloatArray) -> list[IntArray]:
    """Return the vertices of each region of a skin at rest [mm], shape (v, 3).

    Every vertex is in one; strands have no regions, for a few points of the skin move them.
    """
    x, y, z = skin.T
    mouth = (y > CHIN) & (np.abs(x) < CORNERS) & (z > DEPTH)
    label = np.select([y > BROWS, y > LIDS, y > NOSE, mouth], [0, 1, 2, 3], 4)
    return [np.flatnonzero(label == each) for each in np.unique(label)]
