"""Eyeballs with iris and pupil, the corneas before them, and the flesh in the eyes' corners."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import (
    Mesh,
    grid_triangles,
    reflected,
    unit_sphere,
    vertex_normals,
    without_slivers,
)
from ..head import BULGE_HEIGHT, BULGE_POWER, Part
from ..patches import EYE_CENTER, EYE_RADIUS

SEGMENTS = 96
PUPIL_RADIUS = 1.95
IRIS_RADIUS = 5.85
IRIS_RECESS = 1.15
"""How far the rim of the iris lies behind the plane of the limbus, mm."""
PUPIL_RECESS = 0.5
LIMBUS_ANGLE = float(np.arcsin(IRIS_RADIUS / EYE_RADIUS))
CAUSTIC_ANGLE = float(np.radians(-55))
CORNEA_RADIUS = 6.3
CORNEA_BULGE_RADIUS = 6.2
BACK_ANGLE = 2.2
"""Angle from the eye's axis beyond which the ball is left open, radians."""

# Linear RGB.
PUPIL = np.array([0.004, 0.004, 0.004])
IRIS_INNER = np.array([0.27, 0.14, 0.052])
IRIS_OUTER = np.array([0.075, 0.062, 0.045])
LIMBUS = np.array([0.05, 0.04, 0.035])
SCLERA = np.array([0.66, 0.565, 0.50])
SCLERA_PINK = np.array([0.46, 0.25, 0.21])
CARUNCLE = np.array([0.50, 0.20, 0.17])
CORNER_FILLER = np.array([0.31, 0.18, 0.155])


def eye_parts() -> list[Part]:
    """Return eye, cornea and caruncle of both sides."""
    ball, ball_colors = _eyeball()
    cornea = _cornea()
    flesh, flesh_colors = _corner_flesh()
    parts = []
    for side, offset in (("L", EYE_CENTER), ("R", EYE_CENTER * [-1, 1, 1])):
        # The ball is its own mirror image but for the noise in its iris, so it is only moved.
        vertices = ball[0] + offset
        parts.append(
            Part(
                name=f"eye.{side}",
                vertices=vertices,
                normals=vertex_normals(*ball),
                triangles=ball[1],
                colors=ball_colors,
                material="eye",
                follows=f"eye.{side}",
            )
        )
        parts.append(
            Part(
                name=f"cornea.{side}",
                vertices=cornea[0] + offset,
                normals=vertex_normals(*cornea),
                triangles=cornea[1],
                colors=np.zeros_like(cornea[0]),
                material="cornea",
                follows=f"eye.{side}",
            )
        )
        mesh = flesh if side == "L" else reflected(flesh)
        parts.append(
            Part(
                name=f"caruncle.{side}",
                vertices=mesh[0],
                normals=vertex_normals(*mesh),
                triangles=mesh[1],
                colors=flesh_colors,
                material="wet",
                follows="skull",
            )
        )
    return parts


def _eyeball() -> tuple[Mesh, FloatArray]:
    """Return the ball about the origin, looking along +z, and its colours."""
    around = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
    disc = np.r_[0, np.linspace(0.9, PUPIL_RADIUS, 3), np.linspace(2.05, IRIS_RADIUS - 0.2, 14)]
    polar = np.r_[
        np.linspace(LIMBUS_ANGLE - 0.02, LIMBUS_ANGLE + 0.10, 5),
        np.linspace(LIMBUS_ANGLE + 0.16, 1.35, 11),
        np.linspace(1.5, BACK_ANGLE, 4),
    ]
    limbus_plane = EYE_RADIUS * np.cos(LIMBUS_ANGLE)
    disc_depth = limbus_plane - IRIS_RECESS + 0.9 * (disc / IRIS_RADIUS) ** 2
    disc_depth -= PUPIL_RECESS * (disc <= PUPIL_RADIUS)
    radius = np.r_[disc, EYE_RADIUS * np.sin(polar)]
    depth = np.r_[disc_depth, EYE_RADIUS * np.cos(polar)]
    vertices = np.stack(
        [
            radius[:, None] * np.cos(around),
            radius[:, None] * np.sin(around),
            np.repeat(depth[:, None], SEGMENTS, axis=1),
        ],
        axis=2,
    )
    colors = np.concatenate([_iris_colors(disc, around), _sclera_colors(polar, around)])
    mesh = vertices.reshape(-1, 3)
    triangles = grid_triangles(len(radius), SEGMENTS, closed=True)
    return (mesh, without_slivers(mesh, triangles)), colors.reshape(-1, 3)


