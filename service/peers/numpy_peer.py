"""The peer in plain NumPy: rows by indexing, forces by sums over each node's own list.

Tried for the sums: of 16 faces `np.add.reduceat` takes almost four times as long; of one face
`np.add.at` is faster than that, than `np.bincount` and than the lists. Float32 halves what moves
through the cache, which is what an array operation waits for.
"""

from __future__ import annotations

import numpy as np

from engine.arrays import Float32Array, IntArray

from .array_peer import ArrayPeer
from .common import installed_version


class Sum:
    """A sum of rows into nodes.

    Nodes are sorted by how many rows they take. Then the first row of each is one run of nodes, the
    second of each a shorter one, and so on: every run is one array operation.
    """

    def __init__(self, nodes: IntArray, count: int) -> None:
        """Make row k go to each of `nodes[:, k]`, shape (times, rows), of `count` nodes."""
        self._nodes = nodes
        rows = np.tile(np.arange(nodes.shape[1]), len(nodes))
        taken = np.bincount(nodes.ravel(), minlength=count)
        by_node = rows[np.argsort(nodes, axis=None, kind="stable")]
        start = np.concatenate([[0], np.cumsum(taken)[:-1]])
        order = np.argsort(-taken, kind="stable")
        self._place = np.argsort(order)
        self._runs: list[IntArray] = [
            by_node[start[order[taken[order] > turn]] + turn] for turn in range(taken.max())
        ]

    def into(self, force: Float32Array, rows: Float32Array) -> None:
        """Set `force`, shape (nodes, lanes), to the sums of `rows`, shape (rows, lanes)."""
        if force.shape[1] == 1:
            force[:] = 0.0
            for nodes in self._nodes:
                np.add.at(force[:, 0], nodes, rows[:, 0])
            return
        sums, spare = np.zeros_like(force), np.empty_like(force)
        for run in self._runs:
            sums[: len(run)] += _take(rows, run, spare[: len(run)])
        _take(sums, self._place, force)


class NumpyPeer(ArrayPeer):
    """Plain NumPy, float32."""

    name = "numpy"

    @property
    def version(self) -> str:
        """See `Peer`."""
        return installed_version("numpy")

    def _link(self) -> None:
        tables = self._tables
        n, nodes, springs, volumes = tables.points, tables.nodes, tables.springs, tables.volumes
        s, prisms, quads = len(springs.first), volumes.prisms.shape[1], volumes.quads.shape[1]
        a, b, c = volumes.prisms
        # Tensions and then their negatives; p, r and then minus their sum; h three times.
        self._tensions = Sum(np.concatenate([springs.first, springs.second])[None], nodes)
        self._turns = Sum(np.concatenate([b, c, a])[None], 2 * n)
        self._rises = Sum(volumes.prisms, 2 * n)
        self._fat = Sum(volumes.quads.reshape(1, -1), n)
        lanes = self._layout.lanes
        self._pairs = np.zeros((2 * s, lanes), np.float32)
        self._corners = np.zeros((3 * prisms, lanes), np.float32)
        self._columns = np.zeros((2, 2 * n, lanes), np.float32)
        self._pushes = np.zeros((4, quads, lanes), np.float32)
        self._middle = np.zeros((n, lanes), np.float32)

    def _gather(self, u: Float32Array, rows: Float32Array) -> None:
        springs, volumes = self._tables.springs, self._tables.volumes
        s, e, prisms = self._springs, self._elements, volumes.prisms.shape[1]
        n, (a, b, c), quads = self._tables.points, volumes.prisms, volumes.quads
        spare = self._scratch[0]
        means, heights = self._columns
        for x, row in zip(u, rows, strict=True):
            for chunk in self._chunks(s):
                near = _take(x, springs.first[chunk], spare[: chunk.stop - chunk.start])
                _take(x, springs.second[chunk], row[chunk])
                row[chunk] -= near
            p, r, h = row[s:].reshape(3, e, -1)[:, :prisms]
            np.add(x[: 2 * n], x[n:], out=means)
            means *= 0.5
            np.subtract(x[: 2 * n], x[n:], out=heights)
            heights *= 1.0 / 3.0
            near = _take(means, a, spare[:prisms])
            _take(means, b, p)
            p -= near
            _take(means, c, r)
            r -= near
            _take(heights, a, h)
            for corner in (b, c):
                h += _take(heights, corner, spare[:prisms])
            p, r, h = row[s:].reshape(3, e, -1)[:, prisms:]
            middle = (x[:n] + x[n : 2 * n] + x[2 * n :]) * np.float32(1.0 / 3.0)
            corners = np.take(middle, quads, axis=0)
            np.subtract(corners[2], corners[0], out=p)
            np.subtract(corners[3], corners[1], out=r)
            np.multiply(corners.sum(axis=0), 0.25, out=h)

    def _scatter(self, rows: Float32Array, force: Float32Array) -> None:
        s, e, n = self._springs, self._elements, self._tables.points
        prisms = self._tables.volumes.prisms.shape[1]
        by_turn, by_rise = self._columns
        for row, out in zip(rows, force, strict=True):
            self._pairs[:s] = row[:s]
            np.negative(row[:s], out=self._pairs[s:])
            self._tensions.into(out, self._pairs)
            p, r, h = row[s:].reshape(3, e, -1)[:, :prisms]
            np.add(p, r, out=self._corners[2 * prisms :])
            np.negative(self._corners[2 * prisms :], out=self._corners[2 * prisms :])
            self._corners[:prisms], self._corners[prisms : 2 * prisms] = p, r
            self._turns.into(by_turn, self._corners)
            self._rises.into(by_rise, h)
            by_turn *= 0.5
            by_rise *= 1.0 / 3.0
            out[: 2 * n] += by_turn
            out[: 2 * n] += by_rise
            out[n:] += by_turn
            out[n:] -= by_rise
            p, r, h = row[s:].reshape(3, e, -1)[:, prisms:]
            quarter = h * np.float32(0.25)
            for push, sign, turn in zip(self._pushes, (-1, -1, 1, 1), (p, r, p, r), strict=True):
                np.multiply(turn, sign, out=push)
                push += quarter
            self._fat.into(self._middle, self._pushes.reshape(-1, self._layout.lanes))
            self._middle *= 1.0 / 3.0
            out.reshape(3, n, -1)[:] += self._middle


def _take(table: Float32Array, index: IntArray, out: Float32Array) -> Float32Array:
    """Return `out` set to rows of `table`; mode "clip" keeps NumPy from buffering them."""
    return np.take(table, index, axis=0, out=out, mode="clip")
