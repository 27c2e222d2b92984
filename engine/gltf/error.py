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

    The second value is the error of each frame [mm], shape (f,).

    Args:
        motion: What the shapes stand for.
        shapes: Strongest first [mm], shape (k, 3 v).
        weights: Of each shape in each frame, shape (f, k).
        tolerance: Largest error allowed [mm].
        start: The count that is tried first: near what will do.
        check: Called before each part of a walk over the frames; raises to stop.
    """
    start = min(max(1, start), len(shapes))
    tried: dict[int, FloatArray] = {}

    def enough(count: int) -> bool:
        tried[count] = frame_errors(
            motion, shapes[:count], weights[:, :count], tolerance, check=check
        )
        return bool(tried[count].max() <= tolerance)

    count = smallest(enough, start, len(shapes))
    if count not in tried or len(tried[count]) < len(motion):
        tried[count] = frame_errors(motion, shapes[:count], weights[:, :count], check=check)
    return count, tried[count]


def smallest(enough: Callable[[int], bool], start: int, most: int) -> int:
    """Return the smallest count that is enough, `most` if none below is; from `start` on.

    Steps double until one lies on the other side, then they are halved.
    """
    low, high, step = 0, most, 1
    count = start
    if enough(start):
        high = start
        while high > 1 and enough(count := max(1, high - step)):
            high, step = count, 2 * step
        low = count if high > 1 else 0
    else:
        low = start
        while low < most and not enough(count := min(most, low + step)):
            low, step = count, 2 * step
        high = min(most, count)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def frame_errors(
    motion: Motion,
    shapes: Float32Array,
    weights: Float32Array,
    tolerance: float = np.inf,
    *,
    check: Check | None = None,
) -> FloatArray:
    """Return the largest vertex error [mm] of each frame.

    It ends after the part of the frames that misses `tolerance`.

    Args:
        motion: What the shapes stand for.
        shapes: Displacements at weight 1 [mm], shape (k, 3 v).
        weights: Of each shape in each frame, shape (f, k).
        tolerance: Largest error that is of interest [mm].
        check: Called before each part of the frames; raises to stop.
    """
    errors = []
    for part, own in zip(parts_of(motion), parts_of(weights), strict=True):
        if check is not None:
            check()
        errors.append(np.sqrt(_squares(part, shapes, own).max(axis=1)))
        if errors[-1].max() > tolerance:
            break
    return np.concatenate(errors).astype(np.float64)


def vertex_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the error [mm] of each vertex in each frame, shape (f, v)."""
    return np.sqrt(_squares(part, shapes[:count], weights[:, :count])).astype(np.float64)


def _squares(part: Float32Array, shapes: Float32Array, weights: Float32Array) -> Float32Array:
    left = weights @ shapes
    left -= rows_of(part)
    np.multiply(left, left, out=left)
    return np.asarray(left[:, 0::3] + left[:, 1::3] + left[:, 2::3])


def parts_of(frames: Motion) -> Iterator[Float32Array]:
    """Yield a few frames at a time."""
    for start in range(0, len(frames), FRAMES_AT_ONCE):
        yield frames[start : start + FRAMES_AT_ONCE]


def rows_of(frames: Float32Array) -> Float32Array:
    """Return frames of shape (f, v, 3) as rows, shape (f, 3 v)."""
    return frames.reshape(len(frames), -1)