def _iris_colors(disc: FloatArray, around: FloatArray) -> FloatArray:
    """Return colours (r, SEGMENTS, 3): pupil, fibres that thin out outwards, dark rim."""
    noise = np.random.default_rng(11)
    fine = noise.normal(size=SEGMENTS)
    broad = noise.normal(size=SEGMENTS)
    broad = (np.roll(broad, 1) + 2 * broad + np.roll(broad, -1)) / 4
    share = (disc / IRIS_RADIUS)[:, None]
    outwards = smoothstep(0.42, 0.85, share)
    base = IRIS_INNER * (1 - outwards[..., None]) + IRIS_OUTER * outwards[..., None]
    # The collarette: a paler frill a third of the way out.
    frill = np.exp(-(((share - 0.5 - 0.02 * broad) / 0.06) ** 2))
    fibre = 1 + 0.3 * (0.6 * fine + 0.6 * broad) * smoothstep(0.33, 0.5, share)
    light = fibre * (1 + 0.35 * frill)
    light = light * (1 - 0.75 * smoothstep(0.84, 1.0, share))
    light = light * (0.55 + 0.45 * smoothstep(0.34, 0.42, share))
    light = light * (1 - 0.5 * np.maximum(np.sin(around), 0) * smoothstep(0.3, 1, share))  # the lid
    # The cornea gathers light on the side away from the key light.
    caustic = np.maximum(np.cos(around - CAUSTIC_ANGLE), 0) ** 2 * smoothstep(0.3, 0.6, share)
    light = light * (1 + 0.9 * caustic)
    colors = base * light[..., None]
    return np.asarray(np.where((disc <= PUPIL_RADIUS)[:, None, None], PUPIL, np.clip(colors, 0, 1)))


def _sclera_colors(polar: FloatArray, around: FloatArray) -> FloatArray:
    """Return colours (r, SEGMENTS, 3): dark limbus, off-white, pink to the sides and back."""
    from_limbus = smoothstep(LIMBUS_ANGLE - 0.02, LIMBUS_ANGLE + 0.085, polar)[:, None, None]
    to_back = smoothstep(0.62, 1.15, polar)[:, None, None]
    colors = LIMBUS * (1 - from_limbus) + SCLERA * from_limbus
    colors = colors * (1 - to_back) + SCLERA_PINK * to_back
    height = EYE_RADIUS * np.sin(polar)[:, None] * np.sin(around)
    shade = (1 - 0.45 * smoothstep(0.5, 4.0, height)) * (1 - 0.45 * smoothstep(3.2, 5.4, height))
    shade = shade * (1 - 0.16 * smoothstep(-3, -5.5, height))
    return np.asarray(np.broadcast_to(colors, (*height.shape, 3)) * shade[..., None])


def _cornea() -> Mesh:
    """Return the cap about the origin that stands out before the iris."""
    around = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    radius = np.linspace(0, CORNEA_RADIUS, 14)
    profile = np.maximum(0, 1 - (radius / CORNEA_BULGE_RADIUS) ** 2) ** BULGE_POWER
    depth = np.sqrt(EYE_RADIUS**2 - radius**2) + 0.05 + BULGE_HEIGHT * profile
    vertices = np.stack(
        [
            radius[:, None] * np.cos(around),
            radius[:, None] * np.sin(around),
            np.repeat(depth[:, None], len(around), axis=1),
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(len(radius), len(around), closed=True)
    return vertices, without_slivers(vertices, triangles)


def _corner_flesh() -> tuple[Mesh, FloatArray]:
    """Return the left eye's caruncle and the flesh of its outer corner, behind which one would see.

    The ball is narrower than the opening of the lids.
    """
    sphere, triangles = unit_sphere(12, 16)
    inner = sphere * [4.1, 3.3, 2.8] + [19.4, -0.7, 74.8]
    outer = sphere * [3.9, 3.6, 4.6] + [42.9, 0.4, 71.2]
    colors = np.repeat([CARUNCLE, CORNER_FILLER], len(sphere), axis=0)
    mesh = np.vstack([inner, outer])
    return (mesh, np.vstack([triangles, triangles + len(sphere)])), colors
