"""Many frames of the drawn face at once: what `DrawnFace` draws one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from ..arrays import Float32Array, FloatArray, IntArray
from ..head.head import LID_GAP, Head, Part, corneal_bulge
from .drawn import DrawnFace, roots_of

Array = npt.NDArray[Any]


@dataclass(frozen=True, eq=False)
class Riders:
    """Strands that ride on a few drawn vertices, as a linear map of what those do.

    A root moves by m and turns by R, so that an arm r from it moves by m + (R - 1) r: a row of
    `spread` is (1, r) in the four columns of its root. `ride_roots` says how R comes about.

    Attributes:
        roots: Drawn vertices that something rides, shape (k,).
        normals: Sums triangles round each root, sparse (k, t).
        triangles: Those triangles, shape (t, 3).
        spread: Sparse (v, 4 k).
    """

    roots: IntArray
    normals: sp.csr_array
    triangles: IntArray
    spread: sp.csr_array

    @classmethod
    def of(cls, face: DrawnFace, parts: Sequence[Part]) -> Riders:
        """Prepare the strands `parts` of a face."""
        own = np.concatenate([roots_of(part) for part in parts])
        roots, places = np.unique(own, return_inverse=True)
        gather = sp.csr_array(face.skin_normals.gather[roots])
        near = np.unique(gather.indices)
        rest = face.head.drawn.vertices
        arms = np.concatenate([part.vertices for part in parts]) - rest[own]
        rows = np.repeat(np.arange(len(own)), 4)
        columns = (4 * places[:, None] + np.arange(4)).ravel()
        values = np.column_stack([np.ones(len(own)), arms]).ravel().astype(np.float32)
        return cls(
            roots=roots,
            normals=sp.csr_array(gather[:, near].astype(np.float32)),
            triangles=face.skin_normals.triangles[near],
            spread=sp.csr_array((values, (rows, columns)), shape=(len(own), 4 * len(roots))),
        )

    def moves(self, skin: FloatArray, rest: FloatArray, rest_normals: FloatArray) -> Float32Array:
        """Return how the strands move [mm], shape (v, n, 3), on skin (d, n, 3) from rest (d, 3)."""
        count = skin.shape[1]
        before = np.broadcast_to(
            rest_normals[self.roots, None], (len(self.roots), count, 3)
        ).astype(np.float32)
        after = _unit(self.normals, self.triangles, skin)
        done = np.empty((len(self.roots), 4, count, 3), np.float32)
        done[:, 0] = skin[self.roots] - rest[self.roots, None]
        done[:, 1:] = _turns(before, after).transpose(0, 3, 1, 2)
        moved = self.spread @ done.reshape(4 * len(self.roots), 3 * count)
        return np.asarray(moved.reshape(-1, count, 3))


class FrameDrawer:
    """Draws the skin and some strands of many frames at once, as moves from rest.

    Attributes:
        rest: Skin, then strands at rest [mm], shape (v, 3).
        pieces: Where the skin and each strand part lie in it.
    """

    def __init__(self, face: DrawnFace, strands: Sequence[Part]) -> None:
        """Prepare the skin of `face`, and those of its strands."""
        self._face = face
        self._riders = Riders.of(face, strands) if strands else None
        still = self._deformed(np.zeros((1, *face.head.points.shape)))
        self._still = still
        parts = [part.vertices for part in strands]
        self.rest = np.concatenate([still[:, 0], *parts])
        counts = [len(still), *(len(part) for part in parts)]
        stops = np.cumsum(counts).tolist()
        self.pieces = [slice(stop - count, stop) for stop, count in zip(stops, counts, strict=True)]
        # Lids that are pushed out at rest already take their lashes along.
        self._ridden_still = self._ridden(still)
        self.rest[len(still) :] += self._ridden_still[:, 0]

    def moves(self, displacements: Float32Array) -> Float32Array:
        """Return how skin, then strands move from rest [mm], shape (n, v, 3).

        Args:
            displacements: Of the tissue surface from rest [mm], shape (n, s, 3).
        """
        skin = self._deformed(displacements)
        moved = np.empty((len(displacements), len(self.rest), 3), np.float32)
        moved[:, : len(skin)] = (skin - self._still).transpose(1, 0, 2)
        moved[:, len(skin) :] = (self._ridden(skin) - self._ridden_still).transpose(1, 0, 2)
        return moved

    def turns(self, displacements: Float32Array) -> Float32Array:
        """Return the change of the skin's normals, shape (n, d, 3)."""
        skin = self._deformed(displacements)
        normals = self._face.skin_normals
        gather = sp.csr_array(normals.gather.astype(np.float32))
        after = _unit(gather, normals.triangles, skin)
        change = after - self._face.rest_normals[:, None].astype(np.float32)
        return np.ascontiguousarray(change.transpose(1, 0, 2))

    def _deformed(self, displacements: Array) -> FloatArray:
        """Return the drawn skin [mm], shape (d, n, 3)."""
        count, points = displacements.shape[:2]
        wide = displacements.transpose(1, 0, 2).astype(np.float64).reshape(points, 3 * count)
        head = self._face.head
        moved = np.asarray(head.drawn.map @ wide).reshape(-1, count, 3)
        moved += head.drawn.vertices[:, None]
        _push_out(head, moved)
        return moved

    def _ridden(self, skin: FloatArray) -> Float32Array:
        if self._riders is None:
            return np.empty((0, skin.shape[1], 3), np.float32)
        return self._riders.moves(skin, self._face.head.drawn.vertices, self._face.rest_normals)


