"""The tear line: the wet strip where the lids meet the ball, clear below, in shade above."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray, IntArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, joined, reflected, vertex_normals
from ..head import DrawnSurface, Part
from ..patches import EYE_CENTER, EYE_RADIUS

SAMPLES = 40
SEARCH = 3.6
"""How far from the lid's front edge its back edge is looked for, mm."""
BALL_LIFT = 0.02
REACH_LOWER = 0.42
"""How far the strip's upper edge lies up the ball from the lid's back edge, mm."""
REACH_UPPER = 0.30
HOLLOW = 0.10
"""A meniscus is hollow: how deep its middle sinks, mm."""

# Linear RGB from the lid's edge to the ball.
LOWER_COLORS = np.array(
    [[0.50, 0.225, 0.18], [0.52, 0.27, 0.22], [0.53, 0.33, 0.275], [0.50, 0.37, 0.32]]
)
UPPER_COLORS = np.array(
    [[0.30, 0.115, 0.09], [0.24, 0.10, 0.08], [0.30, 0.20, 0.17], [0.44, 0.36, 0.32]]
)


def tear_line_part(skin: DrawnSurface, lid_edge: FloatArray) -> Part:
    """Return both eyes' strips, riding the back edges of the lids.

    Args:
        skin: The drawn skin.
        lid_edge: Front edge of the left lids by spoke [mm], shape (16, 3).
    """
    pieces: list[Mesh] = []
    colors, roots = [], []
    for side in (1, -1):
        for spokes, reach, paint in (
            ((0, *range(15, 7, -1)), REACH_LOWER, LOWER_COLORS),
            (tuple(range(9)), REACH_UPPER, UPPER_COLORS),
        ):
            mesh, ridden = _strip(skin, lid_edge[list(spokes)], reach, side)
            pieces.append(mesh)
            roots.append(ridden)
            colors.append(np.tile(paint, (len(mesh[0]) // len(paint), 1)))
    vertices, triangles = joined(pieces)
    return Part(
        name="tear_line",
        vertices=vertices,
        normals=vertex_normals(vertices, triangles),
        triangles=triangles,
        colors=np.vstack(colors),
        material="wet",
        follows="skin",
        roots=np.concatenate(roots),
    )


def _strip(skin: DrawnSurface, edge: FloatArray, reach: float, side: int) -> tuple[Mesh, IntArray]:
    """Return one lid's strip and the drawn vertex that each of its vertices rides.

    Args:
        skin: The drawn skin.
        edge: The lid's front edge from the inner corner to the outer, left side [mm], shape (9, 3).
        reach: How far up the ball the strip goes, mm.
        side: 1 for the left eye, -1 for the right.
    """
    from scipy.interpolate import CubicSpline  # Here: a start does without.

    flip = np.array([side, 1.0, 1.0])
    spline = CubicSpline(np.arange(9), edge)
    share = np.linspace(0.9, 7.0, SAMPLES)
    front = np.asarray(spline(share))
    back, ridden = _back_edge(skin, front * flip)
    back = back * flip
    offset = back - EYE_CENTER
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    # Towards the opening, over the ball: from the lid to the middle of the fissure.
    towards = np.array([0.0, -np.sign(edge[4, 1] - EYE_CENTER[1]), 0.0])
    tangent = towards - offset / distance * np.sum(offset / distance * towards, axis=1)[:, None]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    on_ball = offset / distance * EYE_RADIUS + tangent * reach
    on_ball *= (EYE_RADIUS + BALL_LIFT) / np.linalg.norm(on_ball, axis=1, keepdims=True)
    # Towards the corners, where the lids leave the ball, the strip narrows to nothing.
    from_end = np.minimum(share - share[0], share[-1] - share)[:, None]
    wide = smoothstep(0.0, 1.2, from_end) * smoothstep(1.9, 0.9, distance - EYE_RADIUS)
    on_ball = offset + (on_ball - offset) * wide
    start = offset - tangent * 0.18 * wide + offset / distance * 0.04
    rows = []
    for place in (0.0, 0.33, 0.68, 1.0):
        point = start + (on_ball - start) * place
        rows.append(point - offset / distance * HOLLOW * np.sin(np.pi * place))
    grid = np.stack(rows, axis=1)
    length = np.linalg.norm(grid, axis=2, keepdims=True)
    grid = grid * np.maximum(1.0, (EYE_RADIUS + BALL_LIFT) / length) + EYE_CENTER
    mesh = (grid.reshape(-1, 3), grid_triangles(SAMPLES, 4, closed=False))
    if _faces_back(mesh):
        mesh = (mesh[0], mesh[1][:, ::-1].copy())
    return (mesh if side > 0 else reflected(mesh)), np.repeat(ridden, 4)


def _faces_back(mesh: Mesh) -> bool:
    a, b, c = (mesh[0][mesh[1][:, corner]] for corner in range(3))
    return bool(np.einsum("ti,ti->", np.cross(b - a, c - a), a - EYE_CENTER) < 0)


def _back_edge(skin: DrawnSurface, front: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the lid's back edge [mm], shape (k, 3), near its front edge, and the vertices there.

    It is where the skin comes nearest to the ball.
    """
    from scipy.spatial import cKDTree  # Here: a start does without.

    center = EYE_CENTER * [np.sign(front[:, 0].mean()), 1.0, 1.0]
    height = np.linalg.norm(skin.vertices - center, axis=1) - EYE_RADIUS
    margin = np.flatnonzero((height > 0) & (height < 4) & (skin.vertices[:, 2] > center[2] - 1))
    tree = cKDTree(skin.vertices[margin])
    found = np.empty(len(front), dtype=np.int64)
    for index, point in enumerate(front):
        near = margin[tree.query_ball_point(point, SEARCH)]
        away = np.linalg.norm(skin.vertices[near] - point, axis=1)
        found[index] = near[np.argmin(height[near] + 0.35 * away)]
    places = skin.vertices[found]
    # Neighbours share vertices; what is drawn between them runs smoothly.
    smooth = places.copy()
    for _ in range(3):
        smooth[1:-1] = 0.25 * smooth[:-2] + 0.5 * smooth[1:-1] + 0.25 * smooth[2:]
    return smooth, found
