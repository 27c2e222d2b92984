"""Gums: a fold of gum along each arch, scalloped round the necks and pointed between the teeth.

The papilla fills the gap up to the teeth's contact, 4 to 5 mm short of the neck's height; the
attached gum is paler than the mucosa beyond it (Lindhe, "Clinical Periodontology", 2008).
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, vertex_normals
from ..head import Part
from .teeth import LOWER, UPPER, Arch, dental_arch, edge_height, mouth_shade, outwards

PER_TOOTH = 6
"""Columns of the fold for each tooth."""
BEYOND = 2.5
"""How far the gum goes on behind the last tooth, mm."""
PAPILLA = 0.47
"""Height of a papilla over the neck's deepest point, share of the crown's height."""

# Across the fold: place from the margin towards the root and how far it stands off the crown, mm.
LABIAL = (
    (-0.9, -0.55), (-0.05, 0.02), (0.30, 0.38), (1.1, 0.46), (2.4, 0.30), (5.0, -0.7),
)  # fmt: skip
LINGUAL = ((9.0, 0.0), (5.0, 0.9), (2.0, 0.62), (0.5, 0.40), (-0.05, 0.02), (-0.9, -0.55))

# Linear RGB.
MARGIN = np.array([0.53, 0.235, 0.20])
ATTACHED = np.array([0.52, 0.25, 0.215])
MUCOSA = np.array([0.42, 0.125, 0.11])


def gum_parts() -> list[Part]:
    """Return the gums of both jaws."""
    parts = []
    for arch in (UPPER, LOWER):
        mesh, colors = _gum(arch)
        parts.append(
            Part(
                name=f"gum.{arch.jaw}",
                vertices=mesh[0],
                normals=vertex_normals(*mesh),
                triangles=mesh[1],
                colors=colors,
                material="wet",
                follows=arch.follows,
            )
        )
    return parts


def gum_depth(arch: Arch, along: FloatArray) -> FloatArray:
    """Return how thick crowns and gum are, from lips to tongue, along the arch [mm], (k,)."""
    centers = np.cumsum(arch.widths) - arch.widths / 2
    thickness = [tooth.neck_thickness for tooth in arch.teeth]
    return np.asarray(np.interp(np.abs(along), centers, thickness))


def neck_height(arch: Arch) -> float:
    """Return the mean height y of the necks of the teeth [mm]."""
    return arch.edge + arch.up * float(np.mean([t.height + t.raised for t in arch.teeth]))


def _gum(arch: Arch) -> tuple[Mesh, FloatArray]:
    along, place, number = _columns(arch)
    teeth = arch.teeth
    height = np.array([teeth[i].height for i in number])
    papilla = np.abs(place) ** 2.6
    # The zenith of the scallop lies a little behind the crown's middle.
    margin = height * (0.985 - PAPILLA * papilla)
    edge = edge_height(arch, along)
    thick = gum_depth(arch, along)
    torque = np.radians([teeth[i].torque for i in number])
    waist = (0.1 + 0.7 * (thick > 7)) * np.abs(place) ** 3

    centers = np.cumsum(arch.widths) - arch.widths / 2
    level = np.interp(np.abs(along), centers, [0.93 * tooth.height for tooth in teeth])

    rows = []
    shares = []
    for profile, side in ((LINGUAL, -1), (LABIAL, 1)):
        for rootward, off in profile:
            # Between the teeth the fold is thin and does not reach out to the faces.
            tall = margin + (level - margin) * smoothstep(1.0, 6.5, np.array(rootward)) + rootward
            swell = 1 - 0.3 * papilla * smoothstep(9.0, 2.0, np.array(rootward))
            face = off - waist * smoothstep(5.0, 0.5, np.array(rootward))
            bulge = 0.18 * (1 - papilla) * np.exp(-(((rootward - 4.0) / 2.5) ** 2))
            if side > 0:
                deep = face * swell + bulge * (swell > 0)
                deep = deep - (0.0 if arch.up > 0 else 0.5 * max(0.0, rootward - 1.0))
            else:
                behind = thick + (0.2 * rootward if rootward > 3 else 0.0)
                deep = -behind - face * swell - 0.8 * np.clip(rootward - 5.0, 0, None)
            deep = deep - (tall - 0.45 * height) * np.sin(torque)
            rows.append((tall, deep))
            shares.append(rootward)
    tall = np.stack([row[0] for row in rows], axis=1)
    deep = np.stack([row[1] for row in rows], axis=1)
    point, outward = dental_arch(arch, np.clip(along, -along_limit(arch), along_limit(arch)))
    over = along - np.clip(along, -along_limit(arch), along_limit(arch))
    vertices = np.stack(
        [
            point[:, :1] + deep * outward[:, :1],
            edge[:, None] + arch.up * tall,
            point[:, 1:] + deep * outward[:, 1:] - np.abs(over)[:, None],
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = grid_triangles(len(along), len(rows), closed=True)
    colors = _colors(np.array(shares), papilla, along)
    mesh = (vertices, outwards(vertices, triangles))
    return mesh, np.clip(colors.reshape(-1, 3) * mouth_shade(vertices), 0, 1)


def along_limit(arch: Arch) -> float:
    """Return how far the row of teeth reaches from the midline along the arch [mm]."""
    return float(arch.widths.sum())


def _columns(arch: Arch) -> tuple[FloatArray, FloatArray, list[int]]:
    """Return each column's distance along the arch [mm], place in its tooth (-1..1), and tooth."""
    along, place, number = [], [], []
    start = 0.0
    for index, width in enumerate(arch.widths):
        for step in range(PER_TOOTH):
            # Closer together at the papillae.
            local = np.sin(np.pi / 2 * (2 * step / PER_TOOTH - 1))
            along.append(start + width * (local + 1) / 2)
            place.append(local)
            number.append(index)
        start += width
    last = len(arch.widths) - 1
    along += [start, start + BEYOND]
    place += [1.0, 1.0]
    number += [last, last]
    mirrored = np.r_[-np.array(along[:0:-1]), along]
    return (
        mirrored,
        np.r_[np.array(place[:0:-1]), place],
        [*number[:0:-1], *number],
    )


def _colors(rootward: FloatArray, papilla: FloatArray, along: FloatArray) -> FloatArray:
    """Return colours (columns, rows, 3)."""
    to_mucosa = smoothstep(3.2, 6.0, rootward)[None, :, None]
    to_margin = smoothstep(0.9, 0.0, rootward)[None, :, None]
    color = ATTACHED + (MUCOSA - ATTACHED) * to_mucosa
    color = color + (MARGIN - color) * to_margin
    color = color * (1 - 0.10 * papilla[:, None, None] * np.array([0.4, 1.0, 1.0]))
    blotch = 0.5 * np.sin(0.9 * along) + 0.5 * np.sin(2.3 * along + 1.0)
    under = smoothstep(0.0, -0.6, rootward)[None, :, None]
    return np.asarray(color * (1 + 0.05 * blotch[:, None, None] * [0.3, 1, 1]) * (1 - 0.45 * under))
