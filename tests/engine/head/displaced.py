"""Displacements of the tissue that tests move a head by."""

from __future__ import annotations

import numpy as np

from engine.arrays import FloatArray
from engine.head import Head

# Centre on the left half, displacement there and reach, mm: mouth corner and cheek.
SMILE = (
    ((27.0, -72.0, 87.0), (7.0, 7.0, -5.0), 17.0),
    ((44.0, -38.0, 76.0), (1.0, 2.5, 2.5), 14.0),
)


def smile(points: FloatArray) -> FloatArray:
    """Return a smile of up to 11 mm at points (n, 3), alike on both sides."""
    moved = np.zeros_like(points)
    for side in (1.0, -1.0):
        flip = np.array([side, 1.0, 1.0])
        for center, shift, reach in SMILE:
            distance = np.linalg.norm(points - np.array(center) * flip, axis=1)
            moved += np.exp(-((distance / reach) ** 2))[:, None] * (np.array(shift) * flip)
    return moved


def lowered_jaw(head: Head, drop: float) -> FloatArray:
    """Return the displacement of a jaw that sinks by `drop` mm straight down."""
    return head.jaw_weight[:, None] * np.array([0.0, -drop, 0.0])
