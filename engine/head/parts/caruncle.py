"""The flesh in the eye's corners: caruncle and plica at the inner one, conjunctiva at the outer.

The ball is narrower than the opening of the lids: without them one would see beside it.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, joined, reflected, vertex_normals
from ..head import Part
from ..patches import EYE_CENTER, EYE_RADIUS
from .iris import SCLERA_CORNER

COLUMNS = 22
ROWS = 18
PLICA_THICKNESS = 0.2
"""How far the fold by the ball stands over it, mm."""
SINK = 0.5
"""How deep under the ball's surface the flesh ends, mm."""
OUTER_FILLET = 1.7
"""How widely the outer corner's bed runs into the ball, mm."""
OUTER_RISE = 0.6
"""How much farther forward that bed lies towards the ball, mm."""
INNER_SHADE, OUTER_SHADE = 0.66, 0.68
"""How much light reaches the flesh between the lids, at most."""

# Linear RGB.
CARUNCLE = np.array([0.52, 0.205, 0.165])
PLICA = np.array([0.54, 0.28, 0.235])
BED = np.array([0.40, 0.13, 0.105])
OUTER_BED = np.array([0.40, 0.17, 0.14])


def caruncle_parts(lid_edge: FloatArray) -> list[Part]:
    """Return the corners' flesh of both eyes.

    Args:
        lid_edge: Front edge of the left lids by spoke [mm], shape (16, 3).
    """
    inner, inner_colors = _inner_corner(lid_edge)
    outer, outer_colors = _outer_corner(lid_edge)
    left, colors = joined([inner, outer]), np.vstack([inner_colors, outer_colors])
    return [
        Part(
            name=f"caruncle.{side}",
            vertices=mesh[0],
            normals=vertex_normals(*mesh),
            triangles=mesh[1],
            colors=colors,
            material="wet",
            follows="skull",
        )
        for side, mesh in (("L", left), ("R", reflected(left)))
    ]


def _inner_corner(lid_edge: FloatArray) -> tuple[Mesh, FloatArray]:
    """Return a sheet from behind the inner corner to under the ball, with caruncle and plica."""
    corner, above, below = lid_edge[0], lid_edge[1], lid_edge[15]
    middle_y = 0.5 * (above[1] + below[1])
    # A place is told by its share of the way from the corner to where the ball begins.
    ball_x = EYE_CENTER[0] - 10.1
    start = corner[0] + 0.2
    along = np.linspace(-0.3, 1.3, COLUMNS)[:, None]
    across = np.linspace(-1, 1, ROWS)[None, :]
    x = start + (ball_x - start) * along + 0 * across
    height = 6.8 * across * (0.3 + 0.7 * np.abs(across)) + 0 * along
    y = corner[1] + (middle_y - corner[1]) * along.clip(0, 1) + height
    bed = corner[2] - 1.3 + 1.3 * along - 1.5 * (np.hypot(1, height / 2.2) - 1)
    bed = bed - 2.0 * np.maximum(0, -along)
    bump = np.exp(-(((along - 0.34) / 0.27) ** 2) - ((height + 0.3) / 1.35) ** 2)
    lumps = 0.10 * np.sin(5.1 * x + 2.0) * np.sin(4.3 * y) * bump
    groove = 0.3 * np.exp(-(((along - 0.66) / 0.09) ** 2))
    flesh = bed + 1.7 * bump + lumps - groove
    # The plica is a fold that lies on the ball and dives under it.
    off = (x - EYE_CENTER[0]) ** 2 + (y - EYE_CENTER[1]) ** 2
    ball = EYE_CENTER[2] + np.sqrt(np.maximum(EYE_RADIUS**2 - off, 0.0))
    fold = ball + PLICA_THICKNESS - (PLICA_THICKNESS + SINK) * smoothstep(0.95, 1.25, along)
    depth = 0.5 * (flesh + fold + np.sqrt((flesh - fold) ** 2 + 0.25))
    pink = bump[..., None]
    colors = BED + (CARUNCLE - BED) * pink**0.7
    colors = (
        colors + (PLICA - colors) * (0.85 * smoothstep(0.55, 0.85, along + 0 * across))[..., None]
    )
    to_ball = smoothstep(0.7, 1.0, along + 0 * across)[..., None]
    colors = colors + (0.7 * SCLERA_CORNER - colors) * to_ball
    # The lids shade it as they do the ball, and the upper one more.
    shade = INNER_SHADE * (1 - 0.3 * smoothstep(-0.1, 0.6, across + 0 * along))[..., None]
    return _sheet(x, y, depth), (shade * colors).reshape(-1, 3)


def _outer_corner(lid_edge: FloatArray) -> tuple[Mesh, FloatArray]:
    """Return a hollow sheet from under the ball to behind the outer corner.

    It leaves the ball in a fillet and in its colour, as the conjunctiva does that covers both.
    """
    corner, above, below = lid_edge[8], lid_edge[7], lid_edge[9]
    middle_y = 0.5 * (above[1] + below[1])
    start = EYE_CENTER[0] + 8.6
    along = np.linspace(0.0, 1.25, COLUMNS)[:, None]
    across = np.linspace(-1, 1, ROWS)[None, :]
    x = start + (corner[0] - start) * along + 0 * across
    height = across * (5.2 - 2.8 * along.clip(0, 1))
    y = middle_y + (corner[1] - middle_y) * along.clip(0, 1) + height
    off = (x - EYE_CENTER[0]) ** 2 + (y - EYE_CENTER[1]) ** 2
    ball = EYE_CENTER[2] + np.sqrt(np.maximum(EYE_RADIUS**2 - off, 0.0))
    ball = ball - 3.0 * np.maximum(0.0, np.sqrt(off) - EYE_RADIUS)
    bed = corner[2] - 1.2 + OUTER_RISE * (1 - along) - 2.2 * np.maximum(0, along - 1)
    bed = bed - 0.06 * height**2
    ball_under = ball - SINK * smoothstep(0.55, 0.0, along)
    depth = 0.5 * (bed + ball_under + np.sqrt((bed - ball_under) ** 2 + OUTER_FILLET**2))
    depth = depth - 0.5 * OUTER_FILLET * smoothstep(0.45, 0.0, along)
    to_bed = smoothstep(0.2, 0.9, along + 0.03 * np.abs(height))[..., None]
    colors = SCLERA_CORNER + (OUTER_BED - SCLERA_CORNER) * to_bed
    # Lids shade it from both sides, and meet where it ends; it begins as bright as the ball.
    shade = OUTER_SHADE - (OUTER_SHADE - 0.2) * smoothstep(0.0, 0.9, along + 0 * across)
    shade = (shade * (1 - 0.4 * smoothstep(0.0, 0.8, across + 0 * along)))[..., None]
    return _sheet(x, y, depth), (shade * colors).reshape(-1, 3)


def _sheet(x: FloatArray, y: FloatArray, z: FloatArray) -> Mesh:
    """Return a grid of points as a mesh that faces +z; columns run outwards, rows upwards."""
    columns, rows = z.shape
    triangles = grid_triangles(columns, rows, closed=False)
    return np.stack([x, y, z], axis=2).reshape(-1, 3), triangles
