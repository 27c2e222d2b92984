"""Teeth and gums: seven crowns a quadrant on a parabolic arch, gums scalloped round their necks.

Crown widths and heights are of the order of the tables in Wheeler, "Dental Anatomy".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, joined, reflected, vertex_normals, without_slivers
from ..head import Part


@dataclass(frozen=True)
class Arch:
    """One jaw's row of teeth.

    Attributes:
        jaw: "upper" or "lower".
        follows: "skull" or "jaw".
        half_width: Of the arch at its ends, mm.
        front: Depth z of the labial faces at the midline, mm.
        up: +1 when the roots point up, -1 when down.
        edge: Height of the biting edge of the front teeth, mm.
        back_edge: Height of the chewing faces, mm.
        widths: Of the crowns from the midline, mm.
        heights: Of the crowns, mm.
        thicknesses: Of the crowns at the neck, mm.
    """

    jaw: str
    follows: str
    half_width: float
    front: float
    up: int
    edge: float
    back_edge: float
    widths: tuple[float, ...]
    heights: tuple[float, ...]
    thicknesses: tuple[float, ...]


ARCH_LENGTH = 44.0
ARCH_POWER = 2.1
FIRST_CHEEK_TOOTH = 3

UPPER = Arch(
    jaw="upper",
    follows="skull",
    half_width=29.0,
    front=94.9,
    up=1,
    edge=-74.0,
    back_edge=-73.3,
    widths=(8.6, 6.7, 7.7, 7.0, 6.8, 9.8, 9.4),
    heights=(10.3, 9.1, 10.2, 8.6, 8.0, 7.4, 7.0),
    thicknesses=(6.6, 5.8, 7.4, 8.6, 8.8, 10.6, 10.6),
)
LOWER = Arch(
    jaw="lower",
    follows="jaw",
    half_width=27.5,
    front=90.9,
    up=-1,
    edge=-73.0,
    back_edge=-73.8,
    widths=(5.4, 5.9, 6.8, 7.0, 7.0, 10.4, 10.0),
    heights=(8.8, 9.2, 10.2, 8.6, 8.0, 7.4, 7.0),
    thicknesses=(5.6, 6.0, 7.2, 7.8, 8.2, 10.2, 10.0),
)

SECTION_POINTS = 24
SECTION_POWER = 2.7
"""Exponent of the superellipse that a crown's level section is."""

# From the neck (inside the gum) to the biting edge: share of the height, of the width, and of the
# thickness for front teeth and for cheek teeth.
CROWN_PROFILE = (
    (1.25, 0.66, 0.80, 0.80),
    (1.05, 0.74, 0.98, 0.94),
    (0.85, 0.84, 1.00, 1.00),
    (0.60, 0.93, 0.84, 1.00),
    (0.38, 0.985, 0.64, 0.98),
    (0.20, 1.0, 0.46, 0.93),
    (0.08, 0.99, 0.33, 0.84),
    (0.02, 0.95, 0.25, 0.68),
    (0.00, 0.86, 0.16, 0.40),
    (0.00, 0.00, 0.00, 0.00),
)

# Linear RGB.
ENAMEL = np.array([0.82, 0.71, 0.56])
ENAMEL_NECK = np.array([0.68, 0.51, 0.32])
ENAMEL_EDGE = np.array([0.74, 0.69, 0.60])
FLESH_TINT = np.array([0.7, 1.2, 1.3])
GUM = np.array([0.46, 0.165, 0.155])
GUM_MARGIN = np.array([0.56, 0.25, 0.225])


def teeth_parts() -> list[Part]:
    """Return teeth and gum of both jaws."""
    parts = []
    for arch in (UPPER, LOWER):
        for name, material, (mesh, colors) in (
            ("teeth", "teeth", _row(arch)),
            ("gum", "wet", _gum(arch)),
        ):
            parts.append(
                Part(
                    name=f"{name}.{arch.jaw}",
                    vertices=mesh[0],
                    normals=vertex_normals(*mesh),
                    triangles=mesh[1],
                    colors=colors,
                    material=material,
                    follows=arch.follows,
                )
            )
    return parts


