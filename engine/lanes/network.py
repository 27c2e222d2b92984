"""The tissue of a rig arranged for the sweep: column by column, each with what reaches onwards.

A column is a node of the epidermis and the two below it. Columns are numbered so that neighbours
lie close in memory (reverse Cuthill-McKee), nodes by column and, within it, from the skin inwards.
Each spring, element and column of fat is listed with the lowest of its columns: when the sweep has
passed a column, everything that acts on it is known, and it can move at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy
import scipy.sparse as sp

from ..arrays import Float32Array, FloatArray, IntArray
from ..cache import cached_arrays, content_key
from ..dynamics import IndexArray, Tissue
from .vector import WIDTH

NODE = 3 * WIDTH
"""Numbers that a node takes: its x, y and z in every lane."""
COLUMN = 3 * NODE
"""Numbers that a column takes."""


class Network(NamedTuple):
    """What the sweep reads: offsets are of the first number of a node or column.

    Attributes:
        spring_start: First spring of each node, and the end, shape (nodes + 1,).
        spring_end: Offset of each spring's other node.
        rest, low, more, guard: d0, k_L, k_H - k_L, and the guard's stiffness.
        knee, brace: 1 + ε_c and 1 - ε_k, of the rest length at which k_H and the guard set in.
        element_start: First element of each column and gap, and the end, shape (2 columns + 1,).
        second, third: Offset of the upper node of each element's other two corners.
        volume: 1 / (24 V0): both of V's factors are twice, its height thrice what they should be.
        stiffness: k / (24 V0).
        order, least: As in `dynamics.Prisms`.
        fat_start: First column of fat of each column, and the end, shape (columns + 1,).
        fat_corners: Offset of each one's corners, shape (4 fat,).
        fat_volume, fat_stiffness: 1 / (216 V0) and k / (216 V0): heights are twelve times, each
            diagonal three times what it should be.
        tangential, normal: Of each column's tie.
        excess, excess_distance, skull, skull_gap: As in `dynamics.Anchors`.
        inverse_mass: Of each node.
        damping: c, 1/s.
    """

    spring_start: IndexArray
    spring_end: IndexArray
    rest: Float32Array
    low: Float32Array
    more: Float32Array
    guard: Float32Array
    knee: np.float32
    brace: np.float32
    element_start: IndexArray
    second: IndexArray
    third: IndexArray
    volume: Float32Array
    stiffness: Float32Array
    order: Float32Array
    least: np.float32
    fat_start: IndexArray
    fat_corners: IndexArray
    fat_volume: Float32Array
    fat_stiffness: Float32Array
    tangential: Float32Array
    normal: Float32Array
    excess: np.float32
    excess_distance: np.float32
    skull: np.float32
    skull_gap: np.float32
    inverse_mass: Float32Array
    damping: float


class Order(NamedTuple):
    """Where columns and nodes of the tissue's own order have gone.

    Attributes:
        columns: Column that stands at each place, shape (columns,).
        places: Place of each column, shape (columns,).
        nodes: Place of each node, shape (nodes,).
    """

    columns: IntArray
    places: IntArray
    nodes: IntArray


def order_columns(tissue: Tissue) -> Order:
    """Return the columns in an order in which neighbours are near.

    It is kept on disk: finding it takes little, but the library that does takes part of a start.
    """
    springs, count = tissue.springs, tissue.rest.shape[1]
    n = count // 3
    a, b = springs.first % n, springs.second % n
    key = content_key("columns", scipy.__version__, n, a, b)
    columns = cached_arrays("columns", key, lambda: {"columns": _nearby(n, a, b)})["columns"]
    places = np.empty(n, np.int64)
    places[columns] = np.arange(n)
    node = np.arange(count)
    return Order(columns, places, 3 * places[node % n] + node // n)


def _nearby(n: int, a: IntArray, b: IntArray) -> IntArray:
    """Return the columns 0 to n - 1, joined from `a` to `b`, in such an order."""
    from scipy.sparse.csgraph import reverse_cuthill_mckee  # Here: a start does without.

    joined = sp.csr_array((np.ones(2 * len(a)), (np.r_[a, b], np.r_[b, a])), shape=(n, n))
    return reverse_cuthill_mckee(sp.csr_array(joined), symmetric_mode=True).astype(np.int64)


def arrange(tissue: Tissue, order: Order) -> Network:
    """Return `tissue` as the sweep reads it.

    Args:
        tissue: With the continuous spring law, without plate.
        order: Of its columns.
    """
    n = len(order.columns)
    springs, prisms, fat, anchors = tissue.springs, tissue.prisms, tissue.pressure, tissue.anchors
    ends = np.sort(np.stack([order.nodes[springs.first], order.nodes[springs.second]]), axis=0)
    by_spring = np.lexsort((ends[1], ends[0]))
    lower, upper = ends[:, by_spring]
    gap = prisms.corners[:, 0] // n
    corners = order.places[prisms.corners % n]
    corners = _lowest_first(corners)
    by_element = np.lexsort((corners[:, 1], 2 * corners[:, 0] + gap))
    corners, gap = corners[by_element], gap[by_element]
    fat_columns = order.places[fat.quads]
    by_fat = np.argsort(fat_columns.min(axis=1), kind="stable")
    volume, stiffness = prisms.volume[by_element], prisms.stiffness[by_element]
    fat_volume = 216.0 * fat.volume[by_fat]
    mass = np.empty(3 * n)
    mass[order.nodes] = tissue.inverse_mass
    return Network(
        spring_start=_starts(lower, 3 * n),
        spring_end=_index(NODE * upper),
        rest=_float(springs.rest[by_spring]),
        low=_float(springs.low[by_spring]),
        more=_float((springs.high - springs.low)[by_spring]),
        guard=_float(springs.guard[by_spring]),
        knee=np.float32(1.0 + springs.threshold),
        brace=np.float32(1.0 - springs.guard_strain),
        element_start=_starts(2 * corners[:, 0] + gap, 2 * n),
        second=_index(COLUMN * corners[:, 1] + NODE * gap),
        third=_index(COLUMN * corners[:, 2] + NODE * gap),
        volume=_float(1.0 / (24.0 * volume)),
        stiffness=_float(stiffness / (24.0 * volume)),
        order=_float(prisms.order[by_element]),
        least=np.float32(prisms.least),
        fat_start=_starts(fat_columns[by_fat].min(axis=1), n),
        fat_corners=_index(COLUMN * fat_columns[by_fat].ravel()),
        fat_volume=_float(1.0 / fat_volume),
        fat_stiffness=_float(fat.stiffness[by_fat] / fat_volume),
        tangential=_float(anchors.tangential[order.columns]),
        normal=_float(anchors.normal[order.columns]),
        excess=np.float32(anchors.excess),
        excess_distance=np.float32(anchors.excess_distance),
        skull=np.float32(anchors.skull),
        skull_gap=np.float32(anchors.skull_gap),
        inverse_mass=_float(mass),
        damping=float(tissue.damping),
    )


def _lowest_first(corners: IntArray) -> IntArray:
    """Return triangles, shape (e, 3), turned so that each begins with its lowest corner."""
    turn = corners.argmin(axis=1)[:, None] + np.arange(3)
    return np.take_along_axis(corners, turn % 3, axis=1)


def _starts(owner: IntArray, count: int) -> IndexArray:
    """Return where each owner's run begins in a list sorted by owner, shape (count + 1,)."""
    return _index(np.searchsorted(owner, np.arange(count + 1)))


def _index(values: npt.NDArray[np.integer]) -> IndexArray:
    return np.ascontiguousarray(values, dtype=np.int32)


def _float(values: FloatArray) -> Float32Array:
    return np.ascontiguousarray(values, dtype=np.float32)
