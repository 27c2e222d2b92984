"""The eyebrows: some hundred hairs a side, upright by the nose and swept outwards."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..head import DrawnSurface, Part
from .strands import FrontView, Strands, strand_part

HAIRS = 560
POINTS = 3
WIDTH = 0.165

# The brow's middle line in the front view and its width, by share of the way outwards.
LINE_SHARES = (0.0, 0.3, 0.62, 0.8, 1.0)
LINE_X = (13.5, 26.0, 40.0, 46.8, 53.5)
LINE_Y = (17.0, 20.8, 23.2, 22.3, 18.3)
BROW_WIDTHS = ((0.0, 0.12, 0.4, 0.65, 1.0), (3.2, 4.9, 4.6, 3.3, 0.8))
DIRECTIONS = ((0.0, 0.12, 0.35, 0.7, 1.0), (78.0, 58.0, 32.0, 5.0, -22.0))
LENGTHS = ((0.0, 0.2, 0.7, 1.0), (5.0, 6.8, 7.0, 4.6))

COLOR = np.array([0.080, 0.049, 0.033])


def brow_line(share: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return x, y of the left brow's middle line and its width [mm] at shares 0..1 outwards."""
    x = np.interp(share, LINE_SHARES, LINE_X)
    y = np.interp(share, LINE_SHARES, LINE_Y)
    return x, y, np.interp(share, *BROW_WIDTHS)


def brows_part(skin: DrawnSurface) -> Part:
    """Return both brows, laid on the skin and riding it."""
    vertices = skin.vertices[skin.triangles].mean(axis=1)
    region = (vertices[:, 2] > 30) & (np.abs(vertices[:, 1] - 20) < 25)
    view = FrontView(skin, region)
    left = _left_brow(view, seed=7)
    # The right brow is laid on the mirrored skin with hairs of its own: nobody's brows are alike.
    right = _left_brow(view, seed=8).reflected()
    return strand_part("brows", left + right, skin, root_light=0.75)


def _left_brow(view: FrontView, seed: int) -> Strands:
    noise = np.random.default_rng(seed)
    share = noise.uniform(0, 1, HAIRS) ** 0.92
    across = np.clip(noise.normal(0, 0.5, HAIRS), -1, 1)
    x, y, width = brow_line(share)
    start = np.column_stack([x + noise.normal(0, 0.3, HAIRS), y + across * width * 0.55])
    # Upper hairs lean down towards the line, lower ones up.
    angle = np.interp(share, *DIRECTIONS) - 16 * across + noise.normal(0, 7, HAIRS)
    length = np.interp(share, *LENGTHS) * noise.uniform(0.6, 1.1, HAIRS)

    along = np.linspace(0, 1, POINTS)
    turning = np.radians(angle[:, None] - 12 * along)
    step = (length[:, None] * along)[..., None]
    flat = start[:, None, :] + step * np.stack([np.cos(turning), np.sin(turning)], axis=2)
    position, normal, hit = view.project(flat.reshape(-1, 2))
    complete = hit.reshape(HAIRS, POINTS).all(axis=1)
    lift = 0.05 + 0.85 * along * (1 - 0.4 * along)
    position = position.reshape(HAIRS, POINTS, 3)[complete]
    normal = normal.reshape(HAIRS, POINTS, 3)[complete]
    shade = noise.uniform(0.65, 1.5, HAIRS)[complete]
    return Strands(
        lines=position + normal * lift[None, :, None],
        normals=normal,
        width=WIDTH * noise.uniform(0.75, 1.2, HAIRS)[complete],
        colors=shade[:, None] * COLOR,
    )
