"""Graded levels of detail: fine where the face lives, coarse on scalp, neck, throat and ear."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .cage import Cage, mirrored_faces
from .geometry import best_fan, smallest_angles
from .patches.ear import rim_points
from .subdivision import Level
from .topology import Topology

COARSE_REGIONS = ("scalp", "neck", "mouth_inner", "submental", "ear")


def drawn_fine(cage: Cage) -> BoolArray:
    """Return which of the cage's faces are drawn fine, shape (f,): the face's and the ear's rim.

    Faces that the cage itself has finer than elsewhere need no more.
    """
    on_rim = np.isin(np.array(cage.names), rim_points())
    of_rim = (on_rim[cage.faces] | (cage.faces < 0)).all(axis=1)
    fine = ~np.isin(np.array(cage.regions), COARSE_REGIONS) | of_rim
    return np.asarray(fine if cage.fine is None else fine & ~cage.fine)


def graded_triangles(
    coarse: Level, fine: Level, positions: FloatArray, face_is_fine: BoolArray
) -> tuple[IntArray, IntArray]:
    """Return the triangles of a mesh that is fine in some places and coarse in the others.

    A coarse face beside a fine one takes the shared edge's middle vertex into its outline, so there
    are no cracks. The right half mirrors the left.

    Args:
        coarse: The coarser level.
        fine: The next finer level.
        positions: Limit positions of the finer level [mm], shape (d, 3).
        face_is_fine: Which cage faces are drawn fine, shape (f,).

    Returns:
        Triangles over the finer level's vertices, shape (t, 3), and the cage face of each.
    """
    topology = coarse.topology
    wanted = face_is_fine[coarse.parents]
    left = np.arange(len(wanted)) < len(wanted) // 2
    edge_is_fine = np.zeros(len(topology.edges), dtype=bool)
    fine_edges = topology.face_edges[wanted]
    edge_is_fine[fine_edges[fine_edges >= 0]] = True
    sides = topology.face_edges
    stitched = ~wanted & (edge_is_fine[sides] & (sides >= 0)).any(axis=1)

    children = np.repeat(wanted & left, topology.corner_counts)
    plain = ~wanted & ~stitched & left
    pieces = [
        _split(fine.topology.faces[children], fine.parents[children], positions),
        _split(topology.faces[plain], coarse.parents[plain], positions),
    ]
    for face in np.flatnonzero(stitched & left):
        outline = np.array(_outline(topology, int(face), edge_is_fine))
        fan = best_fan(outline, outline >= topology.vertex_count, positions[outline])
        pieces.append((fan, np.full(len(fan), coarse.parents[face])))
    triangles = np.vstack([piece[0] for piece in pieces])
    parents = np.concatenate([piece[1] for piece in pieces])
    half = len(face_is_fine) // 2
    return (
        np.vstack([triangles, mirrored_faces(triangles, fine.mirror)]),
        np.concatenate([parents, parents + half]),
    )


def _split(faces: IntArray, parents: IntArray, positions: FloatArray) -> tuple[IntArray, IntArray]:
    """Return triangles, each quad split along the diagonal that leaves the largest least angle."""
    is_quad = faces[:, 3] >= 0
    a, b, c, d = faces.T
    along_first = np.stack([np.c_[a, b, c], np.c_[a, c, d]], axis=1)
    along_second = np.stack([np.c_[a, b, d], np.c_[b, c, d]], axis=1)
    first, second = (
        smallest_angles(positions[pair]).min(axis=1) for pair in (along_first, along_second)
    )
    better = is_quad & (second > first * (1 + 1e-6))
    pairs = np.where(better[:, None, None], along_second, along_first).reshape(-1, 3)
    kept = np.column_stack([np.ones_like(is_quad), is_quad]).ravel()
    return pairs[kept], np.repeat(parents, 1 + is_quad)


def _outline(topology: Topology, face: int, edge_is_fine: BoolArray) -> list[int]:
    outline: list[int] = []
    corners = zip(topology.faces[face], topology.face_edges[face], strict=True)
    for corner, edge in corners:
        if corner < 0:
            continue
        outline.append(int(corner))
        if edge_is_fine[edge]:
            outline.append(topology.vertex_count + int(edge))
    return outline
