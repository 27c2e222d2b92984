"""Small geometry shared by skin and parts: normals, angles, fans, pieces joined."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray

Mesh = tuple[FloatArray, IntArray]
"""Vertices [mm], shape (v, 3), and triangles, shape (t, 3)."""


def vertex_normals(
    vertices: FloatArray, triangles: IntArray, seams: IntArray | None = None
) -> FloatArray:
    """Return unit normals (v, 3), the mean of the triangles around weighted by their areas.

    Args:
        vertices: Positions, shape (v, 3).
        triangles: Shape (t, 3).
        seams: First vertex at the same place, shape (v,), where some are doubled.
    """
    if seams is not None:
        return vertex_normals(vertices, seams[triangles])[seams]
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    face = np.cross(b - a, c - a)
    normal = np.column_stack(
        [
            np.bincount(triangles.ravel(), np.repeat(face[:, axis], 3), minlength=len(vertices))
            for axis in range(3)
        ]
    )
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.where(length > 1e-12, normal / np.maximum(length, 1e-12), [0.0, 0.0, 1.0]))


def unit(vectors: FloatArray) -> FloatArray:
    """Return vectors (…, 3) at length one; those without a length stay as they are."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-9))


def triangle_areas(vertices: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the areas [mm^2] of triangles, shape (t,)."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def smallest_angles(corners: FloatArray) -> FloatArray:
    """Return the smallest angle of triangles given by their corners (..., 3, 3), radians."""
    to_next = np.roll(corners, -1, axis=-2) - corners
    to_last = np.roll(corners, 1, axis=-2) - corners
    product = np.linalg.norm(to_next, axis=-1) * np.linalg.norm(to_last, axis=-1)
    cosine = (to_next * to_last).sum(axis=-1) / np.maximum(product, 1e-12)
    return np.asarray(np.arccos(np.clip(cosine, -1, 1)).min(axis=-1))


def best_fan(outline: IntArray, is_middle: BoolArray, points: FloatArray) -> IntArray:
    """Return the fan of triangles over an outline whose smallest angle is the largest.

    None has a triangle of an edge's ends and its middle, which would have no area on the textures.

    Args:
        outline: Vertices in order, shape (n,).
        is_middle: Which of them is the middle of an edge whose ends are beside it, shape (n,).
        points: Where they are [mm], shape (n, 3).

    Returns:
        Vertices of the triangles, shape (n - 2, 3).
    """
    size = len(outline)
    starts = np.flatnonzero(~np.roll(is_middle, 1) & ~np.roll(is_middle, -1))
    rings = (starts[:, None] + np.arange(size)) % size
    fans = np.stack([rings[:, [0, k, k + 1]] for k in range(1, size - 1)], axis=1)
    worst = smallest_angles(points[fans]).min(axis=1)
    return np.asarray(outline[fans[int(np.argmax(worst))]])


def without_slivers(vertices: FloatArray, triangles: IntArray) -> IntArray:
    """Return the triangles that have an area."""
    return triangles[triangle_areas(vertices, triangles) > 1e-9]


def grid_triangles(rows: int, columns: int, *, closed: bool) -> IntArray:
    """Return triangles over a grid of vertices stored row by row.

    Facing: to the side from which columns run left to right and rows run downwards the mesh is
    clockwise, so that rings about +z, rows going outwards, face +z.

    Args:
        rows: Vertex rows.
        columns: Vertices per row.
        closed: Whether the last column meets the first.
    """
    i, j = np.meshgrid(
        np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij"
    )
    here = (i * columns + j).ravel()
    beside = (i * columns + (j + 1) % columns).ravel()
    pairs = np.stack(
        [
            np.column_stack([here, here + columns, beside]),
            np.column_stack([beside, here + columns, beside + columns]),
        ],
        axis=1,
    )
    return pairs.reshape(-1, 3)


def joined(pieces: Sequence[Mesh]) -> Mesh:
    """Return one mesh of several."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces[:-1])])
    return (
        np.vstack([vertices for vertices, _ in pieces]),
        np.vstack(
            [triangles + start for (_, triangles), start in zip(pieces, starts, strict=True)]
        ),
    )


def reflected(mesh: Mesh) -> Mesh:
    """Return a mesh's mirror image in x = 0, still facing outwards."""
    vertices, triangles = mesh
    return vertices * [-1.0, 1.0, 1.0], triangles[:, ::-1].copy()


def linear_rgb(color: FloatArray | Sequence[float]) -> FloatArray:
    """Return colours painted for a screen (gamma 2.2) as linear light."""
    return np.asarray(np.clip(np.asarray(color, dtype=float), 0.0, 1.0) ** 2.2)
