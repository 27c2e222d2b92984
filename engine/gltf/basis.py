"""A moving mesh as few shapes and their weights over time: a truncated SVD held to an error."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray
from .balance import balanced_space
from .error import Check, Motion, fewest_shapes, frame_errors, parts_of
from .packing import GREATEST_STEP, WEIGHT_STEPS
from .positive import positive
from .spared import spared

SNAPSHOT_COUNT = 300
"""Frames that a basis is first made from; more are added only where those do not suffice."""
SAMPLE_COUNT = 1000
"""About as many vertices say which shapes are needed; the rest move much like their neighbours."""
SPARE_SHAPES = 16
"""Shapes that are looked at beside twice as many as a sample of the vertices needs."""
SPENT = (0.92, 0.85, 0.7)
"""Shares of the tolerance that vertices are spared shapes for; the next where rounding, which comes
after, takes more than is left."""
SPENT_UNSEEN = (0.5,)
"""The same where not all frames are looked at: more would have many of the others missed."""


@dataclass(frozen=True, eq=False)
class MotionBasis:
    """Motion = weights @ shapes, to within `max_error`.

    Attributes:
        shapes: Displacements [mm] at weight 1, shape (k, v, 3).
        weights: Of each shape in each frame, 0 to 1, shape (f, k).
        pulls: Weights before `positive` made those of them, shape (f, k or k - 1).
        max_error: Largest distance of any vertex in any frame from where it should be [mm].
    """

    shapes: Float32Array
    weights: Float32Array
    pulls: FloatArray
    max_error: float


@dataclass(frozen=True)
class _Fineness:
    """Largest error allowed and step of the grid (0 for none), mm; whether zeros take no room."""

    tolerance: float
    step: float
    sparse: bool


def fit_basis(
    motion: Motion,
    *,
    tolerance: float,
    step: float = 0.0,
    sparse: bool = True,
    check: Check | None = None,
) -> MotionBasis:
    """Return few principal shapes that reproduce `motion` to `tolerance`.

    The shapes are the leading singular vectors of some frames, weighted so that the largest error
    is small rather than the mean (`balanced_space`), and one against all of them that keeps the
    weights from 0 to 1 (`positive`). How many are needed is found by trying, on the rounded
    numbers that will be written: one fewer would miss the tolerance. All frames are looked at
    afterwards, and those that are missed taken in.

    Args:
        motion: What to reproduce; at least one frame.
        tolerance: Largest error allowed of any vertex in any frame [mm].
        step: Of the grid that shapes are stored on [mm], and weights on one of their own; 0 for
            none. On a coarse one there may be an error beyond the tolerance: what is stated counts.
            It is infinite where a move does not fit on the grid.
        sparse: Whether a shape is to have zeros for the vertices that do without (`spared`).
        check: Called now and then; raises to stop.
    """
    fine = _Fineness(tolerance, step, sparse)
    chosen = np.unique(np.linspace(0, len(motion) - 1, SNAPSHOT_COUNT).round().astype(np.int64))
    spare = SPARE_SHAPES
    while True:
        basis, errors = _fit_to(motion, chosen, fine, check, spare)
        missed = np.flatnonzero(errors > tolerance)
        new = np.setdiff1d(missed, chosen)
        if new.size and np.isfinite(basis.max_error):
            worst = new[np.argsort(-errors[new], kind="stable")[: SNAPSHOT_COUNT // 2]]
            spread = new[:: max(1, 2 * new.size // SNAPSHOT_COUNT)]
            chosen = np.union1d(chosen, np.union1d(worst, spread))
        elif missed.size and np.isfinite(basis.max_error) and spare == SPARE_SHAPES:
            spare = len(chosen)
        else:
            return basis


def _fit_to(
    motion: Motion, chosen: IntArray, fine: _Fineness, check: Check | None, spare: int
) -> tuple[MotionBasis, FloatArray]:
    """Return the basis made from the `chosen` frames, and its error in every frame [mm].

    Shapes beyond twice those that a sample of the vertices needs, and `spare`, are not looked at:
    where those do not suffice, frames are missing among the chosen.
    """
    frames = motion[chosen]
    stride = max(1, frames.shape[1] // SAMPLE_COUNT)
    space = balanced_space(np.ascontiguousarray(frames[:, ::stride]), fine.tolerance, check=check)
    most = min(space.own_weights.shape[1], 2 * space.count + spare)
    shapes, weights = space.shapes(frames, most), space.own_weights[:, :most]
    if len(chosen) < len(motion):
        weights = space.weights((part[:, ::stride] for part in parts_of(motion)), most)
        weights[chosen] = space.own_weights[:, :most]
    own = np.ascontiguousarray(weights[chosen])
    tried = _rounded(*_peaked(shapes, own), fine)
    count, _ = fewest_shapes(frames, *tried, fine.tolerance, start=space.count, check=check)
    while True:
        for kept in _kept(frames, shapes[:count], weights[:, :count], own[:, :count], fine):
            errors = frame_errors(frames, kept[0], kept[1][chosen], fine.tolerance, check=check)
            if errors.max() <= fine.tolerance:
                break
        # Turned positive, the shapes are rounded otherwise than those that were counted.
        if errors.max() <= fine.tolerance or count == most:
            break
        count += 1
    if len(errors) < len(frames):
        errors = frame_errors(frames, kept[0], kept[1][chosen], check=check)
    if len(chosen) < len(motion):
        errors = frame_errors(motion, *kept, check=check)
    if fine.step and np.abs(kept[0]).max(initial=0.0) > GREATEST_STEP * fine.step:
        errors = np.full(len(errors), np.inf)
    points = kept[0].reshape(len(kept[0]), -1, 3)
    return MotionBasis(points, kept[1], weights[:, :count], float(errors.max())), errors


def _kept(
    frames: Float32Array, shapes: FloatArray, weights: FloatArray, own: FloatArray, fine: _Fineness
) -> Iterator[tuple[Float32Array, Float32Array]]:
    """Yield shapes and weights from 0 to 1 as they are written, the ones with most zeros first.

    Args:
        frames: Those that the shapes were made from [mm], shape (n, v, 3).
        shapes: Pulling both ways [mm], shape (k, 3 v).
        weights: Of all frames, shape (f, k).
        own: Of those that the shapes were made from, shape (n, k).
        fine: What they are to keep to.
    """
    shares = SPENT if len(own) == len(weights) else SPENT_UNSEEN
    for share in shares if fine.sparse else ():
        fewer = spared(frames, shapes, own, share * fine.tolerance)
        yield _rounded(*positive(fewer, weights), fine)
    yield _rounded(*positive(shapes, weights), fine)


def _peaked(shapes: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return both scaled so that each shape's largest weight is 1."""
    largest = np.abs(weights).argmax(axis=0)
    peaks = weights[largest, np.arange(weights.shape[1])]
    peaks = np.where(peaks == 0, 1.0, peaks)
    return shapes * peaks[:, None], weights / peaks


def _rounded(
    shapes: FloatArray, weights: FloatArray, fine: _Fineness
) -> tuple[Float32Array, Float32Array]:
    """Return both as they will be written."""
    points = shapes.reshape(len(shapes), -1, 3)
    if fine.step:
        points = np.round(points / fine.step) * fine.step
        weights = np.round(weights * WEIGHT_STEPS) / WEIGHT_STEPS
    return points.reshape(shapes.shape).astype(np.float32), weights.astype(np.float32)
