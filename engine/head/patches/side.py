"""Side and back of the head: fifteen rows W0 to W14 wrapped from the face to the back midline."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import FloatArray
from .half import HalfCage

STEPS = 13
"""Points of each row beyond the one it starts from."""

STARTS = (
    "G4_7", "G3_7", "G2_7", "G1_7", "E4_6", "E4_7", "E4_8", "E4_9", "E4_10",
    "C8_1", "C8_2", "C8_3", "C8_4", "C8_5", "C8_6",
)  # fmt: skip
BACK_HEIGHTS = (74, 54, 36, 22, 9, -2, -12, -22, -32, -41, -50, -60, -71, -83, -96)
"""Height at which each row meets the back midline, mm."""

# The skull's horizontal sections: superellipses about an axis, their half width and back by height.
AXIS_DEPTH = -8.0
EXPONENT = 2.25
FRONT_RADIUS = 70.0
SECTION_HEIGHTS = (
    -200, -150, -125, -96, -83, -71, -60, -50, -41, -32, -22, -12, -2, 9, 22, 36, 54, 74, 95, 110,
)  # fmt: skip
BACKS = (
    -62, -60, -60, -61.5, -64, -68, -73, -79, -84.5, -89.5, -93.5, -96.5, -98.5, -99.5, -99.5, -98,
    -92.5, -81, -58, -30,
)  # fmt: skip
HALF_WIDTHS = (
    66, 54, 51, 52, 54.5, 57.5, 60.5, 63, 65.2, 66.8, 68.2, 69.6, 71.4, 73, 73.8, 73.7, 71.2, 63,
    47, 47,
)  # fmt: skip


def add_side(half: HalfCage, jaw_anchors: Mapping[str, list[float]]) -> None:
    """Wrap the rows round the skull, put the authored `jaw_anchors` in, and add the faces."""
    for row, (start, height) in enumerate(zip(STARTS, BACK_HEIGHTS, strict=True)):
        for step, point in enumerate(_wrapped_row(half.points[start], height), start=1):
            half.place(f"W{row}_{step}", point)
    for name, position in jaw_anchors.items():
        half.place(name, position)
    for row in range(len(STARTS) - 1):
        for step in range(STEPS):
            half.face(
                _region(row, step),
                row_point(row, step),
                row_point(row, step + 1),
                row_point(row + 1, step + 1),
                row_point(row + 1, step),
            )


def row_point(row: int, step: int) -> str:
    """Return the name of the point `step` steps along a row; step 0 belongs to the face."""
    return STARTS[row] if step == 0 else f"W{row}_{step}"


def _wrapped_row(start: FloatArray, back_height: float) -> FloatArray:
    """Return the points of a row from `start` to the back midline, shape (STEPS, 3)."""
    share = np.arange(1, STEPS + 1) / STEPS
    first_angle = np.arctan2(start[0], start[2] - AXIS_DEPTH)
    angle = first_angle + (np.pi - first_angle) * share
    height = start[1] + (back_height - start[1]) * share**2 * (3 - 2 * share)
    front = max(FRONT_RADIUS, start[2] - AXIS_DEPTH + 10)
    distance = np.hypot(start[0], start[2] - AXIS_DEPTH)
    # A row starts where the face ends, not on the section; the difference fades out behind it.
    mismatch = distance / _section_radius(first_angle, start[1], front) - 1
    radius = _section_radius(angle, height, front)
    radius *= 1 + mismatch * np.maximum(0, 1 - share * 2.2) ** 2
    x = radius * np.sin(angle)
    x[-1] = 0.0
    return np.column_stack([x, height, AXIS_DEPTH + radius * np.cos(angle)])


def _section_radius(angle: FloatArray, height: FloatArray, front: float) -> FloatArray:
    width = np.interp(height, SECTION_HEIGHTS, HALF_WIDTHS)
    back = AXIS_DEPTH - np.interp(height, SECTION_HEIGHTS, BACKS)
    length = np.where(np.cos(angle) < 0, back, front)
    sides = (np.abs(np.sin(angle)) / width) ** EXPONENT
    ends = (np.abs(np.cos(angle)) / length) ** EXPONENT
    return np.asarray((sides + ends) ** (-1 / EXPONENT))


def _region(row: int, step: int) -> str:
    if step == 0 and 3 <= row <= 7:
        return "temple"
    if step <= 1:
        return "temple" if row < 8 else "cheek" if row < 12 else "mandible"
    if step <= 3 and row >= 8:
        return "preauricular" if row < 12 else "mandible"
    return "scalp" if row < 12 or step > 6 else "neck"
