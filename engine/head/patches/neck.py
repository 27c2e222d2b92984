"""The neck: four rings below the edge of jaw and skull, down to a level cut."""

from __future__ import annotations

import numpy as np

from .half import HalfCage
from .side import STARTS, STEPS

# Height, width factor, front and back of each ring, mm.
RINGS = (
    (-116, 0.92, 40.0, -60),
    (-138, 0.96, 40.0, -60),
    (-160, 1.0, 42.0, -61),
    (-184, 1.14, 44.0, -64),
)
HALF_WIDTH = 51.0
EXPONENT = 2.1
CHIN_DROP = 18.0
"""How far the front of the first ring dips to pass under the chin, mm."""


def add_neck(half: HalfCage) -> None:
    """Place the neck's rings and add its faces."""
    edge = [f"C8_{row}" for row in (10, 9, 8, 7, 6)]
    edge += [f"W{len(STARTS) - 1}_{step}" for step in range(1, STEPS + 1)]
    above = edge
    for ring in range(len(RINGS)):
        below = [f"Q{ring}_{index}" for index in range(len(above))]
        _place_ring(half, ring, edge, below)
        for index in range(len(above) - 1):
            half.face("neck", above[index], above[index + 1], below[index + 1], below[index])
        above = below


def _place_ring(half: HalfCage, ring: int, edge: list[str], below: list[str]) -> None:
    height, widening, front, back = RINGS[ring]
    axis, length, width = (front + back) / 2, (front - back) / 2, HALF_WIDTH * widening
    share = np.arange(len(edge)) / (len(edge) - 1)
    points = np.array([half.points[name] for name in edge])
    # Each point keeps the angle of the edge above it: evenly spaced ones would shear the quads.
    # Only far below does the spacing even out.
    angle = np.arctan2(points[:, 0], points[:, 2] - axis)
    angle[0], angle[-1] = 0.0, np.pi
    evening = 0.35 * ring / (len(RINGS) - 1)
    angle = angle * (1 - evening) + share * np.pi * evening
    sine, cosine = np.sin(angle), np.cos(angle)
    inverse = (np.abs(sine) / width) ** EXPONENT + (np.abs(cosine) / length) ** EXPONENT
    radius = inverse ** (-1 / EXPONENT)
    drop = CHIN_DROP * np.maximum(0, cosine) ** 1.5 if ring == 0 else 0.0
    x = radius * sine
    x[[0, -1]] = 0.0
    ring_points = np.column_stack([x, height - drop * np.ones_like(x), axis + radius * cosine])
    for name, point in zip(below, ring_points, strict=True):
        half.place(name, point)
