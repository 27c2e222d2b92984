"""Teeth: fourteen crowns a jaw, each with its own outline, set on an arch.

Sizes of the crowns are those of Ash and Nelson, "Wheeler's Dental Anatomy, Physiology and
Occlusion", 2003, tables 6-1 to 11-2; how the crowns lean follows Andrews, "The six keys to normal
occlusion", 1972.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, joined, reflected, vertex_normals, without_slivers
from ..head import Part
from ..recipe import Recipe


@dataclass(frozen=True)
class Tooth:
    """One kind of crown, mm and degrees.

    Attributes:
        kind: "incisor", "canine", "premolar" or "molar".
        height: From the neck to the biting edge.
        width: Across, along the arch; `neck_width` at the neck.
        thickness: From lip or cheek to tongue; `neck_thickness` at the neck.
        tip: How far the root leans away from the midline.
        torque: How far the root leans inwards; negative where the crown does.
        raised: How far the edge stays short of the plane that the teeth meet in.
    """

    kind: str
    height: float
    width: float
    neck_width: float
    thickness: float
    neck_thickness: float
    tip: float
    torque: float
    raised: float

    @property
    def is_front(self) -> bool:
        """Whether it cuts rather than chews."""
        return self.kind in ("incisor", "canine")


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
        teeth: From the midline to the back.
    """

    jaw: str
    follows: str
    half_width: float
    front: float
    up: int
    edge: float
    teeth: tuple[Tooth, ...]

    @property
    def widths(self) -> FloatArray:
        """Of the crowns from the midline, mm."""
        return np.array([tooth.width for tooth in self.teeth])


ARCH_LENGTH = 44.0
ARCH_POWER = 2.1

UPPER = Arch(
    jaw="upper",
    follows="skull",
    half_width=29.0,
    front=94.9,
    up=1,
    edge=-75.4,
    teeth=(
        Tooth("incisor", 10.5, 8.5, 6.6, 7.0, 6.2, 3, 6, 0.0),
        Tooth("incisor", 9.0, 6.5, 4.9, 6.0, 5.2, 6, 4, 0.7),
        Tooth("canine", 10.0, 7.5, 5.5, 8.0, 7.0, 7, -3, 0.1),
        Tooth("premolar", 8.5, 7.0, 5.0, 9.0, 8.0, 3, -6, 0.7),
        Tooth("premolar", 8.5, 6.8, 5.0, 9.0, 8.0, 2, -7, 0.9),
        Tooth("molar", 7.5, 10.0, 8.0, 11.0, 10.0, 4, -9, 1.2),
        Tooth("molar", 7.0, 9.0, 7.2, 11.0, 10.0, 3, -9, 1.6),
    ),
)
LOWER = Arch(
    jaw="lower",
    follows="jaw",
    half_width=27.2,
    front=91.2,
    up=-1,
    edge=-73.0,
    teeth=(
        Tooth("incisor", 9.0, 5.2, 3.7, 6.0, 5.3, 1, 2, 0.1),
        Tooth("incisor", 9.5, 5.7, 4.1, 6.5, 5.8, 2, 1, 0.0),
        Tooth("canine", 11.0, 7.0, 5.5, 7.5, 7.0, 5, -6, -0.2),
        Tooth("premolar", 8.5, 7.0, 5.0, 7.5, 6.5, 2, -10, 0.6),
        Tooth("premolar", 8.0, 7.0, 5.2, 8.0, 7.0, 2, -13, 1.0),
        Tooth("molar", 7.5, 11.0, 9.0, 10.5, 9.0, 2, -16, 1.3),
        Tooth("molar", 7.0, 10.5, 8.2, 10.0, 9.0, 2, -16, 1.2),
    ),
)

IN_THE_GUM = 0.22
"""Share of its height that a crown's drawn root goes on into the gum."""
FRONT_HEIGHTS = (
    1 + IN_THE_GUM, 1.0, 0.82, 0.62, 0.42, 0.24, 0.10, 0.02, 0.0, 0.0, 0.0,
)  # fmt: skip
"""Heights over the edge at which a front crown is cut, as shares of its height."""
CHEEK_HEIGHTS = (1 + IN_THE_GUM, 1.0, 0.74, 0.45, 0.18, 0.03, 0.0, 0.0)
CROWN_POINTS = 14

