"""Edges and neighbours of a mesh of quads and triangles, found without loops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Topology:
    """Who touches whom in a mesh.

    Attributes:
        vertex_count: Number of vertices, v.
        faces: Corners, shape (f, 4); -1 in the last column of a triangle.
        edges: Vertex pairs, the lower first, sorted, shape (e, 2).
        face_edges: Edge from each corner to the next, -1 where there is none, shape (f, 4).
        face_count_of_edge: How many faces share each edge, shape (e,).
    """

    vertex_count: int
    faces: IntArray
    edges: IntArray
    face_edges: IntArray
    face_count_of_edge: IntArray

    @classmethod
    def of(cls, faces: IntArray, vertex_count: int) -> Topology:
        """Return the topology of `faces`, shape (f, 4) or (f, 3)."""
        if faces.shape[1] == 3:
            faces = np.column_stack([faces, np.full(len(faces), -1)])
        starts, ends = faces, next_corners(faces)
        present = starts >= 0
        low, high = np.minimum(starts, ends)[present], np.maximum(starts, ends)[present]
        keys, edge_of_side, counts = np.unique(
            low * vertex_count + high, return_inverse=True, return_counts=True
        )
        face_edges = np.full(faces.shape, -1)
        face_edges[present] = edge_of_side
        edges = np.column_stack([keys // vertex_count, keys % vertex_count])
        return cls(vertex_count, faces, edges, face_edges, counts)

    @property
    def boundary_edges(self) -> BoolArray:
        """Whether only one face has each edge, shape (e,)."""
        return np.asarray(self.face_count_of_edge == 1)

    @property
    def boundary_vertices(self) -> BoolArray:
        """Whether each vertex lies on a boundary edge, shape (v,)."""
        on_boundary = np.zeros(self.vertex_count, dtype=bool)
        on_boundary[self.edges[self.boundary_edges]] = True
        return on_boundary

    @property
    def corner_counts(self) -> IntArray:
        """Number of corners of each face, shape (f,)."""
        return np.asarray((self.faces >= 0).sum(axis=1))

    def edge_index(self, first: IntArray, second: IntArray) -> IntArray:
        """Return the index of the edges between `first` and `second`, which must exist."""
        keys = self.edges[:, 0] * self.vertex_count + self.edges[:, 1]
        low, high = np.minimum(first, second), np.maximum(first, second)
        return np.searchsorted(keys, low * self.vertex_count + high)

    def faces_to_vertices(self) -> sp.csr_array:
        """Return the sparse incidence (f, v)."""
        return _incidence(self.faces, self.vertex_count)

    def faces_to_edges(self) -> sp.csr_array:
        """Return the sparse incidence (f, e)."""
        return _incidence(self.face_edges, len(self.edges))

    def edges_to_vertices(self) -> sp.csr_array:
        """Return the sparse incidence (e, v)."""
        return _incidence(self.edges, self.vertex_count)

    def neighbours(self, weights: FloatArray | None = None) -> sp.csr_array:
        """Return the row-normalised neighbour matrix (v, v), each edge weighted alike or given."""
        weight = np.ones(len(self.edges)) if weights is None else weights
        i, j = self.edges.T
        matrix = sp.csr_array(
            (np.r_[weight, weight], (np.r_[i, j], np.r_[j, i])),
            shape=(self.vertex_count, self.vertex_count),
        )
        total = matrix.sum(axis=1)
        return sp.csr_array(sp.diags_array(1 / np.where(total > 0, total, 1)) @ matrix)


def next_corners(faces: IntArray) -> IntArray:
    """Return for each corner of padded quads the corner after it, -1 where there is none."""
    following = np.roll(faces, -1, axis=1)
    triangle = faces[:, 3] < 0
    following[triangle, 2] = faces[triangle, 0]
    following[triangle, 3] = -1
    return following


def boundary_loops(topology: Topology) -> list[IntArray]:
    """Return the vertices of each connected piece of boundary, most vertices first."""
    edges = topology.edges[topology.boundary_edges]
    label = _pieces(edges, topology.vertex_count)
    members = np.unique(edges)
    loops = [members[label[members] == number] for number in np.unique(label[members])]
    return sorted(loops, key=len, reverse=True)


def components(topology: Topology) -> IntArray:
    """Return the number of the connected piece that each vertex belongs to, shape (v,)."""
    return _pieces(topology.edges, topology.vertex_count)


def _pieces(edges: IntArray, size: int) -> IntArray:
    from scipy.sparse.csgraph import connected_components  # Here: a start does without.

    graph = sp.coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    return np.asarray(label)


def _incidence(table: IntArray, column_count: int) -> sp.csr_array:
    row, place = np.nonzero(table >= 0)
    column = table[row, place]
    return sp.csr_array((np.ones(len(row)), (row, column)), shape=(len(table), column_count))
