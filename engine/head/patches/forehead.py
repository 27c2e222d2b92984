"""The forehead: rows from the brow (0) over G1, G2, G3 to the hairline G4, eight columns."""

from __future__ import annotations

from .half import HalfCage

ROWS = 4
COLUMNS = 7


def add_forehead(half: HalfCage) -> None:
    """Add the faces from the brow to the hairline."""
    for row in range(ROWS):
        for column in range(COLUMNS):
            half.face(
                _region(row, column),
                _grid_point(row, column),
                _grid_point(row, column + 1),
                _grid_point(row + 1, column + 1),
                _grid_point(row + 1, column),
            )


def _grid_point(row: int, column: int) -> str:
    if row == 0:
        return f"b1_{column}" if column < 3 else f"E4_{column - 1}"
    return f"G{row}_{column}"


def _region(row: int, column: int) -> str:
    if row == 0:
        return "glabella" if column < 2 else "brow"
    return "forehead"
