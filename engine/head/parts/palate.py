"""The vault of the mouth: hard palate with rugae, soft palate; and the floor under the tongue."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..anatomy import smoothstep
from ..geometry import Mesh, grid_triangles, vertex_normals
from ..head import Part
from .gums import gum_depth, neck_height
from .teeth import LOWER, UPPER, Arch, dental_arch, mouth_shade

COLUMNS = 19
ROWS = 18
VAULT = 6.0
"""Height of the vault over the necks of the teeth, mm."""
BACK = 40.0
"""Depth at which the soft palate ends, mm."""
FLOOR_DROP = 7.0
"""How deep the floor lies under the necks of the lower teeth, mm."""

# Linear RGB.
HARD_PALATE = np.array([0.47, 0.21, 0.18])
SOFT_PALATE = np.array([0.42, 0.125, 0.105])
RUGAE = np.array([0.54, 0.27, 0.235])
FLOOR = np.array([0.40, 0.115, 0.10])


def palate_parts() -> list[Part]:
    """Return palate and floor of the mouth."""
    parts = []
    for name, follows, (mesh, colors) in (
        ("palate", "skull", _palate()),
        ("mouth_floor", "jaw", _floor()),
    ):
        parts.append(
            Part(
                name=name,
                vertices=mesh[0],
                normals=vertex_normals(*mesh),
                triangles=mesh[1],
                colors=np.clip(colors * mouth_shade(mesh[0]), 0, 1),
                material="wet",
                follows=follows,
            )
        )
    return parts


def _inner_arch(arch: Arch, sink: float) -> tuple[FloatArray, FloatArray]:
    """Return half width and depth of the arch's tongue side from the midline back, (k,) each."""
    along = np.linspace(0, float(arch.widths.sum()) + 2, 120)
    point, outward = dental_arch(arch, along)
    inner = point - outward * (gum_depth(arch, along) + sink)[:, None]
    return inner[:, 0], inner[:, 1]


def _span(arch: Arch, sink: float, back: float) -> tuple[FloatArray, FloatArray]:
    """Return x and z [mm], shape (rows, columns), of a sheet between the arch's two sides."""
    half, depth = _inner_arch(arch, sink)
    forward = np.minimum.accumulate(depth)
    front = forward[0] - 0.05
    share = np.linspace(0, 1, ROWS) ** 1.35
    z = front + (back - front) * share
    width = np.interp(-z, -forward, half)
    width = np.maximum(width, 0.4)
    across = np.sin(np.pi / 2 * np.linspace(-1, 1, COLUMNS))
    return width[:, None] * across[None, :], np.repeat(z[:, None], COLUMNS, axis=1)


def _palate() -> tuple[Mesh, FloatArray]:
    x, z = _span(UPPER, -0.3, BACK)
    across = x / np.abs(x).max(axis=1, keepdims=True)
    front = z.max()
    behind = front - z
    vault = VAULT * smoothstep(0.0, 24.0, behind) + 1.2
    dome = (1 - np.abs(across) ** 2.6) * vault
    y = neck_height(UPPER) + 0.5 + dome
    # Behind the bone the soft palate hangs, lowest at the uvula.
    hang = smoothstep(60.0, BACK, z)
    y = y - hang * (7.5 + 6.0 * np.exp(-((x / 3.5) ** 2)) * smoothstep(47, BACK, z))
    # Rugae: some curved ridges across the front third, and the seam in the middle.
    wave = np.sin(2 * np.pi * (behind + 2.2 * np.abs(across) ** 1.5) / 4.6)
    rugae = np.maximum(0, wave) * smoothstep(2, 5, behind) * smoothstep(19, 13, behind)
    rugae = rugae * smoothstep(0.04, 0.16, np.abs(across)) * smoothstep(0.95, 0.6, np.abs(across))
    seam = np.exp(-((x / 0.9) ** 2)) * smoothstep(1.0, 5.0, behind) * (1 - hang)
    papilla = np.exp(-((x / 1.6) ** 2) - ((behind - 3.0) / 2.6) ** 2)
    y = y - 0.75 * rugae - 0.35 * seam - 0.9 * papilla
    soft = smoothstep(64, 54, z)[..., None]
    colors = HARD_PALATE + (SOFT_PALATE - HARD_PALATE) * soft
    colors = colors + (RUGAE - colors) * (0.7 * np.maximum(rugae, papilla))[..., None]
    colors = colors * (1 - 0.25 * seam[..., None])
    mesh = _sheet(x, y, z, down=True)
    return mesh, colors.reshape(-1, 3)


def _floor() -> tuple[Mesh, FloatArray]:
    x, z = _span(LOWER, -0.4, 46.0)
    across = x / np.abs(x).max(axis=1, keepdims=True)
    behind = z.max() - z
    drop = FLOOR_DROP * smoothstep(0.0, 12.0, behind) + 1.0
    y = neck_height(LOWER) - 0.5 - drop * (1 - np.abs(across) ** 2.4)
    # Two folds beside the midline, and the string that holds the tongue.
    fold = np.exp(-(((np.abs(x) - 5.0) / 1.8) ** 2)) + 1.3 * np.exp(-((x / 0.8) ** 2))
    y = y + 1.3 * fold * smoothstep(3, 8, behind)
    colors = FLOOR * (1 + 0.25 * fold[..., None])
    return _sheet(x, y, z, down=False), colors.reshape(-1, 3)


def _sheet(x: FloatArray, y: FloatArray, z: FloatArray, *, down: bool) -> Mesh:
    """Return a grid of points as a mesh that faces down or up."""
    triangles = grid_triangles(*x.shape, closed=False)
    if not down:
        triangles = triangles[:, ::-1].copy()
    return np.stack([x, y, z], axis=2).reshape(-1, 3), triangles
