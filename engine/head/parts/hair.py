"""Cropped hair: short hairs all over the scalp, combed away from the whorl.

They only break up the outline and catch light: most of the hair is paint on the scalp. Each is one
triangle, since those that ride moving skin weigh on every file that carries the skin's motion.
"""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ..anatomy import smoothstep
from ..geometry import triangle_areas
from ..head import DrawnSurface, Part
from .strands import Strands, strand_part

DENSITY = 0.155
"""Hairs per square millimetre where hair is full."""
MOVING_DENSITY = 0.6
"""Share of that density on skin that moves."""
POINTS = 2
WIDTH = 0.36
WHORL = np.array([4.0, 108.0, -42.0])
"""Where the hair parts in all directions, mm."""
SKULL_RADIUS = 88.0
"""Hairs bend round a ball of this radius, mm."""
MOVING_WEIGHT = 0.6
"""Skin that takes less than this of the tissue's displacement counts as still."""

COLOR = np.array([0.038, 0.026, 0.018])
LENGTH_TOP, LENGTH_SIDE = 9.5, 4.5
RISE_TOP, RISE_SIDE = 3.2, 0.9
"""How far the tips stand off the scalp, mm."""


def hair_parts(skin: DrawnSurface) -> list[Part]:
    """Return the hairs: "hairline" rides the skin that moves, "hair" sits on the still scalp."""
    noise = np.random.default_rng(31)
    moving = abs(skin.map).sum(axis=1)[skin.triangles].max(axis=1) > MOVING_WEIGHT
    triangle, weights = _scattered(skin, moving, noise)
    strands = _combed(skin, skin.triangles[triangle], weights, noise)
    moves = moving[triangle]
    return [
        strand_part(name, _chosen(strands, mask), ridden, root_light=0.55)
        for name, mask, ridden in (("hair", ~moves, None), ("hairline", moves, skin))
        if mask.any()
    ]


def _scattered(
    skin: DrawnSurface, moving: BoolArray, noise: np.random.Generator
) -> tuple[IntArray, FloatArray]:
    """Return the triangle and the barycentric weights (n, 3) of each hair's root."""
    mask = skin.hair[skin.triangles].mean(axis=1)
    area = triangle_areas(skin.vertices, skin.triangles)
    center = skin.vertices[skin.triangles].mean(axis=1)
    # Sideburns are paint alone: seen from the front, hairs there would stand before the ear.
    sideburn = smoothstep(-14, 2, center[:, 2]) * smoothstep(22, 4, center[:, 1])
    expected = area * DENSITY * smoothstep(0.2, 0.95, mask) * (1 - sideburn)
    expected = expected * np.where(moving, MOVING_DENSITY, 1.0)
    triangle = np.repeat(np.arange(len(expected)), noise.poisson(expected))
    first, second = np.sqrt(noise.uniform(size=len(triangle))), noise.uniform(size=len(triangle))
    return triangle, np.column_stack([1 - first, first * (1 - second), first * second])


def _combed(
    skin: DrawnSurface, corners: IntArray, weights: FloatArray, noise: np.random.Generator
) -> Strands:
    count = len(corners)
    root = np.einsum("nc,ncx->nx", weights, skin.vertices[corners])
    normal = np.einsum("nc,ncx->nx", weights, skin.normals[corners])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    fullness = np.einsum("nc,nc->n", weights, skin.hair[corners])

    away = root - WHORL + [0, -8.0, 10.0]  # combed a little forward and down
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    away += noise.normal(0, 0.22, (count, 3))
    tangent = away - normal * (away * normal).sum(axis=1, keepdims=True)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-9)

    top = smoothstep(25, 80, root[:, 1])
    thin = 0.3 + 0.7 * smoothstep(0.3, 1.0, fullness)
    length = (LENGTH_SIDE + (LENGTH_TOP - LENGTH_SIDE) * top) * noise.uniform(0.7, 1.15, count)
    rise = (RISE_SIDE + (RISE_TOP - RISE_SIDE) * top) * noise.uniform(0.5, 1.25, count)
    along = np.linspace(0, 1, POINTS)
    distance = (length * thin)[:, None] * along
    height = (rise * thin)[:, None] * along * (1.7 - 0.7 * along)
    height = height - distance**2 / (2 * SKULL_RADIUS) + 0.05
    lines = root[:, None] + distance[..., None] * tangent[:, None]
    lines = lines + height[..., None] * normal[:, None]
    bent = normal[:, None] + 0.45 * along[None, :, None] * tangent[:, None]
    shade = noise.uniform(0.7, 1.35, count) * (0.9 + 0.2 * top)
    return Strands(
        lines=lines,
        normals=bent,
        width=WIDTH * (0.3 + 0.7 * thin) * (1 + 0.5 * top * thin) * noise.uniform(0.7, 1.2, count),
        colors=shade[:, None] * COLOR,
    )


def _chosen(strands: Strands, mask: BoolArray) -> Strands:
    return Strands(
        strands.lines[mask], strands.normals[mask], strands.width[mask], strands.colors[mask]
    )
