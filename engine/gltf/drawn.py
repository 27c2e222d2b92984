"""The drawn face of any frame: skin, its normals, and the strands that ride on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from ..head.head import Head, Part


def ride_roots(
    part: Part,
    rest: FloatArray,
    rest_normals: FloatArray,
    vertices: FloatArray,
    normals: FloatArray,
) -> FloatArray:
    """Return the vertices [mm], shape (v, 3), of a part that rides on the skin.

    Each vertex moves rigidly with its root, the drawn vertex that it grows from:

        x = V[root] + R (x0 - V0[root])

    where R is the smallest rotation that takes the root's normal at rest, a, to its present one,
    b. With c = a x b and r = x0 - V0[root] it is, without any trigonometry,

        R r = (a.b) r + c x r + c (c.r) / max(1 + a.b, 0.05)

    The bound only matters for a normal that turned over. Both sets of normals are the
    area-weighted ones of `SkinNormals`, so that a client can compute them from the triangles.
    The viewer computes the same in TypeScript; this is the reference.

    Args:
        part: Has `roots`.
        rest: Drawn skin at rest [mm], shape (d, 3).
        rest_normals: Its area-weighted unit normals, shape (d, 3).
        vertices: Drawn skin now [mm], shape (d, 3).
        normals: Its area-weighted unit normals, shape (d, 3).
    """
    roots = roots_of(part)
    arm = part.vertices - rest[roots]
    return vertices[roots] + turn_with(rest_normals[roots], normals[roots], arm)


def turn_with(before: FloatArray, after: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return `vectors`, each turned as its unit normal turned from `before` to `after`; (v, 3)."""
    axis = np.cross(before, after)
    cosine = np.einsum("ij,ij->i", before, after)[:, None]
    along = np.einsum("ij,ij->i", axis, vectors)[:, None]
    across = np.cross(axis, vectors)
    return np.asarray(cosine * vectors + across + axis * along / np.maximum(1 + cosine, 0.05))


def roots_of(part: Part) -> IntArray:
    """Return the drawn vertex that each vertex of a strand part rides, shape (v,)."""
    if part.roots is None:
        raise ValueError(f"part {part.name!r} follows the skin, so it needs roots")
    return part.roots


@dataclass(frozen=True, eq=False)
class SkinNormals:
    """Area-weighted vertex normals of one triangle mesh.

    Attributes:
        triangles: Vertex indices, shape (t, 3).
        gather: Sums triangles into their corners and into all that lie there, sparse (d, t).
    """

    triangles: IntArray
    gather: sp.csr_array

    @classmethod
    def of(cls, triangles: IntArray, count: int, seams: IntArray | None = None) -> SkinNormals:
        """Prepare for a mesh of `count` vertices.

        Args:
            triangles: Vertex indices, shape (t, 3).
            count: Vertices.
            seams: First vertex at the same place, shape (d,), where some are doubled: those share
                one normal, so that the seam is not seen.
        """
        if seams is not None:
            welded = cls.of(seams[triangles], count)
            return cls(welded.triangles, sp.csr_array(welded.gather[seams]))
        corners = triangles.ravel()
        faces = np.repeat(np.arange(len(triangles)), 3)
        gather = sp.csr_array(
            (np.ones(len(corners)), (corners, faces)), shape=(count, len(triangles))
        )
        return cls(triangles, gather)

    def __call__(self, vertices: FloatArray) -> FloatArray:
        """Return unit normals, shape (d, 3), of `vertices` [mm], shape (d, 3)."""
        a, b, c = (vertices[self.triangles[:, corner]] for corner in range(3))
        summed = np.asarray(self.gather @ np.cross(b - a, c - a))
        return unit_normals(summed)


def unit_normals(normals: FloatArray) -> FloatArray:
    """Return `normals`, shape (v, 3), at length one; those without a direction face forward."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    forward = np.array([0.0, 0.0, 1.0])
    return np.where(length > 1e-12, normals / np.maximum(length, 1e-12), forward)


@dataclass(frozen=True, eq=False)
class DrawnFace:
    """A head's skin and strands, ready to be drawn for any displacement of its tissue.

    Attributes:
        head: The head at rest.
        strands: The parts that ride on the skin, in the head's order.
        skin_normals: Computes the skin's normals.
        rest_normals: The skin's area-weighted normals at rest, shape (d, 3).
    """

    head: Head
    strands: tuple[Part, ...]
    skin_normals: SkinNormals
    rest_normals: FloatArray

    @classmethod
    def of(cls, head: Head) -> DrawnFace:
        """Prepare `head` for drawing."""
        normals = SkinNormals.of(head.drawn.triangles, len(head.drawn.vertices), head.drawn.seams)
        strands = tuple(part for part in head.parts if part.follows == "skin")
        return cls(head, strands, normals, normals(head.drawn.vertices))

    def skin(self, displacements: FloatArray) -> FloatArray:
        """Return the drawn skin [mm], shape (d, 3), of displaced tissue [mm], shape (s, 3)."""
        wide = np.asarray(displacements, dtype=np.float64)
        return self.head.drawn.deform(wide, self.head.eyes)

    def ride(self, vertices: FloatArray, normals: FloatArray) -> list[FloatArray]:
        """Return each strand part's vertices [mm] on the skin `vertices` with `normals`."""
        rest = self.head.drawn.vertices
        return [
            ride_roots(part, rest, self.rest_normals, vertices, normals) for part in self.strands
        ]

    def positions(self, displacements: FloatArray) -> FloatArray:
        """Return skin, then strands [mm], stacked, shape (d + strand vertices, 3)."""
        vertices = self.skin(displacements)
        return np.concatenate([vertices, *self.ride(vertices, self.skin_normals(vertices))])

    def rest_positions(self) -> FloatArray:
        """Return skin, then strands [mm] of undisplaced tissue, stacked as in `positions`."""
        return self.positions(np.zeros_like(self.head.points))

    def pieces(self) -> list[slice]:
        """Return where the skin and each strand part lie in `positions`."""
        counts = [len(self.head.drawn.vertices), *(len(part.vertices) for part in self.strands)]
        stops = np.cumsum(counts).tolist()
        return [slice(stop - count, stop) for stop, count in zip(stops, counts, strict=True)]

    def normal_change(self, vertices: FloatArray) -> FloatArray:
        """Return how the skin's normals differ from rest, shape (d, 3)."""
        return self.skin_normals(vertices) - self.rest_normals
