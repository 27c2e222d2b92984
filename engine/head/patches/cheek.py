"""Cheek, chin and jaw: columns 3 to 8 further out on the mouth's rings, rows 0 to 10."""

from __future__ import annotations

from .half import HalfCage

FIRST_COLUMN = 3
LAST_COLUMN = 8
ROWS = 10


def add_cheek(half: HalfCage) -> None:
    """Add the faces between the nose and mouth and the edge of the jaw."""
    for column in range(FIRST_COLUMN, LAST_COLUMN):
        for row in range(ROWS):
            half.face(
                _region(column, row),
                grid_point(column, row),
                grid_point(column + 1, row),
                grid_point(column + 1, row + 1),
                grid_point(column, row + 1),
            )


def grid_point(column: int, row: int) -> str:
    """Return the name of the point at a column and row of the cheek grid."""
    if column == FIRST_COLUMN:
        return {0: "E4_15", 1: "b5_3", 2: "b6_3"}.get(row, f"M4_{row}")
    return f"E4_{18 - column}" if row == 0 else f"C{column}_{row}"


def _region(column: int, row: int) -> str:
    if column <= 4 and row < 6:
        return "nasolabial"
    if column == 3:
        return "chin" if row >= 7 else "perioral_lower"
    if column == 4:
        return "chin"
    if row < 6:
        return "cheek"
    if column == 5:
        return "chin" if row >= 7 else "mandible"
    return "mandible" if row < 7 else "submental"
