"""A clip as few shapes of its own motion: each region has the fewest that keep to the tolerance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Float32Array, IntArray
from ..clip import Clip
from .accessors import metres
from .basis import MotionBasis, fit_basis
from .builder import Channel, GlbBuilder
from .drawn import DrawnFace
from .error import Check, Motion
from .form import ROUNDING, Fit, promised
from .motion import ClipMotion, Piece
from .packing import Grid, Packing
from .positive import positive
from .regions import regions_of
from .scene import Pivot
from .skin import add_piece
from .spared import spared

NORMAL_FRAMES = 150
"""Frames that the shapes' normals are fitted to."""
DAMPING = 1e-4
"""Of the fit of normals, as a share of all weights' squares."""
TURN_ERROR = 0.05
"""By how much a normal of length one may be off in any of those frames for being spared shapes:
three degrees, which are not seen on skin in motion. Few fits are nearer."""


@dataclass(frozen=True, eq=False)
class _Region:
    """Some vertices of a mesh, and the shapes that they move by."""

    vertices: IntArray
    basis: MotionBasis


@dataclass(frozen=True, eq=False)
class _Fitted:
    """A mesh as shapes of its regions.

    Attributes:
        piece: The mesh.
        regions: Those that move; the first, where none does.
        grid: Where its vertices are stored.
        max_error: Largest distance of any vertex from where it should be [mm].
    """

    piece: Piece
    regions: tuple[_Region, ...]
    grid: Grid
    max_error: float

    @property
    def count(self) -> int:
        """Number of shapes."""
        return sum(len(region.basis.shapes) for region in self.regions)

    def shapes(self) -> Iterator[Float32Array]:
        """Yield each shape, with zeros outside of its region, shape (v, 3)."""
        for region in self.regions:
            for shape in region.basis.shapes:
                yield _spread(shape, region.vertices, len(self.piece.rest))

    def rows(self) -> list[IntArray]:
        """Return the vertices of each shape's region."""
        return [region.vertices for region in self.regions for _ in region.basis.shapes]

    def weights(self, shown: IntArray) -> Float32Array:
        """Return the weights of all shapes in each frame that is shown, shape (f, k)."""
        return np.concatenate([region.basis.weights[shown] for region in self.regions], axis=1)


def fit_shapes(clip: Clip, motion: ClipMotion, packing: Packing, check: Check) -> Fit:
    """Return the shapes that a clip's motion is made of.

    Regions of the skin have a basis of their own, and so has each strand part: what moves by
    itself, and what follows a few points of the skin, needs fewer shapes than all of the face.
    Where a file may not have sparse accessors, a shape of a region takes as much as one of all, so
    there are no regions.
    """
    fitted = [_fitted(piece, packing, check) for piece in motion.pieces]
    counts = {each.piece.name: each.count for each in fitted}
    error = max(each.max_error for each in fitted)
    told = {"basis": counts["skin"], "shapes": counts, "max_error_mm": promised(error)}
    turns = _turns(motion, fitted[0], packing.sparse)

    def add(builder: GlbBuilder, face: DrawnFace, pivots: Mapping[str, Pivot]) -> list[Channel]:
        channels = []
        for own in fitted:
            skin = own.piece.part is None
            node = add_piece(
                builder,
                face,
                pivots["head"],
                own.piece,
                names=[f"shape_{number:02d}" for number in range(own.count)],
                moves=list(own.shapes()),
                turns=turns if skin else (),
                smallest=0.0,
                smallest_turn=0.0,
                grid=own.grid,
                rows=own.rows(),
            )
            if skin or any(region.basis.shapes.any() for region in own.regions):
                channels.append(Channel(node, "weights", own.weights(motion.shown).ravel()))
        return channels

    return Fit(add, told)


def _fitted(piece: Piece, packing: Packing, check: Check) -> _Fitted:
    """Return the shapes of a piece: by regions where they may be, and are fewer than the frames.

    In a clip of few frames little has gone its own way yet, and five regions would have more shapes
    than the clip has frames.
    """
    if packing.sparse and piece.part is None:
        own = _fitted_by(regions_of(piece.rest), piece, packing, check)
        if own.count < len(piece.motion):
            return own
    return _fitted_by([np.arange(len(piece.rest))], piece, packing, check)


def _fitted_by(areas: list[IntArray], piece: Piece, packing: Packing, check: Check) -> _Fitted:
    """Return the shapes of areas, on a grid where they fit on it within the tolerance.

    Very many shapes may add up what each loses by rounding: those are not rounded.
    """
    grid = packing.grid(metres(piece.rest))
    for own in (grid, Grid()):
        tolerance = packing.tolerance - ROUNDING
        regions = [
            _region(_FromStored(piece, area, own), area, own, tolerance, packing.sparse, check)
            for area in areas
        ]
        error = max(region.basis.max_error for region in regions)
        if error <= tolerance:
            break
    moving = [region for region in regions if region.basis.shapes.any()]
    return _Fitted(piece, tuple(moving or regions[:1]), own, error)


def _region(
    motion: Motion,
    vertices: IntArray,
    grid: Grid,
    tolerance: float,
    sparse: bool,
    check: Check,
) -> _Region:
    basis = fit_basis(
        motion,
        tolerance=tolerance,
        step=grid.step * 1e3,
        sparse=sparse,
        check=check,
    )
    return _Region(vertices, basis)


class _FromStored:
    """The motion of some vertices of a piece, from where they are stored at rest.

    So what a grid takes from their places is a part of the motion, and of the error.
    """

    def __init__(self, piece: Piece, vertices: IntArray, grid: Grid) -> None:
        self._motion = piece.motion
        self._vertices = vertices
        self._off: Float32Array = (grid.off(metres(piece.rest)) * 1e3).astype(np.float32)[vertices]

    def __len__(self) -> int:
        return len(self._motion)

    def __getitem__(self, frames: slice | IntArray, /) -> Float32Array:
        return np.asarray(self._motion[frames][:, self._vertices] + self._off)


def _turns(motion: ClipMotion, fitted: _Fitted, sparse: bool) -> list[Float32Array]:
    """Return the change of the skin's normals that best goes with each shape, shape (d, 3) each.

    Normals are not linear in the positions, so this is a least-squares fit over the frames.
    """
    count = len(motion.displacements)
    chosen: IntArray = np.unique(np.linspace(0, count - 1, NORMAL_FRAMES).round().astype(np.int64))
    changes = motion.drawer.turns(motion.displacements[chosen])
    turns = []
    for region in fitted.regions:
        pulls = region.basis.pulls[chosen]
        # A little damping: shapes that none of these frames uses get no normals instead of noise.
        squares = pulls.T @ pulls
        squares += DAMPING * max(np.trace(squares), 1e-12) * np.eye(len(squares))
        wanted = np.ascontiguousarray(changes[:, region.vertices])
        own = np.linalg.solve(squares, pulls.T) @ wanted.reshape(len(chosen), -1)
        if sparse:
            own = spared(wanted, own, pulls, TURN_ERROR)
        # Both ways at first, as the shapes were, for then most of a shape's normals are small.
        onto, _ = positive(np.eye(len(own)), region.basis.pulls)
        for turn in (onto @ own).astype(np.float32).reshape(len(onto), -1, 3):
            turns.append(_spread(turn, region.vertices, changes.shape[1]))
    return turns


def _spread(values: Float32Array, vertices: IntArray, count: int) -> Float32Array:
    """Return values of some vertices among zeros for all, shape (v, 3)."""
    spread = np.zeros((count, 3), np.float32)
    spread[vertices] = values
    return spread