# Linear RGB. Enamel is clear over yellower dentine: greyer where it stands alone, at the edge, and
# warmer where it thins out, at the neck.
ENAMEL = np.array([0.66, 0.575, 0.44])
ENAMEL_NECK = np.array([0.58, 0.45, 0.285])
ENAMEL_EDGE = np.array([0.50, 0.475, 0.43])
ENAMEL_CANINE = np.array([0.97, 0.945, 0.90])
STAIN = np.array([0.62, 0.47, 0.30])
FLESH_TINT = np.array([0.7, 1.2, 1.3])


def teeth_parts(recipe: Recipe) -> list[Part]:
    """Return the teeth of both jaws."""
    parts = []
    for arch in (UPPER, LOWER):
        mesh, colors = _row(arch, recipe)
        parts.append(
            Part(
                name=f"teeth.{arch.jaw}",
                vertices=mesh[0],
                normals=vertex_normals(*mesh),
                triangles=mesh[1],
                colors=colors,
                material="teeth",
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


def edge_height(arch: Arch, along: FloatArray) -> FloatArray:
    """Return the height y of the biting edge at distances along the arch [mm], shape (k,)."""
    centers = np.cumsum(arch.widths) - arch.widths / 2
    raised = [tooth.raised for tooth in arch.teeth]
    return np.asarray(arch.edge + arch.up * np.interp(np.abs(along), centers, raised))


def mouth_shade(vertices: FloatArray) -> FloatArray:
    """Return how much light, linear RGB in 0..1, reaches points (v, 3) inside the mouth.

    What reaches the back teeth has been red flesh before.
    """
    depth = smoothstep(44.0, 90.0, vertices[:, 2] - 0.18 * np.abs(vertices[:, 0]))
    return np.asarray((0.08 + 0.92 * depth)[:, None] ** FLESH_TINT)


def outwards(vertices: FloatArray, triangles: IntArray) -> IntArray:
    """Return the triangles with an area, wound so that they enclose a positive volume."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    center = vertices.mean(axis=0)
    volume = np.einsum("ti,ti->", a - center, np.cross(b - center, c - center))
    solid = without_slivers(vertices, triangles)
    return solid if volume > 0 else solid[:, ::-1].copy()


def _row(arch: Arch, recipe: Recipe) -> tuple[Mesh, FloatArray]:
    centers = np.cumsum(arch.widths) - arch.widths / 2
    pieces, colors = [], []
    noise = np.random.default_rng([recipe.seed, 17 if arch.up > 0 else 18])
    for tooth, center in zip(arch.teeth, centers, strict=True):
        for side in (1, -1):
            # Nobody's teeth stand quite in line.
            turn, tip, out = noise.normal(0, [2.2, 1.0, 0.13])
            crown, color = _crown(arch, tooth, float(center), float(turn), float(tip), float(out))
            pieces.append(crown if side > 0 else reflected(crown))
            colors.append(color * noise.normal(1.0, 0.015))
    mesh = joined(pieces)
    return mesh, np.clip(np.vstack(colors) * mouth_shade(mesh[0]), 0, 1)


def _crown(
    arch: Arch, tooth: Tooth, center: float, turn: float, tip: float, out: float
) -> tuple[Mesh, FloatArray]:
    """Return one crown of the left side and its colours.

    Args:
        arch: Its arch.
        tooth: Its kind.
        center: Distance of its middle from the midline along the arch, mm.
        turn: About its own length, degrees.
        tip: Lean along the arch beyond its kind's, degrees.
        out: How far it stands out of the row, mm.
    """
    across, rise, deep, light = _front_crown(tooth) if tooth.is_front else _cheek_crown(tooth)
    height = rise / tooth.height
    # Lean: about the middle of the biting edge, roots backwards and away from the midline.
    lean, torque = np.radians(tooth.tip + tip), np.radians(tooth.torque)
    across, rise = (
        across * np.cos(lean) + rise * np.sin(lean),
        rise * np.cos(lean) - across * np.sin(lean),
    )
    deep, rise = (
        deep * np.cos(torque) - rise * np.sin(torque),
        rise * np.cos(torque) + deep * np.sin(torque),
    )
    # The arch touches the labial faces where they bulge most, not the edges.
    deep = deep + 0.45 * tooth.height * np.sin(torque) + out
    angle = np.radians(turn)
    across, deep = (
        across * np.cos(angle) + deep * np.sin(angle),
        deep * np.cos(angle) - across * np.sin(angle),
    )
    point, outward = dental_arch(arch, np.array([center]))
    along = np.array([outward[0, 1], -outward[0, 0]])
    vertices = np.stack(
        [
            point[0, 0] + across * along[0] + deep * outward[0, 0],
            edge_height(arch, np.array([center]))[0] + arch.up * rise,
            point[0, 1] + across * along[1] + deep * outward[0, 1],
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(across.shape[0], CROWN_POINTS, closed=True)
    colors = _enamel(tooth, height, light)
    return (vertices, outwards(vertices, triangles)), colors


def _front_crown(tooth: Tooth) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return places across, up from the edge and outwards [mm], and light, all (rings, points)."""
    share = np.array(FRONT_HEIGHTS)[:, None]
    closing = np.array([*([1.0] * (len(FRONT_HEIGHTS) - 3)), 0.8, 0.4, 0.0])[:, None]
    angle = np.linspace(0, 2 * np.pi, CROWN_POINTS, endpoint=False)[None, :]
    side, front = np.cos(angle), np.sin(angle)
    # Outline from the front: widest a quarter up, drawn in at the neck, rounded at the corners.
    widest = 0.28 if tooth.kind == "incisor" else 0.42
    inwards = np.clip((share - widest) / (1 - widest), 0, 1.3)
    half = tooth.width / 2 - (tooth.width - tooth.neck_width) / 2 * inwards**1.5
    below = np.clip((widest - share) / widest, 0, 1)
    half = half * (1 - 0.035 * below**2)
    across = half * _power(side, 2.6) * closing
    # From the side: a wedge, labial face bowed, lingual face hollow over a swelling by the neck.
    labial = 0.42 * tooth.height / 10 * np.sin(np.pi * np.clip(share, 0, 1) ** 0.8) - 0.5 * (
        np.clip(1 - share, 0, 1) ** 3
    )
    thick = 1.15 + (tooth.thickness - 1.15) * smoothstep(-0.05, 0.92, share) ** 1.15
    thick = np.where(share > 1, tooth.neck_thickness, thick)
    thick = thick * (0.55 + 0.45 * smoothstep(-0.03, 0.06, share))
    flatness = _power(np.abs(front), 2.4)
    curve = (across / (tooth.width / 2)) ** 2
    front_face = labial - (0.10 + 0.55 * np.clip(share, 0, 1)) * curve - 0.25 * curve**3
    deep = np.where(front >= 0, front_face - 0.42 * thick * (1 - flatness), 0.0)
    back_face = labial - 0.42 * thick - 0.58 * thick * flatness
    hollow = 0.5 * np.exp(-(((share - 0.35) / 0.2) ** 2)) * flatness
    deep = np.where(front < 0, back_face + hollow, deep)
    edge_middle = labial - 0.5 * thick
    deep = edge_middle + (deep - edge_middle) * closing
    # Three lobes, from which the crown grew, show as two shallow furrows and a wavy edge.
    lobes = np.cos(3 * np.pi * across / tooth.width)
    grown = np.clip(1 - share / 0.75, 0, 1) * (front > 0.2)
    place = across / (tooth.width / 2)
    if tooth.kind == "incisor":
        deep = deep + 0.07 * grown * lobes
        corner = 0.55 * np.maximum(0, place) ** 5 + 0.25 * np.maximum(0, -place) ** 7
        lift = corner * tooth.width / 8 + 0.05 * (1 - lobes)
    else:
        deep = deep + 0.25 * grown * np.exp(-((place / 0.35) ** 2))
        point = place - 0.08
        lift = 1.7 * np.where(point > 0, 1.15 * np.abs(point), 0.85 * np.abs(point)) ** 1.35
    rise = share * tooth.height + lift * np.clip(1 - share / 0.45, 0, 1)
    light = 1 - 0.35 * smoothstep(0.78, 1.0, np.abs(place)) * (0.3 + 0.7 * (front < 0.4))
    return across, rise, deep, np.broadcast_to(light, across.shape)


def _cheek_crown(tooth: Tooth) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return what `_front_crown` returns for a tooth with cusps."""
    share = np.array(CHEEK_HEIGHTS)[:, None]
    closing = np.array([*([1.0] * (len(CHEEK_HEIGHTS) - 3)), 0.88, 0.5, 0.0])[:, None]
    angle = np.linspace(0, 2 * np.pi, CROWN_POINTS, endpoint=False)[None, :]
    side, front = np.cos(angle), np.sin(angle)
    inwards = np.clip((share - 0.5) / 0.5, 0, 1.4)
    below = np.clip((0.5 - share) / 0.5, 0, 1)
    half = tooth.width / 2 - (tooth.width - tooth.neck_width) / 2 * inwards**1.4
    half = half * (1 - 0.10 * below**2.2)
    thick = tooth.thickness / 2 - (tooth.thickness - tooth.neck_thickness) / 2 * inwards
    thick = thick * (1 - 0.30 * below**1.8)
    across = half * _power(side, 3.2) * closing
    deep = thick * _power(front, 2.6) * closing
    # Cusps stand at the rim in pairs; between the cheek's and the tongue's runs a groove.
    pairs = 1 if tooth.kind == "premolar" else 2
    rim = np.abs(across) / (tooth.width / 2)
    cusps = (
        np.cos(2 * np.pi * across / tooth.width) * 0.5 + 0.5
        if pairs == 1
        else 0.5 - 0.5 * np.cos(4 * np.pi * across / tooth.width + 0.2)
    )
    tall = 1.5 if pairs == 1 else 1.05
    reach = np.clip(np.abs(deep) / (0.62 * tooth.thickness / 2), 0, 1)
    top = tall * (1 - cusps * reach**1.5) * (0.75 + 0.25 * np.minimum(rim, 1))
    near_top = np.clip(1 - share / 0.42, 0, 1)
    rise = share * tooth.height + top * near_top
    # A furrow between the cusps runs down the cheek's side.
    furrow = np.exp(-((across / 0.7) ** 2)) if pairs == 2 else np.zeros_like(across)
    deep = deep - 0.28 * np.sign(deep) * furrow * np.clip(1 - share / 0.7, 0, 1) * closing
    deep = deep - tooth.thickness / 2
    light = 1 - 0.35 * smoothstep(0.8, 1.0, rim)
    light = light * (1 - 0.3 * (1 - closing) * (1 - 0.6 * cusps))
    return across, rise, deep, np.broadcast_to(light, across.shape)


def _power(value: FloatArray, exponent: float) -> FloatArray:
    return np.asarray(np.sign(value) * np.abs(value) ** (2 / exponent))


def _enamel(tooth: Tooth, height: FloatArray, light: FloatArray) -> FloatArray:
    """Return colours (v, 3) at shares of the crown's height."""
    to_neck = smoothstep(0.45, 1.02, height)[..., None]
    color = ENAMEL + (ENAMEL_NECK - ENAMEL) * to_neck
    if tooth.is_front:
        clear = smoothstep(0.26, 0.02, height)[..., None]
        color = color + (ENAMEL_EDGE - color) * (0.75 * clear)
    else:
        fissure = smoothstep(0.98, 0.72, light)[..., None]
        color = color + (STAIN - color) * (0.35 * fissure)
    if tooth.kind == "canine":
        color = color * ENAMEL_CANINE
    return np.asarray((color * light[..., None]).reshape(-1, 3))
