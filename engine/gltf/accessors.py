"""The numbers of a GLB file: buffer views and accessors, dense, sparse or all zero.

Layout rules are those of the glTF 2.0 specification, section 3.6.
"""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import IntArray
from .library import Array, append, pygltflib
from .packing import Grid, Packing, packed_turns

_COMPONENTS = {
    "int8": "BYTE",
    "int16": "SHORT",
    "float32": "FLOAT",
    "uint32": "UNSIGNED_INT",
    "uint16": "UNSIGNED_SHORT",
    "uint8": "UNSIGNED_BYTE",
}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_SPARSE_GAIN = 0.9
"""A sparse accessor must be at least this much smaller, for it costs the reader a pass."""


def metres(millimetres: Array) -> npt.NDArray[np.float32]:
    """Return lengths in metres, single precision, as glTF wants them."""
    return np.asarray(np.asarray(millimetres, dtype=np.float64) * 1e-3, dtype=np.float32)


def compact_indices(indices: Array) -> Array:
    """Return `indices` in the smallest type that every reader takes: uint16, else uint32."""
    # 65535 itself is the primitive restart value and may not be used.
    small = indices.size == 0 or int(indices.max()) < 65535
    return np.asarray(indices, dtype=np.uint16 if small else np.uint32)


class Accessors:
    """Collects what a file stores as numbers; indices that it returns are glTF indices."""

    def __init__(self, gltf: Any, packing: Packing) -> None:
        """Begin with none.

        Args:
            gltf: The file; pygltflib is annotated in part only, and wrongly where targets may be
                plain dicts.
            packing: How numbers are stored.
        """
        self.packing = packing
        self._gltf = gltf
        self._blob = bytearray()
        self._stored: dict[tuple[object, ...], int] = {}
        self._zeros: dict[int, int] = {}
        self._rows, self._values = _Pool(), _Pool()
        self._row_lists: dict[tuple[str, bytes], int] = {}

    def view(self, data: Array) -> int:
        """Store bytes that are no vertices; return their buffer view."""
        return self._view(data, None)

    def accessor(
        self,
        array: Array,
        *,
        target: int | None = None,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Store `array`, shape (n,) or (n, 2 to 4), and return its accessor; equal ones share it.

        Args:
            array: float32, or integers of 8, 16 or 32 bits.
            target: ARRAY_BUFFER or ELEMENT_ARRAY_BUFFER for vertex data, None for the rest.
            bounds: State the smallest and largest value per component.
            normalized: Whether integers stand for -1 to 1, or 0 to 1.
        """
        digest = hashlib.sha256(np.ascontiguousarray(array).tobytes()).digest()
        key = (digest, array.shape, array.dtype, target, bounds, normalized)
        if key not in self._stored:  # Both eyes have the same triangles.
            accessor = self._describe(array.shape, array.dtype)
            accessor.bufferView = self._view(array, target)
            accessor.normalized = normalized or None
            if bounds:
                _state_bounds(accessor, array)
            self._stored[key] = append(self._gltf.accessors, accessor)
        return self._stored[key]

    def moves(
        self, moves: Array, *, smallest: float, grid: Grid, within: IntArray | None = None
    ) -> int:
        """Store the displacements of a morph target [m], shape (n, 3), on the grid of its mesh.

        Those whose components all stay below `smallest` are taken as none. Targets that move
        vertices of the same rows only, those `within`, may share the list of them.
        """
        kept = np.where((np.abs(moves) >= smallest).any(axis=1, keepdims=True), moves, 0.0)
        return self._delta(grid.moves(kept.astype(np.float32)), bounds=True, within=within)

    def turns(self, turns: Array, *, smallest: float, within: IntArray | None = None) -> int:
        """Store the changes of normals of a morph target, shape (n, 3), those above `smallest`."""
        kept = np.where((np.abs(turns) >= smallest).any(axis=1, keepdims=True), turns, 0.0)
        if self.packing.quantize:
            return self._delta(packed_turns(kept), normalized=True, within=within)
        return self._delta(kept.astype(np.float32), within=within)

    def _delta(
        self,
        array: Array,
        *,
        bounds: bool = False,
        normalized: bool = False,
        within: IntArray | None = None,
    ) -> int:
        """Store a morph target attribute, shape (n, 3), sparse where that may be and is smaller."""
        rows = np.flatnonzero(array.any(axis=1))
        if rows.size == 0 and self.packing.sparse:
            return self._zero(len(array))
        each = int(array[0].nbytes)
        size = len(rows) * (compact_indices(rows).itemsize + each)
        if within is not None and len(within) * each < size:
            # A few zeros more, and a list of rows that others share.
            rows, size = within, len(within) * each
        if not self.packing.sparse or size > _SPARSE_GAIN * len(array) * _stride(array):
            return self.accessor(
                array, target=pygltflib.ARRAY_BUFFER, bounds=bounds, normalized=normalized
            )
        values = np.ascontiguousarray(array[rows])
        indices = compact_indices(rows)
        accessor = self._describe(array.shape, array.dtype)
        accessor.normalized = normalized or None
        accessor.sparse = pygltflib.Sparse(
            count=len(rows),
            indices=pygltflib.AccessorSparseIndices(
                bufferView=self._pooled(self._rows),
                byteOffset=self._row_list(indices) or None,
                componentType=getattr(pygltflib, _COMPONENTS[indices.dtype.name]),
            ),
            values=pygltflib.AccessorSparseValues(
                bufferView=self._pooled(self._values), byteOffset=self._values.add(values) or None
            ),
        )
        if bounds:
            kept = np.concatenate([values, np.zeros((1, 3), values.dtype)])
            _state_bounds(accessor, kept if len(rows) < len(array) else values)
        return append(self._gltf.accessors, accessor)

    def _row_list(self, indices: Array) -> int:
        """Store the rows of a sparse accessor, equal ones once; return where among all they are."""
        key = (indices.dtype.name, indices.tobytes())
        if key not in self._row_lists:
            self._row_lists[key] = self._rows.add(indices)
        return self._row_lists[key]

    def _pooled(self, pool: _Pool) -> int:
        """Return the buffer view of a pool, whose bytes come last."""
        if pool.view is None:
            pool.view = append(self._gltf.bufferViews, pygltflib.BufferView(buffer=0))
        return pool.view

    def _zero(self, count: int) -> int:
        """Return an accessor of `count` zero vectors, which takes no bytes (section 3.6.2.3)."""
        if count not in self._zeros:
            accessor = self._describe((count, 3), np.dtype(np.float32))
            _state_bounds(accessor, np.zeros((1, 3), np.float32))
            self._zeros[count] = append(self._gltf.accessors, accessor)
        return self._zeros[count]

    def _describe(self, shape: tuple[int, ...], dtype: np.dtype[Any]) -> pygltflib.Accessor:
        return pygltflib.Accessor(
            # No offset: pygltflib would write one for accessors without a buffer view too.
            byteOffset=None,
            componentType=getattr(pygltflib, _COMPONENTS[dtype.name]),
            count=shape[0],
            type=_TYPES[shape[1] if len(shape) > 1 else 1],
        )

    def _view(self, array: Array, target: int | None) -> int:
        stride = _stride(array) if target == pygltflib.ARRAY_BUFFER else array[0].nbytes
        padded = stride > array[0].nbytes
        if padded:
            # Vertex attributes begin at multiples of four bytes (section 3.6.2.4).
            wide = np.zeros((len(array), stride // array.itemsize), array.dtype)
            wide[:, : array[0].size] = array.reshape(len(array), -1)
            array = wide
        data = np.ascontiguousarray(array).tobytes()
        view = pygltflib.BufferView(
            buffer=0,
            byteOffset=len(self._blob),
            byteLength=len(data),
            byteStride=stride if padded else None,
            target=target,
        )
        self._blob += data + bytes(-len(data) % 4)
        return append(self._gltf.bufferViews, view)

    def buffer(self) -> bytes:
        """Return what the file stores, once there is nothing more to come."""
        for pool in (self._rows, self._values):
            if pool.view is not None:
                view = self._gltf.bufferViews[pool.view]
                view.byteOffset, view.byteLength = len(self._blob), len(pool.data)
                self._blob += pool.data + bytes(-len(pool.data) % 4)
        return bytes(self._blob)


class _Pool:
    """Bytes of many sparse accessors in one buffer view: a view each takes more than some hold."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.view: int | None = None

    def add(self, array: Array) -> int:
        """Add an array; return where it begins, a multiple of four."""
        self.data += bytes(-len(self.data) % 4)
        place = len(self.data)
        self.data += array.tobytes()
        return place


def _stride(array: Array) -> int:
    """Return the bytes from one vertex to the next, a multiple of four."""
    return int(array[0].nbytes + 3) // 4 * 4


def _state_bounds(accessor: pygltflib.Accessor, array: Array) -> None:
    accessor.min = np.atleast_1d(array.min(axis=0)).tolist()
    accessor.max = np.atleast_1d(array.max(axis=0)).tolist()
