"""How numbers of a mesh are stored: as they are, or on grids of a few bits.

The grids are those of KHR_mesh_quantization, and of the normalised integers that glTF 2.0 has
for colours, texture coordinates and animated weights (sections 3.6.2.2 and 3.11).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray

EXTENSION = "KHR_mesh_quantization"
SHARE_OF_STEP = 1 / 16
"""Step of the grid that places are stored on, as a share of the tolerance."""
WEIGHT_STEPS = 32767
"""Steps of a weight, 0 to 1, that is stored as a normalised int16."""
MOST_STEPS = 32_000
"""Steps from the middle of a mesh to its farthest vertex; an int16 has a few more."""

GREATEST_STEP = 32767
"""The greatest number of an int16: no move on a grid is farther."""

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class Packing:
    """How a file stores its meshes.

    Attributes:
        quantize: Whether numbers are put on grids, by `KHR_mesh_quantization`.
        sparse: Whether accessors may be sparse, where that is smaller.
        tolerance: Largest error that the file may have [mm].
    """

    quantize: bool = False
    sparse: bool = True
    tolerance: float = 0.1

    def grid(self, places: Array) -> Grid:
        """Return the grid of a mesh with vertices at these places [m], shape (v, 3)."""
        if not self.quantize:
            return Grid()
        low, high = places.min(axis=0), places.max(axis=0)
        origin = (low.astype(np.float64) + high) / 2
        least = float(np.abs(places - origin).max()) / MOST_STEPS
        step = max(self.tolerance * SHARE_OF_STEP * 1e-3, least)
        return Grid(origin.astype(np.float32).astype(np.float64), float(np.float32(step)))


@dataclass(frozen=True, eq=False)
class Grid:
    """Where a mesh's numbers lie, in metres: place = origin + step x number.

    Attributes:
        origin: In the node's frame, shape (3,); None for places that are stored as they are.
        step: Of the grid; 0 for none.
    """

    origin: FloatArray | None = None
    step: float = 0.0

    def places(self, places: Array) -> Array:
        """Return places [m], shape (v, 3), as they are stored."""
        if self.origin is None:
            return places
        return np.asarray(np.rint((places - self.origin) / self.step), np.int16)

    def off(self, places: Array) -> Array:
        """Return how far places [m], shape (v, 3), are from where they are stored."""
        if self.origin is None:
            return np.zeros_like(places)
        return places - (self.origin + self.step * self.places(places))

    def moves(self, moves: Array) -> Array:
        """Return displacements [m], shape (v, 3), as they are stored."""
        if self.origin is None:
            return moves
        steps = np.rint(moves / np.float64(self.step))
        return np.asarray(steps, np.int8 if np.abs(steps).max(initial=0) <= 127 else np.int16)

    @property
    def error(self) -> float:
        """How far a vertex at rest may be from where it should be, m."""
        return self.step / 2 * float(np.sqrt(3))


def packed(name: str, values: Array) -> Array:
    """Return a vertex attribute, or a change of one, as normalised integers.

    Normals and tangents get 8 bits with a sign, places in a texture 16, colours and all else 8.
    """
    if name == "NORMAL":
        return packed_normals(values)
    if name == "TANGENT":
        return np.asarray(np.rint(np.clip(values, -1, 1) * 127), np.int8)
    if name.startswith("TEXCOORD"):
        return np.asarray(np.rint(np.clip(values, 0, 1) * 65535), np.uint16)
    return np.asarray(np.rint(np.clip(values, 0, 1) * 255), np.uint8)


def packed_turns(changes: Array) -> Array:
    """Return changes of normals, shape (v, 3), as int8."""
    return np.asarray(np.rint(np.clip(changes, -1, 1) * 127), np.int8)


def packed_normals(normals: Array) -> Array:
    """Return unit normals, shape (v, 3), as int8, of a length that counts as one.

    Of the corners of the grid's cell around a normal the one whose length is nearest to one is
    taken, where the nearest corner's is not near enough.
    """
    scaled = np.asarray(normals, np.float64) * 127
    nearest = np.rint(scaled)
    best = nearest.copy()
    wrong = np.abs(np.linalg.norm(nearest, axis=1) / 127 - 1) > 0.005
    if wrong.any():
        low = np.floor(scaled[wrong])
        corners = np.stack([low + corner for corner in np.ndindex(2, 2, 2)])
        off = np.abs(np.linalg.norm(corners, axis=2) / 127 - 1)
        best[wrong] = np.take_along_axis(corners, off.argmin(axis=0)[None, :, None], axis=0)[0]
    return np.asarray(np.clip(best, -127, 127), np.int8)
