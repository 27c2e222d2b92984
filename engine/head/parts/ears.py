"""The ears: a height field about the bowl, folded back behind the rim and sunk into the head."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import (
    Mesh,
    grid_triangles,
    linear_rgb,
    reflected,
    vertex_normals,
    without_slivers,
)
from ..head import Part

CENTER = np.array([78.0, -17.0, -17.0])
TILT = np.radians(-12)
"""The ear leans back by this."""
FLARE = np.radians(27)
"""It stands off the head by this."""

SEGMENTS = 72
# The outline about the bowl: angle (0 forward, 90 up) and radius, mm.
OUTLINE = (
    (0, 15.5), (30, 19.0), (60, 26.5), (90, 32.0), (120, 31.5), (150, 25.5), (180, 21.0),
    (210, 21.5), (240, 26.0), (265, 30.0), (285, 27.5), (310, 19.5), (335, 15.0),
)  # fmt: skip
RINGS = np.r_[np.linspace(0, 0.3, 5), np.linspace(0.36, 0.98, 19), 1.0, 1.0, 0.97, 0.9, 0.78, 0.62]
FOLD = (0.0, 1.8, 4.2, 8.0, 14.0, 26.0)
"""How far the last rings fall behind the rim, mm."""


def ear_parts() -> list[Part]:
    """Return both ears, the right one mirrored."""
    mesh, colors = _left_ear()
    parts = []
    for side, ear in (("L", mesh), ("R", reflected(mesh))):
        parts.append(
            Part(
                name=f"ear.{side}",
                vertices=ear[0],
                normals=vertex_normals(*ear),
                triangles=ear[1],
                colors=colors,
                material="skin",
                follows="skull",
            )
        )
    return parts


def _left_ear() -> tuple[Mesh, FloatArray]:
    around = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
    angles = np.radians([angle for angle, _ in OUTLINE])
    radii = [radius for _, radius in OUTLINE]
    outline = CubicSpline([*angles, 2 * np.pi], [*radii, radii[0]], bc_type="periodic")(around)
    share, angle = np.broadcast_arrays(RINGS[:, None], around[None, :])
    height = _relief(share, angle)
    height[-len(FOLD) :] -= np.array(FOLD)[:, None]
    local = np.stack([share * outline * np.cos(angle), share * outline * np.sin(angle), height], 2)
    vertices = local.reshape(-1, 3) @ _frame() + CENTER
    triangles = without_slivers(vertices, grid_triangles(len(RINGS), SEGMENTS, closed=True))
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    if np.cross(b - a, c - a)[:, 0].sum() < 0:
        triangles = triangles[:, ::-1].copy()
    return (vertices, triangles), _colors(local.reshape(-1, 3))


def _frame() -> FloatArray:
    """Return the ear's forward, up and outward directions in the head's frame, as rows."""
    forward = np.array([0.0, -np.sin(TILT), np.cos(TILT)])
    up = np.array([0.0, np.cos(TILT), np.sin(TILT)])
    outward = np.array([1.0, 0.0, 0.0])
    return np.array(
        [
            forward * np.cos(FLARE) - outward * np.sin(FLARE),
            up,
            outward * np.cos(FLARE) + forward * np.sin(FLARE),
        ]
    )


def _relief(share: FloatArray, angle: FloatArray) -> FloatArray:
    """Return the height over the ear's plane [mm] at a share of the outline and an angle."""
    back, up = 0.5 - 0.5 * np.cos(angle), np.sin(angle)
    forward, rise = share * np.cos(angle), share * np.sin(angle)
    rear = smoothstep(0.02, 0.35, back) * (1 - smoothstep(-0.55, -0.95, up))
    top = smoothstep(0.2, 0.6, up) * smoothstep(0.85, -0.1, np.cos(angle))
    rim = np.clip(np.maximum(rear, top * 0.9), 0, 1)

    def ridge(place: float, width: float) -> FloatArray:
        return np.asarray(np.exp(-(((share - place) / width) ** 2)))

    def knob(x: float, y: float, width: float, tallness: float) -> FloatArray:
        return np.asarray(np.exp(-(((forward - x) / width) ** 2) - ((rise - y) / tallness) ** 2))

    height = -5.0 * np.exp(-((share / 0.36) ** 4))  # the bowl (concha)
    height = height + 4.0 * ridge(0.60, 0.105) * rim * (1 - 0.35 * top)  # antihelix
    height -= 1.5 * ridge(0.79, 0.07) * rim  # scapha
    height += 4.6 * ridge(0.94, 0.055) * rim  # helix
    height += 4.8 * knob(0.50, -0.10, 0.16, 0.16)  # tragus
    height += 3.4 * knob(0.20, -0.42, 0.15, 0.13)  # antitragus
    height += 2.2 * knob(0.25, 0.16, 0.30, 0.06) * smoothstep(0.9, 0.3, share)  # crus of the helix
    height += 1.2 * smoothstep(-0.6, -0.9, up * share)  # lobe
    # The front edge dives into the cheek.
    dive = smoothstep(0.62, 1.0, share) * smoothstep(-0.05, 0.6, np.cos(angle))
    return np.asarray(height - 12.0 * dive * smoothstep(-1.0, -0.7, up))


def _colors(local: FloatArray) -> FloatArray:
    height = local[:, 2:]
    radius = np.hypot(local[:, :1], local[:, 1:2])
    skin, red, dark = ([0.79, 0.53, 0.43], [0.77, 0.43, 0.365], [0.47, 0.25, 0.20])
    to_red = 0.5 * smoothstep(1, 5, height)
    to_dark = 0.8 * smoothstep(-2, -8, height) * (radius < 16)
    color = np.array(skin) * (1 - to_red) + np.array(red) * to_red
    return linear_rgb(color * (1 - to_dark) + np.array(dark) * to_dark)
