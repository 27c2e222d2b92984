"""Tangents: how a mesh's map of texture lies on it, for materials with a normal map."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Float32Array

Array = npt.NDArray[Any]


def tangents_of(positions: Array, normals: Array, uvs: Array, triangles: Array) -> Float32Array:
    """Return a tangent for each vertex, shape (n, 4), as glTF wants it (section 3.7.2.1).

    x, y, z point to where u grows, at right angles to the normal. w is 1 or -1, so that
    w (normal x tangent) points up in the picture, where v falls. A vertex takes the mean of its
    triangles by area; one without any direction takes one at right angles to its normal.

    Args:
        positions: Shape (n, 3).
        normals: Of unit length, shape (n, 3).
        uvs: Places in the texture, origin top left, shape (n, 2).
        triangles: Vertex indices, shape (t, 3).
    """
    corners = np.asarray(positions, dtype=np.float64)[triangles]
    places = np.asarray(uvs, dtype=np.float64)[triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    (du1, dv1), (du2, dv2) = (places[:, 1] - places[:, 0]).T, (places[:, 2] - places[:, 0]).T
    turned = np.sign(du1 * dv2 - du2 * dv1)[:, None]
    along = turned * (dv2[:, None] * one - dv1[:, None] * two)
    down = turned * (du1[:, None] * two - du2[:, None] * one)
    normal = np.asarray(normals, dtype=np.float64)
    tangent = _summed(along, triangles, len(normal))
    tangent -= normal * np.einsum("ij,ij->i", normal, tangent)[:, None]
    length = np.linalg.norm(tangent, axis=1, keepdims=True)
    tangent = np.where(length > 1e-12, tangent / np.maximum(length, 1e-12), _across(normal))
    falls = np.einsum("ij,ij->i", np.cross(normal, tangent), _summed(down, triangles, len(normal)))
    return np.column_stack([tangent, np.where(falls > 0, -1.0, 1.0)]).astype(np.float32)


def _summed(vectors: Array, triangles: Array, count: int) -> Array:
    """Return the sum over the triangles round each vertex, shape (count, 3)."""
    corners = triangles.ravel()
    columns = [
        np.bincount(corners, np.repeat(vectors[:, axis], 3), minlength=count) for axis in range(3)
    ]
    return np.stack(columns, axis=1)


def _across(normals: Array) -> Array:
    """Return any unit vector at right angles to each normal."""
    axis = np.eye(3)[np.abs(normals).argmin(axis=1)]
    across = np.cross(normals, axis)
    return np.asarray(across / np.linalg.norm(across, axis=1, keepdims=True))
