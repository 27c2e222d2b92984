"""The tongue: broad, its edge along the lower teeth, a groove along its middle; and put out."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, vertex_normals, without_slivers
from ..head import Part
from ..noise import noise
from .gums import gum_depth
from .teeth import LOWER, dental_arch, mouth_shade, outwards

SECTIONS = 28
AROUND = 26
TIP_GAP = 1.6
"""Between the tip and the backs of the lower incisors, mm."""
SIDE_GAP = 1.2
ROOT = 36.0
"""Depth at which the drawn tongue ends in the throat, mm."""
TOP = -73.6
"""Height of the back of the tongue at its highest, mm: under the palate, over the lower teeth."""
GROOVE_DEPTH = 1.5
GROOVE_WIDTH = 2.2
PAPILLA = 0.2
"""Height of the bumps that make its surface dull, mm."""

FULL_THRUST = 40.0
"""How far the tongue is put out in full, mm (AU19)."""
OUT_NARROWING = 0.2
"""Share of its width that the part before the teeth loses when it is put out."""
OUT_FLATTENING = 0.35
"""Share of its height that it loses."""
OUT_RISE, OUT_DROOP = 12.5, 5.5
"""How far it rises to pass over the lower teeth, and how far its tip sinks from there, mm."""

# Linear RGB.
TIP = np.array([0.52, 0.20, 0.18])
BACK = np.array([0.50, 0.235, 0.205])
UNDERSIDE = np.array([0.44, 0.13, 0.12])


def tongue_part() -> Part:
    """Return the tongue, which lies on the lower jaw."""
    mesh, colors = _tongue()
    return Part(
        name="tongue",
        vertices=mesh[0],
        normals=vertex_normals(*mesh),
        triangles=mesh[1],
        colors=np.clip(colors * mouth_shade(mesh[0]), 0, 1),
        material="wet",
        follows="jaw",
    )


def _tongue() -> tuple[Mesh, FloatArray]:
    """Return sections from the tip back, closed at both ends, and their colours."""
    along = np.linspace(0, float(LOWER.widths.sum()), 100)
    point, outward = dental_arch(LOWER, along)
    inner = point - outward * gum_depth(LOWER, along)[:, None]
    front = inner[0, 1] - TIP_GAP
    share = np.r_[0.0, np.linspace(0.004, 1, SECTIONS - 2) ** 1.5, 1.0]
    z = front + (ROOT - front) * share
    room = np.interp(-z, -np.minimum.accumulate(inner[:, 1]), inner[:, 0]) - SIDE_GAP
    rounded = np.sqrt(np.clip(1 - (1 - np.clip((front - z) / 17.0, 0, 1)) ** 2, 0, 1))
    half = np.minimum(np.maximum(room, 0), 21.5) * np.minimum(1, 0.25 + rounded) * rounded**0.35
    half[0] = half[-1] = 0.0
    thick = 9.5 * rounded + 4.0 * smoothstep(70, 45, z)
    middle = TOP - 3.4 - 0.5 * thick + 2.2 * smoothstep(88, 62, z) - 6.0 * smoothstep(54, ROOT, z)
    middle = middle - 1.0 * (1 - rounded)

    angle = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)[None, :]
    x = half[:, None] * np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.8
    up = np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** 0.9
    tall = 0.5 * thick[:, None] * np.minimum(1, half[:, None])
    y = middle[:, None] + tall * up
    top = smoothstep(0.05, 0.7, np.sin(angle)) * np.minimum(1, half[:, None] / 6)
    groove = np.exp(-((x / GROOVE_WIDTH) ** 2)) * smoothstep(0.0, 0.14, share)[:, None]
    y = y - GROOVE_DEPTH * top * groove * smoothstep(1.0, 0.6, share)[:, None]
    points = np.stack([x, y, np.repeat(z[:, None], AROUND, axis=1)], axis=2).reshape(-1, 3)
    bumps = noise(points, 2.6, seed=5) - 0.5
    points[:, 1] += PAPILLA * bumps * top.ravel()

    coat = (smoothstep(0.12, 0.5, share)[:, None] * top).reshape(-1, 1)
    under = np.broadcast_to(smoothstep(0.0, -0.5, np.sin(angle)), x.shape).reshape(-1, 1)
    colors = TIP + (BACK - TIP) * coat
    colors = colors + (UNDERSIDE - colors) * under
    in_groove = (top * groove).reshape(-1, 1)
    colors = colors * (1 + 0.10 * bumps[:, None] * (1 - under)) * (1 - 0.22 * in_groove)
    triangles = grid_triangles(len(share), AROUND, closed=True)
    return (points, outwards(points, without_slivers(points, triangles))), colors


def tongue_out(vertices: FloatArray) -> FloatArray:
    """Return how far each vertex of a tongue moves as it is put out by `FULL_THRUST`, (v, 3), mm.

    The tongue stretches from its root, narrows, flattens, and lies over the lower teeth and lip.
    Less thrust moves the vertices by its share of this; the way is a straight line.

    Args:
        vertices: Of `tongue_part`, in its order, on any person, mm, shape (v, 3).
    """
    sections = vertices.reshape(SECTIONS, AROUND, 3)
    middle = sections.mean(axis=1, keepdims=True)
    front, root = float(middle[:, 0, 2].max()), float(middle[:, 0, 2].min())
    share = np.clip((middle[..., 2] - root) / (front - root), 0.0, 1.0)[..., None]
    offset = sections - middle
    moved = np.zeros_like(sections)
    moved[..., 2] = FULL_THRUST * share[..., 0] ** 0.75
    moved[..., 0] = -OUT_NARROWING * (offset * smoothstep(0.3, 0.8, share))[..., 0]
    rise = OUT_RISE * smoothstep(0.3, 0.75, share) - OUT_DROOP * smoothstep(0.82, 1.0, share)
    moved[..., 1] = (rise - OUT_FLATTENING * offset * smoothstep(0.35, 0.8, share))[..., 1]
    return np.asarray(moved.reshape(-1, 3))
