"""The sparse map that carries the tissue's displacement to the drawn skin."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .subdivision import Limit

LOST_WEIGHT = 0.005
"""Sum of the sizes of the weights that each row may lose; 0.01 mm of error per 2 mm of difference
between far points and near ones."""
MOST_WEIGHTS = 128
"""A row keeps at most this many; 35 are usual."""
ROWS = 1024
"""How many rows are pruned at once."""


def surface_map(
    limit: Limit,
    level: int,
    drawn_vertices: IntArray,
    surface_points: IntArray,
) -> sp.csr_array:
    """Return drawn displacement from tissue displacement, sparse (d, s).

    Exact subdivision is limit mask times subdivision times the inverse of interpolation; the
    inverse reaches everywhere but decays by about 4 with each ring, so its far tail is left out.
    Cage points outside the tissue (scalp, neck) count as unmoved. Both halves carry the same
    weights.

    Args:
        limit: The interpolating surface.
        level: Level of the drawn vertices.
        drawn_vertices: Their indices in that level, shape (d,).
        surface_points: Cage index of each tissue point, shape (s,).
    """
    row_mirror = _places(limit.levels[level].mirror, drawn_vertices)
    column_mirror = _places(limit.levels[0].mirror, surface_points)
    control = _control(limit, surface_points)
    # A few rows at a time: all of them with every weight would take a hundred megabytes.
    firsts = _firsts(row_mirror)
    short = [
        pruned(np.asarray(limit.to_limit[level][drawn_vertices[rows]] @ control))
        for rows in np.split(firsts, range(ROWS, len(firsts), ROWS))
    ]
    return _mirrored(sp.csr_array(sp.vstack(short)), row_mirror, column_mirror)


def _places(mirror: IntArray, chosen: IntArray) -> IntArray:
    """Return the mirror image of each chosen vertex as a place among the chosen."""
    place = np.full(len(mirror), -1)
    place[chosen] = np.arange(len(chosen))
    return place[mirror[chosen]]


def _firsts(rows: IntArray) -> IntArray:
    """Return the first of each pair of mirrored rows, and the rows that are their own image."""
    return np.flatnonzero(np.arange(len(rows)) <= rows)


def _mirrored(half: sp.csr_array, rows: IntArray, columns: IntArray) -> sp.csr_array:
    """Return the whole map of which `half` has the rows of `_firsts`.

    Pruning breaks ties between equal weights by chance; symmetric tissue shall move symmetrically.
    """
    number = np.arange(len(rows))
    own = np.where(rows == number, 0.5, (number < rows).astype(float))
    place = np.zeros(len(rows), dtype=np.int64)
    place[_firsts(rows)] = np.arange(half.shape[0])
    whole = sp.csr_array(half[place[np.minimum(number, rows)]])
    reflected = sp.csr_array((whole.data, columns[whole.indices], whole.indptr), shape=whole.shape)
    both = sp.diags_array(own) @ whole + sp.diags_array(1 - own) @ reflected
    result = sp.csr_array(both)
    result.eliminate_zeros()
    result.sort_indices()
    return result


def exact_map(
    limit: Limit, level: int, drawn_vertices: IntArray, surface_points: IntArray
) -> FloatArray:
    """Return the same map with every weight, dense (d, s)."""
    return np.asarray(limit.to_limit[level][drawn_vertices] @ _control(limit, surface_points))


def _control(limit: Limit, surface_points: IntArray) -> FloatArray:
    """Return what each tissue point moved by one makes of all control points, dense (v, s)."""
    cage_size = limit.to_limit[0].shape[0]
    unit = np.zeros((cage_size, len(surface_points)))
    unit[surface_points, np.arange(len(surface_points))] = 1.0
    return np.asarray(limit.solver.solve(unit))


def pruned(exact: FloatArray) -> sp.csr_array:
    """Return `exact` (d, s) without the tail of each row, each row's sum kept.

    The sum is what a row makes of a displacement common to all points; what pruning takes is given
    back in proportion to the weights that stay.
    """
    rows = np.arange(len(exact))[:, None]
    size = np.abs(exact)
    width = min(MOST_WEIGHTS, exact.shape[1])
    columns = np.argpartition(-size, width - 1, axis=1)[:, :width]
    order = np.argsort(-size[rows, columns], axis=1, kind="stable")
    columns = columns[rows, order]
    largest = size[rows, columns]
    # What would be lost by stopping before each weight.
    tail = size.sum(axis=1, keepdims=True) - largest.cumsum(axis=1) + largest
    weights = np.where(tail > LOST_WEIGHT, exact[rows, columns], 0.0)
    lost = exact.sum(axis=1) - weights.sum(axis=1)
    kept = np.abs(weights)
    weights += kept * (lost / np.maximum(kept.sum(axis=1), 1e-12))[:, None]
    matrix = sp.csr_array(
        (weights.ravel(), (np.broadcast_to(rows, columns.shape).ravel(), columns.ravel())),
        shape=exact.shape,
    )
    matrix.eliminate_zeros()
    matrix.sort_indices()
    return matrix
