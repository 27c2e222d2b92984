"""Strands of hair as thin tapering ribbons, and the laying of strands on the drawn skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..geometry import unit
from ..head import DrawnSurface, Part

CANDIDATES = 24
"""Triangles near a point of the front view that are tried for the one under it."""


@dataclass(frozen=True, eq=False)
class Strands:
    """Some strands of hair.

    Attributes:
        lines: Points from root to tip [mm], shape (n, k, 3).
        normals: Outward direction at each point, shape (n, k, 3).
        width: At the root [mm], shape (n,).
        colors: Linear RGB, shape (n, 3).
    """

    lines: FloatArray
    normals: FloatArray
    width: FloatArray
    colors: FloatArray

    def __add__(self, other: Strands) -> Strands:
        return Strands(
            np.concatenate([self.lines, other.lines]),
            np.concatenate([self.normals, other.normals]),
            np.concatenate([self.width, other.width]),
            np.concatenate([self.colors, other.colors]),
        )

    def only(self, chosen: BoolArray) -> Strands:
        """Return the strands that are chosen, shape (n,)."""
        return Strands(
            self.lines[chosen], self.normals[chosen], self.width[chosen], self.colors[chosen]
        )

    def reflected(self) -> Strands:
        """Return the mirror image in x = 0."""
        flip = np.array([-1.0, 1.0, 1.0])
        return Strands(self.lines * flip, self.normals * flip, self.width, self.colors)


def strand_part(
    name: str, strands: Strands, skin: DrawnSurface | None, *, root_light: float = 1.0
) -> Part:
    """Return strands as a part that rides the skin, or the skull when `skin` is None.

    Args:
        name: The part's name.
        strands: The strands.
        skin: The drawn skin; each strand rides the vertex nearest its root.
        root_light: Brightness of the roots relative to the tips.
    """
    from scipy.spatial import cKDTree  # Here: a start does without.

    vertices, normals, triangles = _ribbons(strands)
    count, points = strands.lines.shape[:2]
    per_strand = 2 * points - 1
    light = np.r_[np.repeat(np.linspace(root_light, 1.0, points)[:-1], 2), 1.0]
    colors = strands.colors[:, None, :] * light[None, :, None]
    roots = None
    if skin is not None:
        _, nearest = cKDTree(skin.vertices).query(strands.lines[:, 0])
        roots = np.repeat(nearest.astype(np.int64), per_strand)
    return Part(
        name=name,
        vertices=vertices,
        normals=normals,
        triangles=triangles,
        colors=np.clip(colors.reshape(count * per_strand, 3), 0, 1),
        material="hair",
        follows="skull" if skin is None else "skin",
        roots=roots,
    )


def _ribbons(strands: Strands) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return vertices, normals and triangles: two vertices a point, one at the tip."""
    lines, normals = strands.lines, strands.normals
    count, points = lines.shape[:2]
    side = unit(np.cross(np.gradient(lines, axis=1), normals))
    taper = np.linspace(1.0, 0.0, points) ** 0.7
    half = 0.5 * strands.width[:, None, None] * taper[None, :, None]
    edges = np.stack([lines - side * half, lines + side * half], axis=2)
    vertices = edges.reshape(count, 2 * points, 3)[:, :-1]
    shading = unit(np.repeat(normals, 2, axis=1)[:, :-1])
    one = [[i, i + 1, i + 2] if i % 2 == 0 else [i + 1, i, i + 2] for i in range(2 * points - 3)]
    triangles = np.array(one)[None] + (2 * points - 1) * np.arange(count)[:, None, None]
    return vertices.reshape(-1, 3), shading.reshape(-1, 3), triangles.reshape(-1, 3)


class FrontView:
    """The skin seen from the front: what lies under a point (x, y)."""

    def __init__(self, skin: DrawnSurface, region: BoolArray) -> None:
        """Prepare the triangles of `skin` that are marked in `region`, shape (t,), and face +z."""
        from scipy.spatial import cKDTree  # Here: a start does without.

        a, b, c = (skin.vertices[skin.triangles[:, corner]] for corner in range(3))
        facing = np.cross(b - a, c - a)
        chosen = region & (facing[:, 2] > 0)
        self._corners = np.stack([a, b, c], axis=1)[chosen]
        self._normals = skin.normals[skin.triangles[chosen]]
        self._tree = cKDTree(self._corners[:, :, :2].mean(axis=1))

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Return skin points (n, 3), normals (n, 3) under front-view points (n, 2), and hits (n,).

        Where several layers lie under a point the foremost counts.
        """
        near = np.asarray(self._tree.query(points, k=min(CANDIDATES, len(self._corners)))[1])
        corners = self._corners[near]
        a, b, c = (corners[:, :, corner, :2] for corner in range(3))
        p = points[:, None, :]
        area = _cross(b - a, c - a)
        weights = np.stack([_cross(b - p, c - p), _cross(c - p, a - p), _cross(a - p, b - p)], -1)
        weights = weights / np.where(np.abs(area) < 1e-9, 1e-9, area)[..., None]
        inside = weights.min(axis=-1) > -1e-6
        position = np.einsum("nkc,nkcx->nkx", weights, corners)
        front = np.where(inside, position[:, :, 2], -np.inf)
        best = front.argmax(axis=1)
        row = np.arange(len(points))
        normal = (weights[row, best][:, :, None] * self._normals[near[row, best]]).sum(axis=1)
        return position[row, best], unit(normal), inside[row, best]


def _cross(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])
