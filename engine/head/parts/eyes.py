"""Eyeballs whose iris lies behind the plane of the limbus, and the corneas that stand before them.

Sizes after Snell and Lemp, "Clinical Anatomy of the Eye", 1998: a cornea of 7.8 mm radius on a ball
of 12, its top 3 mm before the pupil.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...arrays import FloatArray, IntArray
from ...cache import Arrays, cached_arrays
from ..geometry import Mesh, grid_triangles, vertex_normals, without_slivers
from ..head import Part
from ..patches import EYE_CENTER, EYE_RADIUS
from ..recipe import STANDARD, Recipe
from ..storage import source_key
from .iris import IRIS_RADIUS, PUPIL_RADIUS, SIZE, colors_at, eye_uvs

SEGMENTS = 44
IRIS_ROOT = 9.75
"""Depth of the iris's rim along the eye's axis, from the ball's middle, mm."""
IRIS_RISE = 0.35
"""How much farther forward its edge at the pupil lies: the lens carries it."""
PUPIL_RECESS = 0.6
LIMBUS_ANGLE = float(np.arcsin(IRIS_RADIUS / EYE_RADIUS))
CORNEA_CURVATURE = 7.8
"""Radius of the cornea's front, mm."""
CORNEA_CENTER = float(
    np.sqrt(EYE_RADIUS**2 - IRIS_RADIUS**2) - np.sqrt(CORNEA_CURVATURE**2 - IRIS_RADIUS**2)
)
CORNEA_REACH = 6.5
"""Radius at which the cornea's shell ends on the sclera, mm."""
CORNEA_LIFT = 0.03
"""Of the shell over the ball, so that neither flickers through the other, mm."""
SEEN = ("eye_color", "age", "skin", "seed")
"""What of a recipe an eye's colours tell of."""
BACK_ANGLE = 2.2
"""Angle from the eye's axis beyond which the ball is left open, radians."""


def eye_parts() -> list[Part]:
    """Return ball and cornea of both eyes, not yet painted (`eyes_of`)."""
    ball, uvs = _eyeball()
    cornea = _cornea()
    parts = []
    for side, offset in (("L", EYE_CENTER), ("R", EYE_CENTER * [-1, 1, 1])):
        # The shape is its own mirror image, so it is only moved; the right eye's map is mirrored.
        parts.append(
            Part(
                name=f"eye.{side}",
                vertices=ball[0] + offset,
                normals=vertex_normals(*ball),
                triangles=ball[1],
                colors=np.zeros_like(ball[0]),
                material="eye",
                follows=f"eye.{side}",
                uvs=uvs if side == "L" else _turned_over(uvs),
            )
        )
        cornea_uvs = eye_uvs(cornea[0])
        if side == "R":
            cornea_uvs[:, 0] = 1 - cornea_uvs[:, 0]
        parts.append(
            Part(
                name=f"cornea.{side}",
                vertices=cornea[0] + offset,
                normals=vertex_normals(*cornea),
                triangles=cornea[1],
                colors=np.zeros_like(cornea[0]),
                material="cornea",
                follows=f"eye.{side}",
                uvs=cornea_uvs,
            )
        )
    return parts


def eyes_of(parts: Sequence[Part], recipe: Recipe) -> tuple[Part, ...]:
    """Return a head's parts with the eyeballs in a person's colours.

    They show until the person's map is there, and wherever maps are left out.
    """
    left, right = _ball_colors(replace(STANDARD, **{name: getattr(recipe, name) for name in SEEN}))
    own = {"eye.L": left, "eye.R": right}
    return tuple(
        replace(part, colors=own[part.name]) if part.name in own else part for part in parts
    )


@lru_cache(maxsize=16)
def _ball_colors(recipe: Recipe) -> tuple[FloatArray, FloatArray]:
    def paint() -> Arrays:
        _, uvs = _eyeball()
        left, right = _at(recipe, np.stack([uvs, _turned_over(uvs)]))
        return {"left": left, "right": right}

    arrays = cached_arrays("eyes", source_key(recipe), paint)
    return arrays["left"], arrays["right"]


