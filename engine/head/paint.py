"""Paint: the colours of skin, lips, lids and hair at the vertices of the finest level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from .geometry import linear_rgb


@dataclass(frozen=True, eq=False)
class Paint:
    """Colours of the finest level: linear RGB, shape (d, 3), and hair mask in 0..1, shape (d,)."""

    colors: FloatArray
    hair: FloatArray


def painted(vertices: FloatArray) -> Paint:
    """Return the skin's colours."""
    colors = np.tile(linear_rgb([0.80, 0.565, 0.445]), (len(vertices), 1))
    return Paint(colors, np.zeros(len(vertices)))
