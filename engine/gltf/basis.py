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
BALANCING_ROUNDS = 6
"""Times that the weights of vertices and frames are improved; later rounds gain nothing."""
LEAST_SCALE = 0.05
"""Least weight of a vertex or frame; keeps the weighted motion well conditioned."""
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
    """Return few principal shapes that reproduce `motion` to `tolerance`.

    The shapes are the leading right singular vectors of the frames, weighted so that the largest
    error is small rather than the mean (`_balanced_shapes`). How many of them are needed is found
    by trying, on the rounded numbers that will be written: one fewer would miss the tolerance.

    Args:
        motion: What to reproduce; at least one frame.
        tolerance: Largest error allowed of any vertex in any frame [mm].
    """
    chosen = np.unique(np.linspace(0, len(motion) - 1, SNAPSHOT_COUNT).round().astype(np.int64))
    while True:
        space = _balanced_shapes(motion[chosen], tolerance)
        shapes, weights = _rounded(*_project(motion, space), tolerance)
        count, errors = _fewest(motion, shapes, weights, tolerance)
        missed = np.setdiff1d(np.flatnonzero(errors > tolerance), chosen)
        if missed.size == 0:
            break
        worst = missed[np.argsort(-errors[missed], kind="stable")]
        chosen = np.union1d(chosen, worst[: SNAPSHOT_COUNT // 4])
    kept = shapes[:count].reshape(count, -1, 3)
    return MotionBasis(kept, np.ascontiguousarray(weights[:, :count]), float(errors.max()))


@dataclass(frozen=True, eq=False)
class _Space:
    """Orthonormal rows in a space where vertices are scaled: `vectors`, (k, 3v); `scale`, (v,)."""

    vectors: FloatArray
    scale: FloatArray


def _balanced_shapes(frames: Float32Array, tolerance: float) -> _Space:
    """Return singular vectors of `frames`, weighted until few of them keep to `tolerance`.

    A plain SVD leaves the least mean error, but its largest error sits in a few vertices and
    frames (lips, lids, onsets). Giving those more weight and starting again takes a third fewer
    shapes; the best of a few rounds is kept.
    """
    vertex_scale, frame_scale = np.ones(frames.shape[1]), np.ones(len(frames))
    best, best_count = None, len(frames) + 1
    negligible = SHARE_DROPPED * tolerance * LEAST_SCALE**2
    for _ in range(BALANCING_ROUNDS):
        weighted = frames * (frame_scale[:, None] * vertex_scale)[:, :, None].astype(np.float32)
        space = _Space(_singular_vectors(_rows(weighted), negligible), vertex_scale)
        shapes, weights = _rounded(*_project(frames, space), tolerance)
        count, _ = _fewest(frames, shapes, weights, tolerance)
        if best is None or count < best_count:
            best, best_count = space, count
        # Judged with too few shapes, for there the error shows where more are wanted.
        errors = _vertex_errors(frames, shapes, weights, max(1, count - 1 - count // 10))
        vertex_scale = _raised(vertex_scale, errors.max(axis=0) / tolerance, 0.5)
        frame_scale = _raised(frame_scale, errors.max(axis=1) / tolerance, 0.25)
    assert best is not None
    return best


def _raised(scale: FloatArray, error: FloatArray, power: float) -> FloatArray:
    raised = scale * np.maximum(error, LEAST_SCALE) ** power
    return np.asarray(np.maximum(raised / raised.mean(), LEAST_SCALE))


def _singular_vectors(rows: Float32Array, negligible: float) -> FloatArray:
    """Return the right singular vectors of `rows`, strongest first, without those of noise.

    By the eigenvectors of rows @ rows.T, for there are many more columns than rows.
    """
    wide = rows.astype(np.float64)
    squares, left = np.linalg.eigh(wide @ wide.T)
    order = np.argsort(squares, kind="stable")[::-1]
    # What all later vectors hold together is less than what is dropped anyway. Nor is there
    # anything but noise below 1e-14: the product squares the numbers.
    rest = np.cumsum(squares[order][::-1])[::-1]
    needed = (rest > negligible**2) & (squares[order] > squares.max() * 1e-14)
    kept = order[needed]
    vectors: FloatArray = (left[:, kept] / np.sqrt(squares[kept])).T @ wide
    return vectors if len(vectors) else np.zeros((1, rows.shape[1]))


def _project(motion: Motion, space: _Space) -> tuple[FloatArray, FloatArray]:
    """Return shapes and weights, scaled so that each shape's largest weight is 1."""
    scale = np.repeat(space.scale, 3)
    # Single precision is enough: what it costs is part of the error that is measured.
    onto = (space.vectors * scale).T.astype(np.float32)
    weights = np.concatenate([_rows(part) @ onto for part in _parts(motion)]).astype(np.float64)
    largest = np.abs(weights).argmax(axis=0)
    peaks = weights[largest, np.arange(weights.shape[1])]
    peaks = np.where(peaks == 0, 1.0, peaks)
    return space.vectors / scale * peaks[:, None], weights / peaks


def _rounded(
    shapes: FloatArray, weights: FloatArray, tolerance: float
) -> tuple[Float32Array, Float32Array]:
    points = shapes.reshape(len(shapes), -1, 3)
    small = (np.abs(points) < SHARE_DROPPED * tolerance).all(axis=2, keepdims=True)
    points = np.where(small, 0.0, points)
    return points.reshape(shapes.shape).astype(np.float32), weights.astype(np.float32)


def _fewest(
    motion: Motion, shapes: Float32Array, weights: Float32Array, tolerance: float
) -> tuple[int, FloatArray]:
    """Return the smallest count of shapes that keeps to `tolerance`, all if none does.

    Each walk over the frames lets the count grow where a part of the motion needs more, until a
    walk finds nothing to add. The second value is the error of each frame [mm], shape (f,).
    """
    count, walked = 1, 0
    errors: list[FloatArray] = []
    while walked != count:
        walked, errors = count, []
        for part, own in zip(_parts(motion), _parts(weights), strict=True):
            own_errors = _part_errors(part, shapes, own, count)
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
        enough = _part_errors(part, shapes, weights, middle).max() <= tolerance
        low, high = (low, middle) if enough else (middle, high)
    return high


def _part_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the largest vertex error [mm] in each frame with the first `count` shapes."""
    return np.asarray(_vertex_errors(part, shapes, weights, count).max(axis=1))


def _vertex_errors(
    part: Float32Array, shapes: Float32Array, weights: Float32Array, count: int
) -> FloatArray:
    """Return the error [mm] of each vertex in each frame, shape (f, v)."""
    left = (_rows(part) - weights[:, :count] @ shapes[:count]).reshape(part.shape)
    return np.asarray(np.sqrt(np.einsum("fvi,fvi->fv", left, left)), dtype=np.float64)


def _parts(frames: Motion) -> Iterator[Float32Array]:
    for start in range(0, len(frames), FRAMES_AT_ONCE):
        yield frames[start : start + FRAMES_AT_ONCE]


def _rows(frames: Float32Array) -> Float32Array:
    return frames.reshape(len(frames), -1)
