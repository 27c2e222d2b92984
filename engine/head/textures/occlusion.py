"""Ambient occlusion: how much of the sky each point of the skin sees past the head itself."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray, IntArray
from ...compiling import kept
from ..geometry import joined, vertex_normals
from ..head import Head

DIRECTIONS = 96
PIXELS = 320
BIAS = 1.4
"""What lies nearer than this in front of a point does not shade it, mm; folds are narrower than
a pixel."""
SOLID = ("eye", "teeth", "wet", "skin")
"""Materials of parts that cast shade."""


def occlusion(head: Head) -> FloatArray:
    """Return the share of unshaded sky at the drawn vertices, weighted by its slant, 0..1, (d,)."""
    drawn = head.drawn
    solid = [part for part in head.parts if part.material in SOLID]
    pieces = [(drawn.vertices, drawn.triangles), *((p.vertices, p.triangles) for p in solid)]
    vertices, triangles = joined(pieces)
    normals = vertex_normals(drawn.vertices, drawn.triangles, drawn.seams)
    seen, whole = np.zeros(len(normals)), np.full(len(normals), 1e-9)
    for direction in _directions():
        slant = np.clip(normals @ direction, 0, None)
        seen += slant * _visible(vertices, triangles, direction)[: len(normals)]
        whole += slant
    return np.asarray(seen / whole)


def _directions() -> FloatArray:
    """Return directions spread evenly over the sphere, both halves alike, shape (k, 3)."""
    number = np.arange(DIRECTIONS // 2) + 0.5
    height = 1 - 2 * number / len(number)
    around = np.pi * (1 + 5**0.5) * number
    across = np.sqrt(1 - height**2)
    left = np.column_stack([across * np.cos(around), height, across * np.sin(around)])
    return np.concatenate([left, left * [-1.0, 1.0, 1.0]])


def _visible(vertices: FloatArray, triangles: IntArray, direction: FloatArray) -> FloatArray:
    """Return which vertices nothing hides from `direction`, softened over four pixels, (v,)."""
    side = np.cross(direction, [0.0, 1.0, 0.0] if abs(direction[1]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    flat = vertices @ np.column_stack([side, np.cross(direction, side), direction])
    low, high = flat[:, :2].min(axis=0), flat[:, :2].max(axis=0)
    flat[:, :2] = (flat[:, :2] - low) * ((PIXELS - 3) / (high - low).max()) + 1
    return np.asarray(_unhidden(flat, triangles, PIXELS, BIAS))


@kept(nogil=True)
def _unhidden(
    flat: FloatArray, triangles: IntArray, size: int, bias: float
) -> npt.NDArray[np.float64]:
    depth = np.full((size, size), -1e9)
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        x0, y0, x1, y1, x2, y2 = (
            flat[a, 0], flat[a, 1], flat[b, 0], flat[b, 1], flat[c, 0], flat[c, 1],
        )  # fmt: skip
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if abs(area) < 1e-9:
            continue
        for y in range(int(np.ceil(min(y0, y1, y2))), int(max(y0, y1, y2)) + 1):
            for x in range(int(np.ceil(min(x0, x1, x2))), int(max(x0, x1, x2)) + 1):
                s0 = ((x1 - x) * (y2 - y) - (x2 - x) * (y1 - y)) / area
                s1 = ((x2 - x) * (y0 - y) - (x0 - x) * (y2 - y)) / area
                s2 = 1 - s0 - s1
                if s0 >= 0 and s1 >= 0 and s2 >= 0:
                    z = s0 * flat[a, 2] + s1 * flat[b, 2] + s2 * flat[c, 2]
                    depth[y, x] = max(depth[y, x], z)
    seen = np.zeros(len(flat))
    for v in range(len(flat)):
        i, j = int(flat[v, 0]), int(flat[v, 1])
        for dj in range(2):
            for di in range(2):
                if depth[j + dj, i + di] < flat[v, 2] + bias:
                    seen[v] += 0.25
    return seen
