"""The peer with SciPy's sparse matrices: rows and forces are products with one matrix.

Tried: one product for all three components takes two thirds of the time, but leaves them between
rows and lanes, where the laws of the terms would run over 16 numbers at a time. Products in float64
are faster of one face and slower of four.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from engine.arrays import Float32Array, FloatArray, IntArray

from .array_peer import ArrayPeer
from .common import installed_version


class ScipyPeer(ArrayPeer):
    """SciPy's sparse matrices in CSR, float32."""

    name = "scipy"

    @property
    def version(self) -> str:
        """See `Peer`."""
        return installed_version("scipy")

    def _link(self) -> None:
        tables = self._tables
        n, springs, volumes = tables.points, tables.springs, tables.volumes
        a, b, c = volumes.prisms
        q = volumes.quads
        # In the order of the rows: springs, then p, r and h, each of the prisms and of the fat.
        parts = [
            self._matrix([(springs.second, 1.0), (springs.first, -1.0)]),
            self._matrix([(k, w) for m, w in ((b, 0.5), (a, -0.5)) for k in (m, m + n)]),
            self._columns([(q[2], 1.0), (q[0], -1.0)]),
            self._matrix([(k, w) for m, w in ((c, 0.5), (a, -0.5)) for k in (m, m + n)]),
            self._columns([(q[3], 1.0), (q[1], -1.0)]),
            self._matrix([(m + d, w) for m in (a, b, c) for d, w in ((0, 1 / 3), (n, -1 / 3))]),
            self._columns([(corner, 0.25) for corner in q]),
        ]
        differences = sp.csr_array(sp.vstack(parts, format="csr"), dtype=np.float32)
        self._differences = differences
        signs = np.ones(differences.shape[0], np.float32)
        signs[: self._springs] = -1.0
        self._sums = sp.csr_array((differences * signs[:, None]).T.tocsr())

    def _matrix(self, terms: list[tuple[IntArray, float]]) -> sp.csr_array:
        """Return rows that weigh nodes: one row an entry of the terms' node lists."""
        rows = np.tile(np.arange(len(terms[0][0])), len(terms))
        columns = np.concatenate([nodes for nodes, _ in terms])
        weights: FloatArray = np.concatenate([np.full(len(nodes), w) for nodes, w in terms])
        shape = len(terms[0][0]), self._tables.nodes
        return sp.csr_array(sp.coo_array((weights, (rows, columns)), shape=shape))

    def _columns(self, terms: list[tuple[IntArray, float]]) -> sp.csr_array:
        """Return rows that weigh points of the mid-surface."""
        n = self._tables.points
        return self._matrix([(p + layer * n, w / 3.0) for p, w in terms for layer in range(3)])

    def _gather(self, u: Float32Array, rows: Float32Array) -> None:
        for component, row in zip(u, rows, strict=True):
            row[:] = self._differences @ component

    def _scatter(self, rows: Float32Array, force: Float32Array) -> None:
        for row, component in zip(rows, force, strict=True):
            component[:] = self._sums @ row