def _push_out(head: Head, skin: FloatArray) -> None:
    """Push lids of skin [mm], shape (d, n, 3), out of the eyes: `LidContact.project`, in place."""
    lids = head.drawn.lids
    if not len(lids.vertices) or not head.eyes:
        return
    centers = np.array([eye.center for eye in head.eyes])[lids.eyes][:, None]
    radius = np.array([eye.radius for eye in head.eyes])[lids.eyes][:, None]
    offsets = skin[lids.vertices] - centers
    distance = np.linalg.norm(offsets, axis=2)
    bulge = corneal_bulge(offsets.reshape(-1, 3)).reshape(distance.shape)
    least = radius + LID_GAP + bulge + lids.clearance[:, None]
    inside = (distance < least) & (offsets[..., 2] > 0)
    scale = np.where(inside, least / distance, 1.0)
    skin[lids.vertices] = np.where(
        inside[..., None], centers + offsets * scale[..., None], skin[lids.vertices]
    )


def _unit(gather: sp.csr_array, triangles: IntArray, skin: FloatArray) -> Float32Array:
    """Return unit normals, shape (k, n, 3), of skin, shape (d, n, 3)."""
    count = skin.shape[1]
    first = skin[triangles[:, 0]]
    one = (skin[triangles[:, 1]] - first).astype(np.float32)
    two = (skin[triangles[:, 2]] - first).astype(np.float32)
    areas = _cross(one, two)
    summed = np.asarray(gather @ areas.reshape(len(triangles), 3 * count)).reshape(-1, count, 3)
    length = np.sqrt(np.einsum("kni,kni->kn", summed, summed))[..., None]
    forward = np.array([0.0, 0.0, 1.0], np.float32)
    return np.where(length > 1e-12, summed / np.maximum(length, 1e-12), forward)


def _cross(one: Float32Array, two: Float32Array) -> Float32Array:
    crossed = np.empty_like(one)
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        crossed[..., axis] = one[..., a] * two[..., b] - one[..., b] * two[..., a]
    return crossed


def _turns(before: Float32Array, after: Float32Array) -> Float32Array:
    """Return R - 1, shape (k, n, 3, 3), of the smallest rotations between unit normals."""
    axis = _cross(before, after)
    cosine = np.einsum("kni,kni->kn", before, after)[..., None, None]
    turn = axis[..., :, None] * axis[..., None, :] / np.maximum(1 + cosine, 0.05)
    turn += (cosine - 1) * np.eye(3, dtype=np.float32)
    for row, column, other in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        turn[..., row, column] -= axis[..., other]
        turn[..., column, row] += axis[..., other]
    return np.asarray(turn)
