"""Which shapes a motion is made of: singular vectors, weighted until the largest error is small."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Float32Array, FloatArray
from .error import Check, fewest_shapes, rows_of, vertex_errors

BALANCING_ROUNDS = 4
"""Times that the weights of vertices and frames are improved; later rounds gain next to nothing."""
LEAST_SCALE = 0.05
"""Least weight of a vertex or frame; keeps the weighted motion well conditioned."""
FIRST_GUESS = 16
"""Shapes that are tried first."""
NEGLIGIBLE = 1e-6
"""Share of the tolerance below which all remaining shapes together are not worth having."""


@dataclass(frozen=True, eq=False)
class ShapeSpace:
    """Where each frame is among the singular vectors of scaled frames.

    Scaled by frame and by vertex, the frames are left @ diag(strength) @ right.

    Attributes:
        left: Orthonormal columns, strongest first, shape (f, k).
        inverse: right.T / strength: from scaled vertices to weights, shape (3 v, k).
        vertex_scale: Weight of each vertex, shape (v,).
        frame_scale: Weight of each frame, shape (f,).
        count: How many of the vectors the frames need.
    """

    left: FloatArray
    inverse: FloatArray
    vertex_scale: FloatArray
    frame_scale: FloatArray
    count: int = 0

    @property
    def own_weights(self) -> FloatArray:
        """Weights of the frames that the space was made from, shape (f, k)."""
        return self.left / self.frame_scale[:, None]

    def weights(self, parts: Iterable[Float32Array], most: int) -> FloatArray:
        """Return the first weights, shape (n, most), of other frames [mm], shape (n, v, 3).

        They come in parts, and in single precision: what that costs is measured with the rest.
        """
        scaled = np.repeat(self.vertex_scale, 3)[:, None] * self.inverse[:, :most]
        onto = scaled.astype(np.float32)
        return np.concatenate([rows_of(part) @ onto for part in parts]).astype(np.float64)

    def shapes(self, frames: Float32Array, most: int | None = None) -> FloatArray:
        """Return the shapes [mm], shape (k, 3 u), of the frames made from, with all vertices.

        Each is a least-squares fit of its own, for `left` is orthonormal; so the first shapes stay
        the best when the later ones are left out.

        Args:
            frames: Displacements [mm], shape (f, u, 3).
            most: How many are wanted, the strongest; all if None.
        """
        scaled = self.left[:, :most] * self.frame_scale[:, None]
        # Single precision is enough: what it costs is part of the error that is measured.
        return np.asarray(scaled.T.astype(np.float32) @ rows_of(frames), dtype=np.float64)


def balanced_space(
    frames: Float32Array, tolerance: float, *, check: Check | None = None
) -> ShapeSpace:
    """Return the space that needs the fewest shapes to keep to `tolerance`.

    A plain SVD leaves the least mean error, but its largest error sits in a few vertices and
    frames (lips, lids, onsets). Giving those more weight and starting again takes a third fewer
    shapes; the best of a few rounds is kept.

    Args:
        frames: Displacements [mm], shape (f, v, 3).
        tolerance: Largest error allowed [mm].
        check: Called now and then; raises to stop.
    """
    vertex_scale, frame_scale = np.ones(frames.shape[1]), np.ones(len(frames))
    best: ShapeSpace | None = None
    start = min(len(frames), FIRST_GUESS)
    for _ in range(BALANCING_ROUNDS):
        trial = _weighted_space(frames, vertex_scale, frame_scale, NEGLIGIBLE * tolerance)
        shapes = trial.shapes(frames).astype(np.float32)
        weights = trial.own_weights.astype(np.float32)
        count, _ = fewest_shapes(frames, shapes, weights, tolerance, start=start, check=check)
        start = count
        if best is None or count < best.count:
            best = replace(trial, count=count)
        # Judged with too few shapes, for there the error shows where more are wanted.
        errors = vertex_errors(frames, shapes, weights, max(1, count - 1 - count // 10))
        vertex_scale = _raised(vertex_scale, errors.max(axis=0) / tolerance, 0.5)
        frame_scale = _raised(frame_scale, errors.max(axis=1) / tolerance, 0.25)
    assert best is not None
    return best


def _raised(scale: FloatArray, error: FloatArray, power: float) -> FloatArray:
    raised = scale * np.maximum(error, LEAST_SCALE) ** power
    return np.asarray(np.maximum(raised / raised.mean(), LEAST_SCALE))


def _weighted_space(
    frames: Float32Array, vertex_scale: FloatArray, frame_scale: FloatArray, negligible: float
) -> ShapeSpace:
    """Return the singular vectors of scaled frames, without those of noise.

    By the eigenvectors of rows @ rows.T, for there are many more columns than rows.
    """
    scale = frame_scale[:, None] * vertex_scale
    rows = (frames * scale[:, :, None]).reshape(len(frames), -1)
    squares, left = np.linalg.eigh(rows @ rows.T)
    order = np.argsort(squares, kind="stable")[::-1]
    remaining = np.cumsum(squares[order][::-1])[::-1]
    # Below 1e-14 there is nothing but noise: the product squares the numbers.
    needed = (remaining > negligible**2) & (squares[order] > squares.max() * 1e-14)
    kept = order[needed] if needed.any() else order[:1]
    strongest = left[:, kept]
    inverse = (rows.T @ strongest) / np.maximum(squares[kept], 1e-300)
    return ShapeSpace(strongest, inverse, vertex_scale, frame_scale)
