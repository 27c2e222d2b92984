"""Catmull-Clark subdivision as sparse matrices, with semi-sharp creases and limit positions.

Catmull and Clark 1978; boundary, crease and limit rules after DeRose, Kass, Truong 1998
("Subdivision surfaces in character animation") and Halstead, Kass, DeRose 1993 (limit masks,
interpolation).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .topology import Topology

if TYPE_CHECKING:
    from scipy.sparse.linalg import SuperLU


@dataclass(frozen=True, eq=False)
class Level:
    """One level of refinement.

    Attributes:
        topology: The level's faces; vertex i of the coarser level is vertex i here.
        from_coarser: Control points of this level from those of the coarser, sparse.
        parents: Face of the cage that each face descends from, shape (f,).
        mirror: Mirror image of each vertex, shape (v,).
        face_mirror: Mirror image of each face, shape (f,).
        sharpness: Semi-sharp crease of each edge, 0 is smooth, shape (e,).
    """

    topology: Topology
    from_coarser: sp.csr_array
    parents: IntArray
    mirror: IntArray
    face_mirror: IntArray
    sharpness: FloatArray


def cage_level(topology: Topology, mirror: IntArray, sharpness: FloatArray) -> Level:
    """Return level 0, the cage itself; the second half of its faces mirrors the first."""
    half = len(topology.faces) // 2
    return Level(
        topology=topology,
        from_coarser=sp.eye_array(topology.vertex_count, format="csr"),
        parents=np.arange(len(topology.faces)),
        mirror=mirror,
        face_mirror=np.r_[np.arange(half, 2 * half), np.arange(half)],
        sharpness=sharpness,
    )


def refine(level: Level) -> Level:
    """Return the next finer level: old vertices, then edge points, then face points."""
    coarse = level.topology
    faces = _child_faces(coarse)
    size = coarse.vertex_count + len(coarse.edges) + len(coarse.faces)
    fine = Topology.of(faces, size)
    return Level(
        topology=fine,
        from_coarser=subdivision_matrix(coarse, level.sharpness),
        parents=np.repeat(level.parents, coarse.corner_counts),
        mirror=_child_mirror(level),
        face_mirror=_child_face_mirror(level),
        sharpness=_child_sharpness(coarse, fine, level.sharpness),
    )


def subdivision_matrix(topology: Topology, sharpness: FloatArray) -> sp.csr_array:
    """Return the matrix (v + e + f, v) from control points to those of the next level."""
    to_faces = sp.csr_array(
        sp.diags_array(1 / topology.corner_counts) @ topology.faces_to_vertices()
    )
    to_middles = topology.edges_to_vertices() * 0.5
    to_edges = _edge_rule(topology, sharpness, to_faces, to_middles)
    to_vertices = _vertex_rule(topology, sharpness, to_faces, to_middles)
    return sp.csr_array(sp.vstack([to_vertices, to_edges, to_faces]))


def _edge_rule(
    topology: Topology, sharpness: FloatArray, to_faces: sp.csr_array, to_middles: sp.csr_array
) -> sp.csr_array:
    """Smooth: mean of the middle and the two face points; sharp or boundary: the middle."""
    sharp = np.where(topology.boundary_edges, 1.0, np.minimum(sharpness, 1.0))
    face_mean = topology.faces_to_edges().T * 0.5 @ to_faces
    smooth = to_middles * 0.5 + face_mean * 0.5
    return _blend(sharp, to_middles, smooth)


def _vertex_rule(
    topology: Topology, sharpness: FloatArray, to_faces: sp.csr_array, to_middles: sp.csr_array
) -> sp.csr_array:
    """Smooth rule inside, cubic spline rule on boundaries and creases, fixed where creases meet."""
    identity = sp.eye_array(topology.vertex_count, format="csr")
    touches = sp.csr_array(topology.edges_to_vertices().T)
    surrounds = sp.csr_array(topology.faces_to_vertices().T)
    valence = np.asarray(touches.sum(axis=1))
    smooth = (
        _scale((valence - 3) / valence, identity)
        + _scale(2 / valence**2, touches) @ to_middles
        + _scale(1 / (valence * surrounds.sum(axis=1)), surrounds) @ to_faces
    )
    on_boundary = topology.boundary_vertices
    creased = (sharpness > 0) & ~topology.boundary_edges
    crease_count = np.where(on_boundary, 0, touches @ creased.astype(float))
    mean_sharpness = (touches @ np.where(creased, sharpness, 0.0)) / np.maximum(crease_count, 1)
    sharp = np.where(crease_count >= 2, np.minimum(mean_sharpness, 1.0), 0.0)
    sharp[on_boundary] = 1.0
    along = (topology.boundary_edges | creased).astype(float)
    along_boundary = topology.boundary_edges.astype(float)
    curve = np.where(on_boundary, touches @ along_boundary, touches @ along)
    spline_edges = _scale_columns(touches, along)
    spline_edges = _blend(
        on_boundary.astype(float), _scale_columns(touches, along_boundary), spline_edges
    )
    spline = identity * 0.5 + _scale(0.5 / np.maximum(curve, 1), spline_edges) @ to_middles
    corner = (~on_boundary & (crease_count > 2)).astype(float)
    return _blend(sharp, _blend(corner, identity, spline), smooth)


def _blend(share: FloatArray, first: sp.csr_array, second: sp.csr_array) -> sp.csr_array:
    """Return share * first + (1 - share) * second, row by row, without stored zeros."""
    mixed = sp.csr_array(_scale(share, first) + _scale(1 - share, second))
    mixed.eliminate_zeros()
    return mixed


def _scale(factors: FloatArray, matrix: sp.csr_array) -> sp.csr_array:
    return sp.csr_array(sp.diags_array(np.asarray(factors, dtype=float)) @ matrix)


def _scale_columns(matrix: sp.csr_array, factors: FloatArray) -> sp.csr_array:
    return sp.csr_array(matrix @ sp.diags_array(factors))


def _child_faces(coarse: Topology) -> IntArray:
    """Return the children of each face in turn: corner, edge after, face point, edge before."""
    face, corner = np.nonzero(coarse.faces >= 0)
    before = np.where(corner > 0, corner - 1, coarse.corner_counts[face] - 1)
    first_edge_point = coarse.vertex_count
    first_face_point = first_edge_point + len(coarse.edges)
    return np.column_stack(
        [
            coarse.faces[face, corner],
            first_edge_point + coarse.face_edges[face, corner],
            first_face_point + face,
            first_edge_point + coarse.face_edges[face, before],
        ]
    )


def _child_mirror(level: Level) -> IntArray:
    """Return the mirror image of each vertex of the next level: each mirrors to its own kind."""
    coarse, mirror = level.topology, level.mirror
    edge_mirror = coarse.edge_index(mirror[coarse.edges[:, 0]], mirror[coarse.edges[:, 1]])
    first_face_point = coarse.vertex_count + len(coarse.edges)
    return np.concatenate(
        [mirror, coarse.vertex_count + edge_mirror, first_face_point + level.face_mirror]
    )


def _child_face_mirror(level: Level) -> IntArray:
    """Return the mirror image of each face of the next level.

    A mirrored face has its corners reversed but for the first, and so have its children.
    """
    counts = level.topology.corner_counts
    starts = np.cumsum(counts) - counts
    parent = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(counts.sum()) - starts[parent]
    return np.asarray(starts[level.face_mirror[parent]] + -place % counts[parent])


def _child_sharpness(coarse: Topology, fine: Topology, sharpness: FloatArray) -> FloatArray:
    left = np.zeros(len(fine.edges))
    still_sharp = np.flatnonzero(sharpness > 1)
    middle = coarse.vertex_count + still_sharp
    for end in (0, 1):
        left[fine.edge_index(coarse.edges[still_sharp, end], middle)] = sharpness[still_sharp] - 1
    return left


def limit_matrix(topology: Topology) -> sp.csr_array:
    """Return the matrix (v, v) from control points of an all-quad level to limit positions.

    Inside: (n^2 v + 4 sum of edge neighbours + sum of face opposites) / (n (n + 5)); on the
    boundary the limit of a cubic spline.
    """
    size = topology.vertex_count
    on_boundary = topology.boundary_vertices
    boundary = topology.boundary_edges
    first, second = topology.edges.T
    valence = np.bincount(topology.edges.ravel(), minlength=size).astype(float)
    divisor = valence * (valence + 5)
    own = np.where(on_boundary, 4 / 6, valence**2 / divisor)
    rows, columns, values = [np.arange(size)], [np.arange(size)], [own]
    for center, other in ((first, second), (second, first)):
        spline = np.where(boundary, 1 / 6, 0.0)
        rows.append(center)
        columns.append(other)
        values.append(np.where(on_boundary[center], spline, 4 / divisor[center]))
    for corner in range(4):
        center = topology.faces[:, corner]
        rows.append(center)
        columns.append(topology.faces[:, (corner + 2) % 4])
        values.append(np.where(on_boundary[center], 0.0, 1 / divisor[center]))
    table = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    matrix = sp.csr_array(table, shape=(size, size))
    matrix.eliminate_zeros()
    return matrix


@dataclass(frozen=True, eq=False)
class Limit:
    """The smooth surface through a cage's points, seen at several levels.

    Attributes:
        levels: The cage (0) and its refinements.
        solver: Factorised matrix from control points to limit positions of the cage's vertices.
        to_limit: From the cage's control points to each level's limit positions, sparse.
    """

    levels: tuple[Level, ...]
    solver: SuperLU
    to_limit: tuple[sp.csr_array, ...]

    def positions(self, points: FloatArray, level: int) -> FloatArray:
        """Return a level's vertices [mm], shape (d, 3), of the surface through `points` (v, 3).

        Both halves are equal to the last bit when `points` are.
        """
        limit = self.to_limit[level] @ self.solver.solve(points)
        reflected = limit[self.levels[level].mirror] * [-1.0, 1.0, 1.0]
        exact = np.asarray((limit + reflected) / 2)
        exact[: len(points)] = points
        return exact


def limit_surface(cage: Level, refinements: int = 2) -> Limit:
    """Return the limit surface that interpolates the cage's points, down to `refinements` levels.

    Interpolation (Halstead et al. 1993): the control points are solved for. One step of
    subdivision first makes every face a quad, so that one limit mask serves all vertices.
    """
    from scipy.sparse.linalg import splu  # Here: a start does without.

    levels = [cage]
    for _ in range(refinements):
        levels.append(refine(levels[-1]))
    to_limit, control = [], levels[0].from_coarser
    for level in levels[1:]:
        control = sp.csr_array(level.from_coarser @ control)
        to_limit.append(sp.csr_array(limit_matrix(level.topology) @ control))
    of_cage = to_limit[0][: cage.topology.vertex_count]
    return Limit(tuple(levels), splu(of_cage.tocsc()), (of_cage, *to_limit))