def _eyeball() -> tuple[Mesh, FloatArray]:
    """Return the ball about the origin, looking along +z, and where it lies on the eye's map."""
    disc = np.r_[
        0.0, PUPIL_RADIUS - 0.02, PUPIL_RADIUS + 0.04, 2.3, 2.9, 3.6, 4.3, 5.0, 5.5, IRIS_RADIUS
    ]
    polar = np.r_[
        LIMBUS_ANGLE + np.array([0.0, 0.03, 0.07, 0.14, 0.24]),
        np.linspace(0.86, 1.4, 5),
        1.6,
        1.9,
        BACK_ANGLE,
    ]
    inwards = (IRIS_RADIUS - disc) / (IRIS_RADIUS - PUPIL_RADIUS)
    disc_depth = IRIS_ROOT + IRIS_RISE * np.clip(inwards, 0, 1)
    disc_depth[:2] -= PUPIL_RECESS
    radius = np.r_[disc, EYE_RADIUS * np.sin(polar)]
    depth = np.r_[disc_depth, EYE_RADIUS * np.cos(polar)]
    vertices, triangles = _turned(radius, depth, SEGMENTS)
    # On the map the iris lies where the limbus seen from in front has it.
    shown = vertices.copy()
    on_disc = np.repeat(np.arange(len(radius)) < len(disc), SEGMENTS)
    flat = np.hypot(shown[on_disc, 0], shown[on_disc, 1])
    shown[on_disc, 2] = np.sqrt(EYE_RADIUS**2 - flat**2)
    return (vertices, triangles), eye_uvs(shown)


def cornea_depth(off_axis: FloatArray) -> FloatArray:
    """Return the depth of the cornea's front at distances from the eye's axis [mm]."""
    within = np.minimum(off_axis, IRIS_RADIUS)
    cap = CORNEA_CENTER + np.sqrt(CORNEA_CURVATURE**2 - within**2)
    ball = np.sqrt(EYE_RADIUS**2 - off_axis**2)
    return np.asarray(np.where(off_axis < IRIS_RADIUS, cap, ball) + CORNEA_LIFT)


def _cornea() -> Mesh:
    """Return the shell about the origin that stands out before the iris."""
    radius = np.r_[0.0, 0.9, 1.8, 2.7, 3.5, 4.2, 4.8, 5.3, 5.65, 5.95, CORNEA_REACH]
    depth = cornea_depth(radius)
    # The furrow of the limbus is shallow: the cap runs into the ball without an edge.
    depth[-3] -= 0.015
    return _turned(radius, depth, 36)


def _turned(radius: FloatArray, depth: FloatArray, segments: int) -> tuple[FloatArray, IntArray]:
    """Return a profile turned about the z axis, facing +z."""
    around = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    vertices = np.stack(
        [
            radius[:, None] * np.cos(around),
            radius[:, None] * np.sin(around),
            np.repeat(depth[:, None], segments, axis=1),
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(len(radius), segments, closed=True)
    return vertices, without_slivers(vertices, triangles)


def _turned_over(uvs: FloatArray) -> FloatArray:
    """Return the places (v, 2) on the right eye's map of the left eye's."""
    return np.column_stack([1 - uvs[:, 0], uvs[:, 1]])


def _at(recipe: Recipe, uvs: FloatArray) -> FloatArray:
    """Return the map's colour at places (..., 2), the mean of a few pixels round each."""
    place = np.clip((uvs * SIZE).astype(np.int64), 2, SIZE - 3)
    # Rows and columns of the four pixels, shape (4, ...) each.
    beside = np.array([(row, column) for row in (-1, 1) for column in (-1, 1)])
    rows = np.add.outer(beside[:, 0], place[..., 1])
    columns = np.add.outer(beside[:, 1], place[..., 0])
    return np.asarray(colors_at(recipe, rows, columns).mean(axis=0))
