"""Weights from 0 to 1 of given shapes, fitted to motion by least squares."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from .error import Check

MOST_SWEEPS = 400
CLOSE_ENOUGH = 1e-4
"""A weight that changes by less from sweep to sweep has arrived."""
RIDGE = 1e-4
"""Added to the squares, as a share of their mean: shapes that look alike share the work."""


def bounded_weights(
    products: FloatArray, wanted: FloatArray, *, check: Check | None = None
) -> FloatArray:
    """Return the weights w in [0, 1], shape (f, k), that bring shapes nearest to each frame.

    It is coordinate descent on |A w - b|^2 + ridge |w|^2: each weight in turn goes to where it is
    best beside the others, and no farther than its bounds. The sum is convex, so it ends at its
    one minimum (Tseng 2001, J. Optim. Theory Appl. 109). All frames go side by side.

    Args:
        products: Of the shapes with each other, A^T A, shape (k, k).
        wanted: Of the shapes with each frame, A^T b, shape (k, f).
        check: Called before each sweep; raises to stop.
    """
    squares = products + RIDGE * np.trace(products) / len(products) * np.eye(len(products))
    weights = np.zeros_like(wanted)
    for _ in range(MOST_SWEEPS):
        if check is not None:
            check()
        largest = 0.0
        for shape, row in enumerate(squares):
            if row[shape] <= 0.0:
                continue
            step = (wanted[shape] - row @ weights) / row[shape]
            moved = np.clip(weights[shape] + step, 0.0, 1.0)
            largest = max(largest, float(np.abs(moved - weights[shape]).max()))
            weights[shape] = moved
        if largest < CLOSE_ENOUGH:
            break
    return np.ascontiguousarray(weights.T)