def dental_arch(arch: Arch, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return points (k, 2) as (x, z) on the labial faces, and the outward directions (k, 2).

    Args:
        arch: Whose arch.
        along: Distance from the midline along the arch [mm], shape (k,).
    """
    share = np.linspace(0, 1, 400)
    x = arch.half_width * np.sin(share * np.pi / 2)
    z = arch.front - ARCH_LENGTH * share**ARCH_POWER
    walked = np.r_[0, np.cumsum(np.hypot(np.diff(x), np.diff(z)))]
    tangent = np.column_stack([np.gradient(x, walked), np.gradient(z, walked)])
    side = np.abs(along)
    points = np.column_stack([np.interp(side, walked, x), np.interp(side, walked, z)])
    direction = np.column_stack([np.interp(side, walked, tangent[:, axis]) for axis in (0, 1)])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    outward = np.column_stack([-direction[:, 1], direction[:, 0]])
    sign = np.where(along < 0, -1.0, 1.0)
    points[:, 0] *= sign
    outward[:, 0] *= sign
    return points, outward


def mouth_shade(vertices: FloatArray) -> FloatArray:
    """Return how much light, linear RGB in 0..1, reaches points (v, 3) inside the mouth.

    What reaches the back teeth has been red flesh before.
    """
    depth = smoothstep(56.0, 93.0, vertices[:, 2] - 0.3 * np.abs(vertices[:, 0]))
    return np.asarray((0.10 + 0.90 * depth)[:, None] ** FLESH_TINT)


def _row(arch: Arch) -> tuple[Mesh, FloatArray]:
    centers = np.cumsum(arch.widths) - np.array(arch.widths) / 2
    pieces, colors = [], []
    for number, center in enumerate(centers):
        crown, color = _crown(arch, number, float(center))
        pieces += [crown, reflected(crown)]
        colors += [color, color]
    mesh = joined(pieces)
    return mesh, np.vstack(colors) * mouth_shade(mesh[0])


def _crown(arch: Arch, number: int, center: float) -> tuple[Mesh, FloatArray]:
    """Return one crown of the left side and its colours."""
    is_front = number < FIRST_CHEEK_TOOTH
    profile = np.array(CROWN_PROFILE)
    height = arch.heights[number] * profile[:, 0]
    width = arch.widths[number] * 0.5 * profile[:, 1]
    thickness = arch.thicknesses[number] * 0.5 * profile[:, 2 if is_front else 3]

    angle = np.linspace(0, 2 * np.pi, SECTION_POINTS, endpoint=False)
    across = _power(np.cos(angle)) * width[:, None]
    deep = _power(np.sin(angle)) * thickness[:, None]
    # Front teeth keep their labial face almost upright: what they lose towards the edge, they lose
    # behind. A gentle bow keeps the face from being flat.
    bow = 0.55 * np.sin(np.pi * np.clip(profile[:, 0], 0, 1)) - 0.35 * (1 - profile[:, 0])
    behind = thickness if is_front else np.full(len(thickness), thickness.max())
    deep = deep - behind[:, None] + bow[:, None]
    rise = np.repeat(height[:, None], SECTION_POINTS, axis=1)
    rise = rise + _edge_relief(number, profile[:, :1], across / arch.widths[number], deep)

    point, outward = dental_arch(arch, np.array([center]))
    along = np.array([outward[0, 1], -outward[0, 0]])
    edge = arch.edge if is_front else arch.back_edge
    edge += 0.6 * arch.up if number == 1 else 0.0
    vertices = np.stack(
        [
            point[0, 0] + across * along[0] + deep * outward[0, 0],
            edge + arch.up * rise,
            point[0, 1] + across * along[1] + deep * outward[0, 1],
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(len(profile), SECTION_POINTS, closed=True)
    colors = _enamel(profile[:, 0], across / width.max(), number)
    return (vertices, _outwards(vertices, triangles)), colors


def _power(value: FloatArray) -> FloatArray:
    return np.asarray(np.sign(value) * np.abs(value) ** (2 / SECTION_POWER))


def _edge_relief(
    number: int, height_share: FloatArray, across: FloatArray, deep: FloatArray
) -> FloatArray:
    """Return how far the edge is lifted towards the root: canine tips, cusps, rounded corners."""
    near_edge = np.maximum(0.0, 1 - height_share / 0.4)
    if number < 2:
        return np.asarray(near_edge * 0.9 * np.abs(2 * across) ** 4)
    if number == 2:
        return np.asarray(near_edge * 1.5 * np.abs(2 * across) ** 1.3)
    middle = deep - deep.mean()
    groove = np.exp(-((middle / 1.6) ** 2))
    return np.asarray(near_edge * (0.7 * groove + 0.25 * np.cos(2 * np.pi * 2 * across)))


def _enamel(height_share: FloatArray, across: FloatArray, number: int) -> FloatArray:
    to_neck = smoothstep(0.45, 1.0, height_share)[:, None, None]
    to_edge = smoothstep(0.28, 0.02, height_share)[:, None, None] * (number < 2)
    color = ENAMEL * (1 - to_neck) + ENAMEL_NECK * to_neck
    color = color * (1 - 0.6 * to_edge) + ENAMEL_EDGE * 0.6 * to_edge
    if number == 2:
        color = color * [0.97, 0.93, 0.86]
    between = 1 - 0.55 * smoothstep(0.72, 1.0, np.abs(across))
    return np.asarray((color * between[..., None]).reshape(-1, 3))


def _gum(arch: Arch) -> tuple[Mesh, FloatArray]:
    """Return a tube along the necks whose margin rises between the teeth."""
    length = float(np.sum(arch.widths))
    along = np.linspace(-length - 2, length + 2, 181)
    point, outward = dental_arch(arch, np.clip(along, -length, length))
    neck, waist = _neck_line(arch, np.abs(along))
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    # Angle 0 faces outwards, pi / 2 the root, -pi / 2 the margin.
    toward_root = np.sin(angle)
    rise = neck[:, None] + 5.0 * (1 + toward_root) - 0.4
    deep = -4.6 + (4.9 - waist[:, None]) * _power(np.cos(angle)) * (0.82 + 0.18 * toward_root)
    edge = arch.edge + (arch.back_edge - arch.edge) * smoothstep(18, 26, np.abs(along))
    vertices = np.stack(
        [
            point[:, :1] + deep * outward[:, :1],
            edge[:, None] + arch.up * rise,
            point[:, 1:] + deep * outward[:, 1:],
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(len(along), len(angle), closed=True)
    margin = smoothstep(-0.3, -0.9, toward_root)[None, :, None]
    colors = np.broadcast_to(GUM * (1 - margin) + GUM_MARGIN * margin, (len(along), 16, 3))
    mesh = (vertices, _outwards(vertices, triangles))
    return mesh, colors.reshape(-1, 3) * mouth_shade(vertices)


def _neck_line(arch: Arch, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the gum's margin over the biting edge [mm] and how far it recedes, both (k,)."""
    ends = np.cumsum(arch.widths)
    number = np.minimum(np.searchsorted(ends, along), len(ends) - 1)
    width = np.array(arch.widths)[number]
    place = np.clip((along - (ends[number] - width)) / width, 0, 1)
    papilla = np.abs(2 * place - 1) ** 2.2
    height = np.array(arch.heights)[number]
    return height * (0.98 - 0.30 * papilla), 0.75 * papilla


def _outwards(vertices: FloatArray, triangles: IntArray) -> IntArray:
    """Return the triangles with an area, wound so that they enclose a positive volume."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    center = vertices.mean(axis=0)
    volume = np.einsum("ti,ti->", a - center, np.cross(b - center, c - center))
    solid = without_slivers(vertices, triangles)
    return solid if volume > 0 else solid[:, ::-1].copy()
