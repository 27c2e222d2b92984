"""The crown: a Coons patch between hairline, temples and back, swollen to a superellipsoid."""

from __future__ import annotations

import numpy as np

from .half import HalfCage
from .side import STEPS, row_point

COLUMNS = 7
ROWS = STEPS - COLUMNS

HALF_WIDTH = 76.0
FRONT_LENGTH = 94.0
BACK_LENGTH = 95.0
AXIS_DEPTH = -6.0
BASE_HEIGHT = 22.0
TOP_RISE = 94.0
EXPONENT = 2.35


def add_crown(half: HalfCage) -> None:
    """Place the crown's inner points (its midline is authored) and add the scalp faces."""
    for row in range(1, ROWS):
        for column in range(1, COLUMNS):
            _place(half, row, column)
    for row in range(ROWS):
        for column in range(COLUMNS):
            half.face(
                "scalp",
                _grid_point(row, column),
                _grid_point(row, column + 1),
                _grid_point(row + 1, column + 1),
                _grid_point(row + 1, column),
            )


def _grid_point(row: int, column: int) -> str:
    if row == 0:
        return f"G4_{column}"
    if row == ROWS:
        return row_point(0, STEPS - column)
    if column == COLUMNS:
        return row_point(0, row)
    return f"T{row}_{column}"


def _place(half: HalfCage, row: int, column: int) -> None:
    def at(grid_row: int, grid_column: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return half.points[_grid_point(grid_row, grid_column)]

    u, v = row / ROWS, column / COLUMNS
    ruled = (1 - u) * at(0, column) + u * at(ROWS, column)
    ruled += (1 - v) * at(row, 0) + v * at(row, COLUMNS)
    ruled -= (1 - u) * ((1 - v) * at(0, 0) + v * at(0, COLUMNS))
    ruled -= u * ((1 - v) * at(ROWS, 0) + v * at(ROWS, COLUMNS))
    inside = min(1.0, 3 * min(u, 1 - u, 1 - v))
    ruled[1] += (_height(ruled[0], ruled[2]) - ruled[1]) * inside
    half.place(f"T{row}_{column}", ruled)


def _height(x: float, z: float) -> float:
    length = FRONT_LENGTH if z > AXIS_DEPTH else BACK_LENGTH
    spread = (abs(x) / HALF_WIDTH) ** EXPONENT + (abs(z - AXIS_DEPTH) / length) ** EXPONENT
    return float(BASE_HEIGHT + TOP_RISE * max(1e-3, 1 - spread) ** (1 / EXPONENT))
