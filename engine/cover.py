"""What shows through the skin: teeth, gums, tongue and eyeballs that stand before it."""

from __future__ import annotations

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .frame import Frame
from .gltf.pose import motions
from .rig import Rig

IN_THE_MOUTH = ("teeth", "gum", "tongue")
INSIDE = ("mouth_inner", "upper_lip_inner", "lower_lip_inner")
"""Skin that is looked at from the mouth: what stands before it is where it belongs."""
REACH_MM = 8.0
"""How far behind a vertex that stands out the skin is looked for: no tooth is thicker."""
BACK_MM = 62.0
"""Depth of the middle of the arches: from there all crowns face outwards."""
SUNK_MM = 0.05
"""Depth of a lid's vertex in the eyeball that counts; the picture's own precision."""


def showing(rig: Rig, frame: Frame) -> dict[str, int]:
    """Return how many vertices of each part stand before the skin that should cover them.

    In the mouth they are vertices of teeth, gums and tongue with outer skin behind them; at the
    eyes, vertices of the skin that have sunk into the eyeball. Parts with none are left out.

    Args:
        rig: Whose head.
        frame: A face of that rig.
    """
    head = rig.head
    skin = head.drawn.deform(np.asarray(frame.displacements, dtype=np.float64), head.eyes)
    names = np.array(head.drawn.region_names)[head.drawn.regions]
    outer = head.drawn.triangles[~np.isin(names[head.drawn.triangles], INSIDE).any(axis=1)]
    moved = motions(head, rig.jaw, frame.pose)
    parts = [part for part in head.parts if part.name.startswith(IN_THE_MOUTH)]
    found = {}
    if parts:
        vertices = np.concatenate([moved[part.follows].move(part.vertices) for part in parts])
        axis = np.column_stack(
            [0 * vertices[:, 0], vertices[:, 1], np.minimum(vertices[:, 2], BACK_MM)]
        )
        inwards = axis - vertices
        inwards *= REACH_MM / np.maximum(np.linalg.norm(inwards, axis=1, keepdims=True), 1e-9)
        out = crossings(vertices, inwards, skin, outer)
        ends = np.cumsum([len(part.vertices) for part in parts])
        for part, through in zip(parts, np.split(out, ends[:-1]), strict=True):
            found[part.name] = int(through.sum())
    for side, eye in zip(("left", "right"), head.eyes, strict=False):
        offset = skin - eye.center
        sunk = eye.radius - np.linalg.norm(offset, axis=1)
        found[f"{side} eyeball"] = int(((sunk > SUNK_MM) & (offset[:, 2] > 0.0)).sum())
    return {name: count for name, count in found.items() if count}


def crossings(
    start: FloatArray, way: FloatArray, vertices: FloatArray, triangles: IntArray
) -> BoolArray:
    """Tell which ways cross a triangle that faces back at their start, shape (k,).

    By Möller and Trumbore's intersection (1997), of each way with the triangles near it.

    Args:
        start: Where the ways begin, mm, shape (k, 3).
        way: How far and whither they go, mm, shape (k, 3).
        vertices: Of the surface, mm, shape (d, 3).
        triangles: Of the surface, counter-clockwise from outside, shape (t, 3).
    """
    from scipy.spatial import cKDTree  # Here: a start does without.

    length = float(np.linalg.norm(way, axis=1).max())
    beside = (vertices < start.min(axis=0) - length) | (vertices > start.max(axis=0) + length)
    triangles = triangles[~beside.any(axis=1)[triangles].all(axis=1)]
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    middle = (a + b + c) / 3
    radius = float(np.linalg.norm(np.stack([a, b, c]) - middle, axis=2).max(initial=0.0))
    around = cKDTree(middle).query_ball_point(start + way / 2, length / 2 + radius)
    near = [np.array(hits, dtype=np.int64) for hits in around]
    who = np.repeat(np.arange(len(start)), [len(hits) for hits in near])
    which = np.concatenate(near)
    one, two = b[which] - a[which], c[which] - a[which]
    across = np.cross(way[who], two)
    slope = np.einsum("ij,ij->i", one, across)
    facing = slope > 1e-9  # the way runs against the triangle's normal
    scale = 1 / np.where(facing, slope, 1.0)
    off = start[who] - a[which]
    u = np.einsum("ij,ij->i", off, across) * scale
    turned = np.cross(off, one)
    v = np.einsum("ij,ij->i", way[who], turned) * scale
    t = np.einsum("ij,ij->i", two, turned) * scale
    crossed = facing & (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)
    found = np.zeros(len(start), dtype=bool)
    found[who[crossed]] = True
    return found
