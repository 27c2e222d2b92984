"""The three layers of nodes under a surface, at depths that turn no element inside out (5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from ..cache import cached_arrays, content_key
from ..head import Head
from ..sources import ENGINE_HASH
from .parameters import TissueParameters

NORMAL_SMOOTHING_ROUNDS = 3
LEAST_AREA_SHARE = 0.3
"""Share of its area, along its own normal, that every triangle keeps in the deepest layer."""
LEAST_BONE_DEPTH_MM = 2.0
LEAST_SLANT = 0.35
"""Least cosine between a node's inward line and the normal of any element around it."""
BENDING_ROUNDS = 400
LEAST_HEIGHT = 0.12
"""Least height of an element, as a share of its columns' length."""
LEAST_SHARE = 0.05
"""Share of its depth that each node is traced to at least; less is no layer."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """The tissue surface as the assembly needs it.

    Attributes:
        points: Epidermis nodes at rest, mm, shape (n, 3).
        polygons: Quads over the nodes; a triangle's last corner is -1, shape (p, 4).
        triangles: Both ways of splitting each quad, and the triangles, shape (t, 3).
        elements: One way of splitting them, as the head is drawn, shape (e, 3).
        edges: Node pairs, lower index first, shape (e, 2).
        edge_area: Area of the polygons at each edge, mm², shape (e,).
        polygon_area: mm², shape (p,).
        node_area: Each node's share of its polygons' area, mm², shape (n,).
        neighbor_mean: Row-normalised adjacency, shape (n, n).
        edge_polygons: Number of polygons at each edge, shape (e,).
        polygon_regions: Region label of each polygon.
    """

    points: FloatArray
    polygons: IntArray
    triangles: IntArray
    elements: IntArray
    edges: IntArray
    edge_area: FloatArray
    polygon_area: FloatArray
    node_area: FloatArray
    neighbor_mean: sp.csr_array
    edge_polygons: IntArray
    polygon_regions: tuple[str, ...]

    @property
    def quads(self) -> IntArray:
        """Polygons with four corners, shape (q, 4)."""
        return self.polygons[self.polygons[:, 3] >= 0]

    @property
    def is_quad(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which polygons have four corners, shape (p,)."""
        return np.asarray(self.polygons[:, 3] >= 0)


@dataclass(frozen=True, eq=False)
class Layers:
    """Nodes of the three layers and what lies under them.

    Attributes:
        nodes: Rest positions, epidermis, dermis, hypodermis, mm, shape (3 n, 3).
        normals: Smoothed outward normals, shape (n, 3).
        bone: Foot of each node on the skull, mm, shape (n, 3).
        depth: Depth to bone by region, mm, shape (n,).
        share: Share of the wished depths that each node is traced to, shape (n,).
    """

    nodes: FloatArray
    normals: FloatArray
    bone: FloatArray
    depth: FloatArray
    share: FloatArray


def sheet_of(head: Head) -> Sheet:
    """Return the simulated surface of `head` with its edges and areas."""
    n = head.sheet_count
    points = head.points[:n]
    polygons = head.polygons
    quad = polygons[:, 3] >= 0
    q, t = polygons[quad], polygons[~quad][:, :3]
    triangles = np.concatenate(
        [t, q[:, [0, 1, 2]], q[:, [0, 2, 3]], q[:, [0, 1, 3]], q[:, [1, 2, 3]]]
    )
    area = np.zeros(len(polygons))
    area[~quad] = triangle_areas(points, t)
    area[quad] = triangle_areas(points, q[:, [0, 1, 2]]) + triangle_areas(points, q[:, [0, 2, 3]])
    corner_count = np.where(quad, 4, 3)
    node_area = np.zeros(n)
    sides, side_polygon = [], []
    for k in range(4):
        has = corner_count > k
        here = polygons[has, k]
        following = np.where(
            k + 1 < corner_count[has], polygons[has, (k + 1) % 4], polygons[has, 0]
        )
        np.add.at(node_area, here, area[has] / corner_count[has])
        sides.append(np.sort(np.stack([here, following], axis=1), axis=1))
        side_polygon.append(np.flatnonzero(has))
    edges, index, count = np.unique(
        np.concatenate(sides), axis=0, return_inverse=True, return_counts=True
    )
    edge_area: FloatArray = np.zeros(len(edges))
    np.add.at(edge_area, index.ravel(), area[np.concatenate(side_polygon)])
    ends = np.concatenate([edges, edges[:, ::-1]])
    adjacency = sp.csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n, n))
    degree = np.maximum(np.asarray(adjacency.sum(axis=1)).ravel(), 1.0)
    mean = sp.csr_array(sp.diags_array(1.0 / degree) @ adjacency)
    return Sheet(
        points,
        polygons,
        triangles,
        head.triangles[(head.triangles < n).all(axis=1)],
        edges,
        edge_area,
        area,
        node_area,
        mean,
        count,
        head.polygon_regions,
    )


def stack_layers(
    sheet: Sheet, parameters: TissueParameters, depth: FloatArray, dermis: FloatArray
) -> Layers:
    """Trace the dermis and hypodermis nodes inwards from `sheet`.

    Args:
        sheet: The surface.
        parameters: Constants of the tissue.
        depth: Skin to bone, mm, shape (n,).
        dermis: Epidermis to dermis, mm, shape (n,).

    Tracing plain normals turns elements inside out from 3 mm on at lips, lids and alae; so normals
    are smoothed, and depths shrunk where a triangle would lose too much of its area.
    """
    p = parameters
    if p.regional_depth:
        hypodermis = np.clip(p.hypodermis_share * depth, p.hypodermis_least, p.hypodermis_most)
    else:
        hypodermis = (depth - dermis) / 2.0
    normals = smooth_normals(sheet)
    share = safe_share(sheet, normals, dermis, hypodermis)
    below = (share * dermis)[:, None] * normals
    deepest = (share * (dermis + hypodermis))[:, None] * normals
    foot = np.minimum(depth, np.maximum(depth * share, LEAST_BONE_DEPTH_MM))
    points = sheet.points
    nodes = np.concatenate([points, points - below, points - deepest])
    return Layers(nodes, normals, points - foot[:, None] * normals, depth, share)


