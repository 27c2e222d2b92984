"""How far a motion is from the shapes and weights that stand for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray

Check = Callable[[], None]
"""Asks whether to go on, and raises when not: a long clip takes minutes."""
FRAMES_AT_ONCE = 64
"""Frames looked at together; bounds the memory."""


class Motion(Protocol):
    """Displacements from rest [mm]; slices and index arrays give float32, shape (n, v, 3).

    An array is one; so is anything that computes its frames when they are asked for.
    """

    def __len__(self) -> int:
        """Return the number of frames."""
        ...

    def __getitem__(self, frames: slice | IntArray, /) -> Float32Array:
        """Return some frames."""
        ...


def fewest_shapes(
    motion: Motion,
    shapes: Float32Array,
    weights: Float32Array,
    tolerance: float,
    *,
    start: int = 1,
    check: Check | None = None,
) -> tuple[int, FloatArray]:
    """Return the smallest count of shapes that keeps to `tolerance`, all if none does.

    Each walk over the frames lets the count grow where a part of the motion needs more, until a
    walk finds nothing to add. The second value is the error of each frame [mm], shape (f,).

    Args:
        motion: What the shapes stand for.
        shapes: Strongest first [mm], shape (k, 3 v).
        weights: Of each shape in each frame, shape (f, k).
        tolerance: Largest error allowed [mm].
        start: A count that is known to be too small, or one.
        check: Called before each part of a walk; raises to stop.
    """
    count, walked = start, 0
    errors: list[FloatArray] = []
    while walked != count:
        walked, errors = count, []
        for part, own in zip(parts_of(motion), parts_of(weights), strict=True):
            if check is not None:
                check()
            own_errors = _frame_errors(part, shapes, own, count)
            if own_errors.max() > tolerance:
                count = _fewest_of_part(part, shapes, own, tolerance, count)
            errors.append(own_errors)
    return count, np.concatenate(errors)


def _fewest_of_part(
    part: Float32Array,
    shapes: Float32Array,
    weights: Float32Array,
    tolerance: float,
    too_few: int,
) -> int:
    """Return the smallest count above `too_few` that will do for some frames, by bisection."""
    low, high = too_few, len(shapes)
    while high - low > 1:
        middle = (low + high) // 2
        enough = _frame_errors(part, shapes, weights, middle).max() <= tolerance
        low, high = (low, middle) if enough else (middle, high)
    return high


def _frame_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the largest vertex error [mm] in each frame with the first `count` shapes."""
    return np.asarray(vertex_errors(part, shapes, weights, count).max(axis=1))


def vertex_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the error [mm] of each vertex in each frame, shape (f, v)."""
    left = (rows_of(part) - weights[:, :count] @ shapes[:count]).reshape(part.shape)
    return np.asarray(np.sqrt(np.einsum("fvi,fvi->fv", left, left)), dtype=np.float64)


def parts_of(frames: Motion) -> Iterator[Float32Array]:
    """Yield a few frames at a time."""
    for start in range(0, len(frames), FRAMES_AT_ONCE):
        yield frames[start : start + FRAMES_AT_ONCE]


def rows_of(frames: Float32Array) -> Float32Array:
    """Return frames of shape (f, v, 3) as rows, shape (f, 3 v)."""
    return frames.reshape(len(frames), -1)
