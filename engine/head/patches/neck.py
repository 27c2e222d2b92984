"""The neck: rings below the edge of jaw and skull, leaning back down to a level cut.

Its sections are superellipses; on them stand the sternomastoid from behind the ear to the notch of
the breastbone, the larynx, and the hollows under the jaw and behind the sternomastoid.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from .half import HalfCage
from .side import STARTS, STEPS

RINGS = 7
TOP_DROP = 9.0
"""How far the first ring lies under the jaw's border, mm."""
CUT = -184.0

# The sections by height, mm: half width, front and back on the midline.
HEIGHTS = (-184, -170, -155, -140, -125, -110, -95, -80)
HALF_WIDTHS = (69, 60.5, 56, 53.5, 52.0, 52.0, 52.5, 53)
FRONTS = (27, 30.5, 34.5, 37.5, 41, 43, 44, 44)
BACKS = (-96, -87, -79, -73, -69, -66, -63.5, -63)
EXPONENT = 2.15

# The sternomastoid's direction from the axis by height, degrees from the front.
MUSCLE_HEIGHTS = (-184, -165, -140, -110, -80)
MUSCLE_ANGLES = (15, 33, 56, 77, 92)


def add_neck(half: HalfCage) -> None:
    """Place the neck's rings and add its faces."""
    edge = [f"C8_{row}" for row in (10, 9, 8, 7)]
    edge += [f"W{len(STARTS) - 1}_{step}" for step in range(1, STEPS + 1)]
    above = edge
    for ring in range(RINGS):
        below = [f"Q{ring}_{index}" for index in range(len(above))]
        _place_ring(half, ring, edge, below)
        for index in range(len(above) - 1):
            half.face("neck", above[index], above[index + 1], below[index + 1], below[index])
        above = below


def _place_ring(half: HalfCage, ring: int, edge: list[str], below: list[str]) -> None:
    points = np.array([half.points[name] for name in edge])
    share = ring / (RINGS - 1)
    top = points[:, 1] - TOP_DROP
    height = top + (CUT - top) * share
    axis = (np.interp(height, HEIGHTS, FRONTS) + np.interp(height, HEIGHTS, BACKS)) / 2
    # Each point keeps the angle of the edge above it: evenly spaced ones would shear the quads.
    # Only far below does the spacing even out.
    angle = np.arctan2(points[:, 0], points[:, 2] - axis)
    angle[0], angle[-1] = 0.0, np.pi
    evening = 0.5 * share
    angle = angle * (1 - evening) + np.linspace(0, np.pi, len(edge)) * evening
    radius = _section_radius(angle, height) + _relief(np.degrees(angle), height, points[:, 1])
    x = radius * np.sin(angle)
    x[[0, -1]] = 0.0
    ring_points = np.column_stack([x, height, axis + radius * np.cos(angle)])
    for name, point in zip(below, ring_points, strict=True):
        half.place(name, point)


def _section_radius(angle: FloatArray, height: FloatArray) -> FloatArray:
    width = np.interp(height, HEIGHTS, HALF_WIDTHS)
    length = (np.interp(height, HEIGHTS, FRONTS) - np.interp(height, HEIGHTS, BACKS)) / 2
    sides = (np.abs(np.sin(angle)) / width) ** EXPONENT
    ends = (np.abs(np.cos(angle)) / length) ** EXPONENT
    return np.asarray((sides + ends) ** (-1 / EXPONENT))


def _relief(angle: FloatArray, height: FloatArray, jaw: FloatArray) -> FloatArray:
    """Return what stands out of the section [mm] at angles [degrees] and heights, under `jaw`."""

    def ridge(place: FloatArray | float, width: float) -> FloatArray:
        return np.asarray(np.exp(-(((angle - place) / width) ** 2)))

    muscle = np.interp(height, MUSCLE_HEIGHTS, MUSCLE_ANGLES)
    low = np.clip((-115 - height) / 50, 0, 1)
    relief = 3.4 * ridge(muscle, 13) - 1.6 * ridge(muscle - 25, 12)
    relief -= 2.5 * low * ridge(muscle + 30, 16)
    larynx = np.exp(-(((height + 149) / 9.5) ** 2))
    relief += 5.0 * larynx * ridge(0, 12)
    under = jaw - height
    hollow = np.clip(under / 9, 0, 1) * np.exp(-((np.maximum(under - 12, 0) / 22) ** 2))
    return np.asarray(relief - 7.0 * hollow * ridge(57, 19))