def smooth_normals(sheet: Sheet) -> FloatArray:
    """Return node normals, area-weighted, smoothed over neighbours, shape (n, 3); kept on disk."""
    neighbors = sheet.neighbor_mean.tocsr()
    key = content_key(
        ENGINE_HASH,
        sheet.points,
        sheet.triangles,
        sheet.elements,
        neighbors.indptr,
        neighbors.indices,
        neighbors.data,
    )
    return cached_arrays("normals", key, lambda: {"normals": _smoothed(sheet)})["normals"]


def _smoothed(sheet: Sheet) -> FloatArray:
    cross = triangle_normals(sheet.points, sheet.triangles)
    normals = np.zeros_like(sheet.points)
    for k in range(3):
        np.add.at(normals, sheet.triangles[:, k], cross)
    normals = _unit_rows(normals)
    for _ in range(NORMAL_SMOOTHING_ROUNDS):
        normals = _unit_rows(0.5 * normals + 0.5 * (sheet.neighbor_mean @ normals))
    return _inwards(sheet, normals)


def _inwards(sheet: Sheet, normals: FloatArray) -> FloatArray:
    """Return `normals` bent until each looks out of every element around its node.

    At the lids' margins and the corners of the lips, where skin folds sharply, a smoothed normal
    can lie in the plane of an element or behind it: traced along it, the element is inside out.
    """
    elements = sheet.elements
    outwards = _unit_rows(triangle_normals(sheet.points, elements))
    for _ in range(BENDING_ROUNDS):
        slant = np.einsum("tc,tkc->tk", outwards, normals[elements])
        short = np.maximum(LEAST_SLANT - slant, 0.0)
        if short.max() < 1.0e-3:
            return normals
        bend = np.zeros_like(normals)
        share = 0.5 * short**2 / short.max()
        np.add.at(bend, elements, share[:, :, None] * outwards[:, None])
        normals = _unit_rows(normals + bend)
    lowest = np.full(len(normals), 1.0)
    np.minimum.at(lowest, elements, np.einsum("tc,tkc->tk", outwards, normals[elements]))
    bent = normals.copy()
    for node in np.flatnonzero(lowest < LEAST_SLANT - 0.1):
        bent[node] = _outermost(outwards[(elements == node).any(axis=1)])
    return bent


def _outermost(normals: FloatArray) -> FloatArray:
    """Return the direction whose least cosine with `normals`, shape (k, 3), is greatest, (3,)."""
    direction = normals.mean(axis=0)
    for step in range(2000):
        direction = direction / np.linalg.norm(direction)
        direction = direction + 3.0 / (step + 10.0) * normals[(normals @ direction).argmin()]
    return np.asarray(direction / np.linalg.norm(direction))


def safe_share(
    sheet: Sheet, normals: FloatArray, dermis: FloatArray, hypodermis: FloatArray
) -> FloatArray:
    """Return the share of the depths to trace at each node, shape (n,), `LEAST_SHARE` to 1.

    Args:
        sheet: The surface.
        normals: Lines to trace against, shape (n, 3).
        dermis: Thickness of the upper layer of elements, mm, shape (n,).
        hypodermis: Thickness of the lower one, mm, shape (n,).
    """
    elements, points = sheet.elements, sheet.points
    rest = triangle_normals(points, elements)
    size = np.linalg.norm(rest, axis=1)
    share = np.ones(len(dermis))
    for _ in range(80):
        middle = points - normals * (dermis * share)[:, None]
        deepest = middle - normals * (hypodermis * share)[:, None]
        kept = (rest * triangle_normals(deepest, elements)).sum(axis=1) / size**2
        bad = kept < LEAST_AREA_SHARE
        for upper, lower in ((points, middle), (middle, deepest)):
            height = np.linalg.norm(upper - lower, axis=1)[elements].mean(axis=1)
            bad |= prism_volumes(upper, lower, elements) < 0.5 * LEAST_HEIGHT * size * height
        short = np.zeros(len(share), dtype=bool)
        short[elements[bad]] = True
        short &= share > LEAST_SHARE
        if not short.any():
            break
        share[short] *= 0.85
        share = np.minimum(share, 0.5 * share + 0.5 * (sheet.neighbor_mean @ share))
        share = np.maximum(share, LEAST_SHARE)
    return share


def prism_volumes(upper: FloatArray, lower: FloatArray, elements: IntArray) -> FloatArray:
    """Return the signed volume of the prisms between two layers of nodes, mm³, shape (e,).

    The triangle half way between the layers times the mean height of the columns, as the kernel
    takes it.
    """
    middle = 0.5 * (upper + lower)
    height = (upper - lower)[elements].mean(axis=1)
    return np.asarray(0.5 * (triangle_normals(middle, elements) * height).sum(axis=1))


def triangle_normals(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return cross products of two sides, shape (t, 3); length is twice the area."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a))


def triangle_areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return areas, mm², shape (t,)."""
    return np.asarray(0.5 * np.linalg.norm(triangle_normals(points, triangles), axis=1))


def _unit_rows(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12))
