"""Shapes without what a vertex can do without: few vertices need all shapes of their region.

How many shapes a region has, the vertex and the frame that are farthest off decide. Most other
vertices would do with fewer, and sparse accessors have rows for those that move only.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray

TRIES = 2
"""Shapes that a vertex cannot be spared before no more are tried; all would gain little more."""


def spared(
    frames: Float32Array,
    shapes: FloatArray,
    weights: FloatArray,
    tolerance: float | FloatArray,
) -> FloatArray:
    """Return `shapes` with zeros where a vertex stays within `tolerance` of all frames without.

    Of each vertex the shape that moves it least goes first, then the next, until `TRIES` cannot be
    spared. What is off anyway keeps all of its shapes.

    Args:
        frames: What weights @ shapes stands for, shape (f, v, 3).
        shapes: Shape (k, 3 v).
        weights: Of each shape in each frame, shape (f, k).
        tolerance: Largest error allowed, in the unit of the frames; of each vertex, shape (v,), or
            of all.
    """
    count, vertices = len(shapes), frames.shape[1]
    moves = shapes.reshape(count, vertices, 3).astype(np.float32)
    own = weights.astype(np.float32)
    left = (own @ moves.reshape(count, -1)).reshape(frames.shape) - frames
    reach = np.linalg.norm(moves, axis=2) * np.abs(own).max(axis=0)[:, None]
    order: IntArray = np.argsort(reach, axis=0, kind="stable")
    least = np.broadcast_to(np.asarray(tolerance, np.float64) ** 2, vertices)
    kept = np.ones((count, vertices), bool)
    trying: IntArray = np.arange(vertices)
    missed = np.zeros(vertices, np.int64)
    for shape in order:
        chosen = shape[trying]
        without = left[:, trying] - own[:, chosen, None] * moves[chosen, trying]
        enough = np.einsum("fvi,fvi->fv", without, without).max(axis=0) <= least[trying]
        gone = trying[enough]
        kept[shape[gone], gone] = False
        left[:, gone] = without[:, enough]
        missed[trying[~enough]] += 1
        trying = trying[missed[trying] < TRIES]
        if not trying.size:
            break
    return np.asarray(shapes * np.repeat(kept, 3, axis=1))
