"""A clip as few shapes of its own motion: each mesh has the fewest that keep to the tolerance."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..arrays import Float32Array, IntArray
from ..clip import Clip
from .basis import DROPPED, LEAST_DROPPED, MotionBasis, fit_basis
from .builder import Channel, GlbBuilder, metres
from .drawn import DrawnFace
from .error import Check
from .form import ROUNDING, Fit, promised
from .motion import ClipMotion, Piece
from .packing import Grid, Packing
from .scene import Pivot
from .skin import add_piece

NORMAL_FRAMES = 150
"""Frames that the shapes' normals are fitted to."""


def fit_shapes(clip: Clip, motion: ClipMotion, packing: Packing, check: Check) -> Fit:
    """Return the shapes that a clip's motion is made of.

    The skin and each strand part have a basis of their own: brows and lashes follow a few points
    of the skin, and need fewer shapes than it does.
    """
    fitted = [_fitted(piece, packing, check) for piece in motion.pieces]
    bases = [basis for basis, _ in fitted]
    error = max(basis.max_error + grid.error * 1e3 for basis, grid in fitted)
    counts = {
        piece.name: len(basis.shapes) for piece, basis in zip(motion.pieces, bases, strict=True)
    }
    told = {"basis": counts["skin"], "shapes": counts, "max_error_mm": promised(error)}
    turns = _turns(motion, bases[0])

    def add(builder: GlbBuilder, face: DrawnFace, pivots: Mapping[str, Pivot]) -> list[Channel]:
        channels = []
        for piece, (basis, grid) in zip(motion.pieces, fitted, strict=True):
            node = add_piece(
                builder,
                face,
                pivots["head"],
                piece,
                names=[f"shape_{number:02d}" for number in range(len(basis.shapes))],
                moves=list(basis.shapes),
                turns=list(turns) if piece.part is None else (),
                smallest=0.0,
                grid=grid,
            )
            if basis.shapes.any() or piece.part is None:
                channels.append(Channel(node, "weights", basis.weights[motion.shown].ravel()))
        return channels

    return Fit(add, told)


def _fitted(piece: Piece, packing: Packing, check: Check) -> tuple[MotionBasis, Grid]:
    """Return the shapes of a piece, and the grid that they fit on within the tolerance.

    Very many shapes may add up what each loses by rounding: those are not rounded.
    """
    grid = packing.grid(metres(piece.rest))
    for own, dropped in ((grid, DROPPED), (grid, LEAST_DROPPED), (Grid(), LEAST_DROPPED)):
        # What is left of the tolerance where the places at rest are rounded, too.
        tolerance = packing.tolerance - own.error * 1e3 - ROUNDING
        basis = fit_basis(
            piece.motion, tolerance=tolerance, step=own.step * 1e3, dropped=dropped, check=check
        )
        if basis.max_error <= tolerance:
            break
    return basis, own


def _turns(motion: ClipMotion, basis: MotionBasis) -> Float32Array:
    """Return the change of the skin's normals that best goes with each shape, shape (k, d, 3).

    Normals are not linear in the positions, so this is a least-squares fit over the frames.
    """
    count = len(motion.displacements)
    chosen: IntArray = np.unique(np.linspace(0, count - 1, NORMAL_FRAMES).round().astype(np.int64))
    changes = motion.drawer.turns(motion.displacements[chosen])
    weights = basis.weights[chosen].astype(np.float64)
    # A little damping: shapes that none of these frames uses get no normals instead of noise.
    squares = weights.T @ weights + 1e-3 * np.eye(weights.shape[1])
    onto = np.linalg.solve(squares, weights.T).astype(np.float32)
    fitted = onto @ changes.reshape(len(chosen), -1)
    return np.asarray(fitted.reshape(len(squares), -1, 3), np.float32)
