"""A moving mesh as few shapes and their weights over time: a truncated SVD held to an error."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray

SNAPSHOT_COUNT = 400
"""Frames that a basis is first made from; more are added only where those do not suffice."""
FRAMES_AT_ONCE = 64
"""Frames looked at together; bounds the memory."""
SHARE_DROPPED = 1e-3
"""Deltas below this share of the tolerance are dropped from a shape."""


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


@dataclass(frozen=True, eq=False)
class MotionBasis:
    """Motion = weights @ shapes, to within `max_error`.

    Attributes:
        shapes: Displacements [mm] at weight 1, shape (k, v, 3).
        weights: Of each shape in each frame, -1 to 1, shape (f, k).
        max_error: Largest distance of any vertex in any frame from where it should be [mm].
    """

    shapes: Float32Array
    weights: Float32Array
    max_error: float


def fit_basis(motion: Motion, *, tolerance: float) -> MotionBasis:
    """Return the fewest principal shapes that reproduce `motion` to `tolerance`.

    The shapes are the leading right singular vectors of the frames, which for a given number of
    shapes leave the least squared error; how many are needed is found by trying, on the rounded
    numbers that will be written.

    Args:
        motion: What to reproduce; at least one frame.
        tolerance: Largest error allowed of any vertex in any frame [mm].
    """
    chosen = np.unique(np.linspace(0, len(motion) - 1, SNAPSHOT_COUNT).round().astype(np.int64))
    while True:
        vectors = _singular_vectors(_rows(motion[chosen]))
        shapes, weights = _rounded(*_project(motion, vectors), tolerance)
        count = _fewest(motion, shapes, weights, tolerance)
        errors = _frame_errors(motion, shapes, weights, count)
        missed = np.setdiff1d(np.flatnonzero(errors > tolerance), chosen)
        if missed.size == 0:
            break
        worst = missed[np.argsort(-errors[missed], kind="stable")]
        chosen = np.union1d(chosen, worst[: SNAPSHOT_COUNT // 4])
    kept = shapes[:count].reshape(count, -1, 3)
    return MotionBasis(kept, np.ascontiguousarray(weights[:, :count]), float(errors.max()))


def _singular_vectors(rows: Float32Array) -> FloatArray:
    """Return the right singular vectors of `rows`, strongest first, without those of noise.

    By the eigenvectors of rows @ rows.T, for there are many more columns than rows.
    """
    wide = rows.astype(np.float64)
    squares, left = np.linalg.eigh(wide @ wide.T)
    order = np.argsort(squares, kind="stable")[::-1]
    # The product squares the numbers, so half of the digits carry nothing.
    kept = order[squares[order] > squares.max(initial=0.0) * 1e-14]
    vectors: FloatArray = (left[:, kept] / np.sqrt(squares[kept])).T @ wide
    return vectors if len(vectors) else np.zeros((1, rows.shape[1]))


def _project(motion: Motion, vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return shapes and weights, scaled so that each shape's largest weight is 1."""
    projected = [_rows(part).astype(np.float64) @ vectors.T for part in _parts(motion)]
    weights = np.concatenate(projected)
    largest = np.abs(weights).argmax(axis=0)
    peaks = weights[largest, np.arange(weights.shape[1])]
    peaks = np.where(peaks == 0, 1.0, peaks)
    return vectors * peaks[:, None], weights / peaks


def _rounded(
    shapes: FloatArray, weights: FloatArray, tolerance: float
) -> tuple[Float32Array, Float32Array]:
    points = shapes.reshape(len(shapes), -1, 3)
    small = (np.abs(points) < SHARE_DROPPED * tolerance).all(axis=2)
    points = np.where(small[:, :, None], 0.0, points)
    return points.reshape(shapes.shape).astype(np.float32), weights.astype(np.float32)


def _fewest(motion: Motion, shapes: Float32Array, weights: Float32Array, tolerance: float) -> int:
    """Return the smallest count of shapes that keeps to `tolerance`, all if none does.

    One walk over the frames: the count only grows, where a part of the motion needs more.
    """
    count = 1
    for part, own in zip(_parts(motion), _parts(weights), strict=True):
        if _part_errors(part, shapes, own, count).max() <= tolerance:
            continue
        low, high = count, len(shapes)
        while high - low > 1:
            middle = (low + high) // 2
            enough = _part_errors(part, shapes, own, middle).max() <= tolerance
            low, high = (low, middle) if enough else (middle, high)
        count = high
    return count


def _frame_errors(
    motion: Motion, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the largest vertex error [mm] in each frame with the first `count` shapes."""
    pairs = zip(_parts(motion), _parts(weights), strict=True)
    return np.concatenate([_part_errors(part, shapes, own, count) for part, own in pairs])


def _part_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    left = _rows(part) - weights[:, :count] @ shapes[:count]
    points = left.reshape(part.shape)
    squares = np.einsum("fvi,fvi->fv", points, points)
    return np.sqrt(squares.max(axis=1).astype(np.float64))


def _parts(frames: Motion) -> Iterator[Float32Array]:
    for start in range(0, len(frames), FRAMES_AT_ONCE):
        yield frames[start : start + FRAMES_AT_ONCE]


def _rows(frames: Float32Array) -> Float32Array:
    return frames.reshape(len(frames), -1)
