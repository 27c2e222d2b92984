"""Weights of shapes that pull both ways, made 0 to 1: one more shape, against all the others.

Readers hold weights to that range: Blender's sliders do, and a normalised integer may.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray


def positive(shapes: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return other shapes, and weights from 0 to 1, that add up to the same.

    With n the least weights, turned positive, the further shape is -n @ shapes; as much of it, m,
    is added to a frame as the weight that is deepest below 0 needs: w @ shapes is
    (w + m n) @ shapes + m (-n @ shapes), and no w + m n is below 0. So the face at rest, where all
    weights are 0, stays the mesh without any shape. Each is scaled so that its greatest weight
    is 1. Without weights below 0 there is no further shape.

    Args:
        shapes: Displacements, shape (k, n).
        weights: Of each shape in each frame, shape (f, k).
    """
    # The side that reaches farther is the positive one, so that little is to be made up for.
    signs = np.where(weights.max(axis=0) < -weights.min(axis=0), -1.0, 1.0)
    shapes, weights = shapes * signs[:, None], weights * signs
    least = np.maximum(-weights.min(axis=0), 0.0)
    below = least > 0.0
    if below.any():
        needed = (-weights[:, below] / least[below]).max(axis=1).clip(0.0, 1.0)
        weights = np.column_stack([(weights + needed[:, None] * least).clip(0.0), needed])
        shapes = np.concatenate([shapes, -(least @ shapes)[None]])
    peaks = weights.max(axis=0)
    peaks = np.where(peaks > 0.0, peaks, 1.0)
    return shapes * peaks[:, None], weights / peaks
