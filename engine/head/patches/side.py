"""Side and back of the head: sixteen rows W0 to W15 wrapped from the face to the back midline.

Row 15 runs along the jaw's lower border to its angle (W15_3); column 3 comes down before the ear
and along the back of the jaw's ramus to the same point. The ear sits in a hole of the grid.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import FloatArray
from .half import HalfCage

STEPS = 14
"""Points of each row beyond the one it starts from."""

STARTS = (
    "G4_7", "G3_7", "G2_7", "G1_7", "E4_6", "E4_7", "E4_8", "E4_9", "E4_10",
    "C8_1", "C8_2", "C8_3", "C8_4", "C8_5", "C8_6", "C8_7",
)  # fmt: skip
BACK_HEIGHTS = (74, 54, 36, 22, 9, -2, -12, -22, -32, -41, -50, -60, -71, -82, -93, -104)
"""Height at which each row meets the back midline, mm."""

EAR_ROWS = (5, 11)
EAR_STEPS = (3, 7)
"""First and last row and step of the grid at the ear's hole."""
LANES = ((78, 115), (76, 112), (74, 110), (73, 108), (72.5, 106))
"""Direction in which each row above the ear passes its columns, degrees from the front."""
LIFTS = (0.0, 2.5, 6.0, 9.2, 10.0)
"""How far each row above the ear rises over it, mm."""

# The skull's horizontal sections: superellipses about an axis, their half width and back by height.
AXIS_DEPTH = -8.0
EXPONENT = 2.25
FRONT_RADIUS = 70.0
SECTION_HEIGHTS = (
    -200, -150, -125, -96, -83, -71, -60, -50, -41, -32, -22, -12, -2, 9, 22, 36, 54, 74, 95, 110,
)  # fmt: skip
BACKS = (
    -62, -60, -60, -60.5, -62, -65, -69.5, -75, -81, -87, -92.5, -96.5, -99, -100.2, -100.5, -99,
    -93.5, -82, -58, -30,
)  # fmt: skip
HALF_WIDTHS = (
    66, 54, 51, 52, 54.5, 57.5, 60.5, 63, 65.2, 66.8, 68.2, 69.6, 71.4, 73, 73.8, 73.7, 71.2, 63,
    47, 47,
)  # fmt: skip


def add_side(half: HalfCage, anchors: Mapping[str, list[float]]) -> None:
    """Wrap the rows round the skull, with the authored `anchors` in place, and add the faces."""
    for row in range(len(STARTS)):
        for name, point in _row_points(half, row, anchors).items():
            half.place(name, point)
    for row in range(len(STARTS) - 1):
        for step in range(STEPS):
            if in_ear(row, step):
                continue
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


def in_ear(row: int, step: int) -> bool:
    """Return whether the grid's face after a row and step is left out for the ear."""
    return EAR_ROWS[0] <= row < EAR_ROWS[1] and EAR_STEPS[0] <= step < EAR_STEPS[1]


def ear_rim() -> list[str]:
    """Return the points round the ear's hole: along its top to the back, down, and to the front."""
    (top, bottom), (front, back) = EAR_ROWS, EAR_STEPS
    places = [(top, step) for step in range(front, back)]
    places += [(row, back) for row in range(top, bottom)]
    places += [(bottom, step) for step in range(back, front, -1)]
    places += [(row, front) for row in range(bottom, top, -1)]
    return [row_point(row, step) for row, step in places]


def _row_points(
    half: HalfCage, row: int, anchors: Mapping[str, list[float]]
) -> dict[str, FloatArray]:
    """Return the points of a row: authored before and under the ear, wrapped elsewhere."""
    start, height = half.points[STARTS[row]], BACK_HEIGHTS[row]
    if row < EAR_ROWS[0]:
        front, back = np.radians(LANES[row])
        turns = np.array([np.arctan2(start[0], start[2] - AXIS_DEPTH), front, back, np.pi])
        angles = np.interp(np.arange(1, STEPS + 1), [0, *EAR_STEPS, STEPS], turns)
        wrapped = _wrapped(start, height, angles)
        wrapped[:, 1] += LIFTS[row] * np.exp(-(((np.arange(1, STEPS + 1) - 4.7) / 3.2) ** 2))
        return _named(row, 1, wrapped)
    steps = [step for step in range(1, STEPS) if row_point(row, step) in anchors]
    points = {row_point(row, k): np.array(anchors[row_point(row, k)], float) for k in steps}
    last = points[row_point(row, steps[-1])]
    turn = np.linspace(np.arctan2(last[0], last[2] - AXIS_DEPTH), np.pi, STEPS - steps[-1] + 1)
    return points | _named(row, steps[-1] + 1, _wrapped(last, height, turn[1:]))


def _named(row: int, first: int, points: FloatArray) -> dict[str, FloatArray]:
    return {row_point(row, first + index): point for index, point in enumerate(points)}


def _wrapped(start: FloatArray, back_height: float, angle: FloatArray) -> FloatArray:
    """Return points at the angles from `start` to the back midline, shape (n, 3)."""
    first_angle = np.arctan2(start[0], start[2] - AXIS_DEPTH)
    share = (angle - first_angle) / (np.pi - first_angle)
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
    if step <= 2 and row >= 8:
        return "preauricular" if row < 12 else "mandible"
    return "scalp" if row < 12 or step > 7 else "neck"
