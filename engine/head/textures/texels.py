"""The texture's texels on the skin: which triangle each lies in, and what its corners say there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ...arrays import Float32Array, FloatArray, IntArray
from ...compiling import kept

Image = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Texels:
    """The texels of a square map that lie on the skin, n of them.

    Attributes:
        size: Texels a side.
        rows: Row of each, from the top, shape (n,).
        columns: Shape (n,).
        corners: The three vertices around each, shape (n, 3).
        shares: Their weights, shape (n, 3).
        width: Of a texel on the skin [mm], shape (n,).
    """

    size: int
    rows: IntArray
    columns: IntArray
    corners: IntArray
    shares: Float32Array
    width: Float32Array

    @classmethod
    def of(cls, uvs: FloatArray, triangles: IntArray, vertices: FloatArray, size: int) -> Texels:
        """Return the texels of a map of `size` a side.

        Args:
            uvs: Place of each vertex, origin top left, shape (d, 2).
            triangles: Shape (t, 3).
            vertices: Positions [mm], shape (d, 3).
            size: Texels a side.
        """
        owner = np.full((size, size), -1, dtype=np.int32)
        shares = np.zeros((size, size, 3), dtype=np.float32)
        _rasterise(uvs * size, triangles, owner, shares)
        rows, columns = np.nonzero(owner >= 0)
        triangle = owner[rows, columns]
        return cls(
            size,
            rows,
            columns,
            triangles[triangle],
            shares[rows, columns],
            _texel_widths(uvs * size, triangles, vertices)[triangle],
        )

    def carried(self, values: FloatArray) -> Float32Array:
        """Return what vertices hold, shape (d,) or (d, k), at the texels: (n,) or (n, k)."""
        # In one layout, for which the kernel is compiled once.
        table = np.ascontiguousarray(values.reshape(len(values), -1), dtype=np.float32)
        found = np.empty((len(self.corners), table.shape[1]), dtype=np.float32)
        _carry(table, self.corners, self.shares, found)
        return found[:, 0] if values.ndim == 1 else found

    def image(self, values: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
        """Return texels (n,) or (n, k) as a map, what is not skin filled from the nearest skin."""
        nearest = self._nearest
        return np.asarray(values[nearest])

    @cached_property
    def _nearest(self) -> IntArray:
        """The texel of the skin nearest to each place on the map, shape (size, size)."""
        from scipy.ndimage import distance_transform_edt  # Here: a start does without.

        index = np.full((self.size, self.size), -1)
        index[self.rows, self.columns] = np.arange(len(self.rows))
        places = distance_transform_edt(index < 0, return_distances=False, return_indices=True)
        return np.asarray(index[places[0], places[1]])


@kept(nogil=True)
def _rasterise(
    places: FloatArray, triangles: IntArray, owner: npt.NDArray[np.int32], shares: Float32Array
) -> None:
    """Write the triangle at each texel's middle and the weights of its corners."""
    size = len(owner)
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x0, y0 = places[a, 0] - 0.5, places[a, 1] - 0.5
        x1, y1 = places[b, 0] - 0.5, places[b, 1] - 0.5
        x2, y2 = places[c, 0] - 0.5, places[c, 1] - 0.5
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if abs(area) < 1e-12:
            continue
        left, right = int(np.ceil(min(x0, x1, x2) - 1e-6)), int(max(x0, x1, x2) + 1e-6)
        top, bottom = int(np.ceil(min(y0, y1, y2) - 1e-6)), int(max(y0, y1, y2) + 1e-6)
        for y in range(max(top, 0), min(bottom, size - 1) + 1):
            for x in range(max(left, 0), min(right, size - 1) + 1):
                s0 = ((x1 - x) * (y2 - y) - (x2 - x) * (y1 - y)) / area
                s1 = ((x2 - x) * (y0 - y) - (x0 - x) * (y2 - y)) / area
                s2 = 1 - s0 - s1
                if s0 >= -1e-6 and s1 >= -1e-6 and s2 >= -1e-6:
                    owner[y, x] = t
                    shares[y, x, 0], shares[y, x, 1], shares[y, x, 2] = s0, s1, s2


@kept(nogil=True)
def _carry(
    table: Float32Array, corners: IntArray, shares: Float32Array, found: Float32Array
) -> None:
    for n in range(len(corners)):
        a, b, c = corners[n, 0], corners[n, 1], corners[n, 2]
        for k in range(table.shape[1]):
            found[n, k] = (
                table[a, k] * shares[n, 0] + table[b, k] * shares[n, 1] + table[c, k] * shares[n, 2]
            )


def _texel_widths(places: FloatArray, triangles: IntArray, vertices: FloatArray) -> Float32Array:
    """Return the width on the skin of a texel of each triangle [mm], shape (t,)."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    on_skin = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    p, q, r = (places[triangles[:, corner]] for corner in range(3))
    u, v = q - p, r - p
    on_map = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return np.asarray(np.sqrt(on_skin / np.maximum(on_map, 1e-9)), dtype=np.float32)
