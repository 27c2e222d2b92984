"""hair.png: clumps of strands side by side, from solid to wispy, which hair cards are cut from.

Neutral grey, so that one picture serves every colour of hair: the cards' vertex colours tint it.
Its rows run from the roots, at the top, to the tips.
"""

from __future__ import annotations

import io
from functools import cache
from typing import NamedTuple

import numpy as np
from PIL import Image

from ...arrays import FloatArray

WIDTH, HEIGHT = 768, 320
SEED = 5
LEVELS = 16
"""Shades of grey and of opacity; more would cost bytes that nobody sees."""
MARGIN = 3.0
"""Empty texels at each side of a lane, so that lanes do not bleed into each other."""


class Lane(NamedTuple):
    """One clump: how many strands, how wide [texels], and how they lie.

    Attributes:
        strands: Number of strands.
        width: Half the width of a strand at its root [texels].
        spread: Share of the lane that the roots take up.
        gather: How far the tips close in on each other, 0 to 1; negative fans them out.
        shortest: Length of the shortest strand, of the lane's.
        wave: Waviness of the strands [texels].
        stagger: Strands begin up to this far down the lane, so that no row of roots shows.
        pointed: Whether strands at the middle reach farthest, so that the clump has a point.
    """

    strands: int
    width: float
    spread: float
    gather: float
    shortest: float
    wave: float
    stagger: float = 0.16
    pointed: bool = True


LANES = (
    Lane(strands=46, width=1.20, spread=0.98, gather=0.30, shortest=0.40, wave=1.0),
    Lane(strands=40, width=1.15, spread=0.98, gather=0.45, shortest=0.35, wave=1.6),
    Lane(strands=34, width=1.10, spread=0.96, gather=0.35, shortest=0.30, wave=2.0),
    Lane(strands=28, width=1.05, spread=0.96, gather=0.25, shortest=0.28, wave=1.8),
    Lane(strands=21, width=1.00, spread=0.94, gather=0.30, shortest=0.28, wave=2.4),
    Lane(strands=15, width=0.95, spread=0.92, gather=0.10, shortest=0.28, wave=2.4),
    Lane(strands=10, width=0.90, spread=0.88, gather=-0.05, shortest=0.30, wave=3.0),
    Lane(strands=6, width=0.88, spread=0.80, gather=-0.10, shortest=0.35, wave=3.0),
    Lane(
        44, width=0.95, spread=1.0, gather=0.0, shortest=0.25, wave=3.0, stagger=0.6, pointed=False
    ),
    Lane(
        32, width=0.92, spread=1.0, gather=0.0, shortest=0.25, wave=3.5, stagger=0.6, pointed=False
    ),
    Lane(
        22, width=0.90, spread=1.0, gather=0.0, shortest=0.25, wave=4.0, stagger=0.6, pointed=False
    ),
    Lane(
        12, width=0.88, spread=1.0, gather=0.0, shortest=0.25, wave=4.0, stagger=0.6, pointed=False
    ),
)
"""Left to right, all as wide: clumps from solid to wispy, then short hairs that do not clump."""
CLUMPS, LOOSE = range(8), range(8, 12)
"""Which lanes are which."""


def lane_edges(lane: int) -> tuple[float, float]:
    """Return the left and right edge of a lane as shares of the picture's width."""
    return lane / len(LANES), (lane + 1) / len(LANES)


@cache
def hair_texture() -> bytes:
    """Return the picture as PNG: grey and opacity."""
    noise = np.random.default_rng(SEED)
    painted = [_lane(lane, noise) for lane in LANES]
    shade, cover = (np.hstack([part[kind] for part in painted]) for kind in (0, 1))
    pixels = np.stack([_quantized(shade), _quantized(cover)], axis=2)
    file = io.BytesIO()
    Image.fromarray(pixels, mode="LA").save(file, "PNG", optimize=True)
    return file.getvalue()


def _lane(lane: Lane, noise: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Return shade and opacity of one lane, each of shape (HEIGHT, lane width)."""
    wide = WIDTH // len(LANES)
    along = (np.arange(HEIGHT) + 0.5) / HEIGHT
    across = np.arange(wide) + 0.5
    shade = np.full((HEIGHT, wide), 0.72)
    cover = np.zeros((HEIGHT, wide))
    inner = (wide - 2 * MARGIN) * lane.spread
    spacing = (np.arange(lane.strands) + noise.uniform(0.1, 0.9, lane.strands)) / lane.strands - 0.5
    aside = 1.5 * np.abs(spacing) if lane.pointed else 0.3
    reach = 1 - (1 - lane.shortest) * np.clip(
        aside + noise.uniform(-0.25, 0.55, lane.strands), 0, 1
    )
    for strand in noise.permutation(lane.strands):
        centre = _path(lane, spacing[strand] * inner, along, noise) + wide / 2
        start = noise.uniform(0.0, lane.stagger)
        end = start + reach[strand] * (1 - start)
        share = np.clip((along - start) / (end - start), 0, 1)
        half = lane.width * noise.uniform(0.7, 1.2) * (1 - share**1.6) ** 0.8
        there = np.clip((along - start) / 0.05, 0, 1) * (share < 1)
        half = np.minimum(half, np.minimum(centre, wide - centre) - MARGIN / 2)
        gap = np.abs(across[None, :] - centre[:, None])
        opacity = np.clip(half[:, None] + 0.5 - gap, 0, 1) * there[:, None]
        round_ = 1 - 0.28 * np.clip(gap / np.maximum(half[:, None], 0.5), 0, 1) ** 2
        tone = noise.uniform(0.6, 1.0) * round_
        shade += (tone - shade) * opacity
        cover += (1 - cover) * opacity
    return shade, cover


def _path(lane: Lane, start: float, along: FloatArray, noise: np.random.Generator) -> FloatArray:
    """Return a strand's distance from the lane's middle by row [texels]."""
    phase, pace = noise.uniform(0, 2 * np.pi), noise.uniform(0.6, 1.7)
    wave = lane.wave * noise.uniform(0.3, 1.3) * np.sin(2 * np.pi * pace * along + phase) * along
    stray = noise.normal(0, 0.12) * start * along
    return np.asarray(start * (1 - lane.gather * along**1.4) + wave + stray)


def _quantized(values: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    steps = np.rint(np.clip(values, 0, 1) * (LEVELS - 1))
    return np.asarray(steps * (255 // (LEVELS - 1)), dtype=np.uint8)
