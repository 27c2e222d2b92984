"""Cells of a table as numbers, with decimal points or commas; what is missing is NaN."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..errors import InvalidTrack

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_MISSING = {"", "na", "n/a", "null", "none", "-nan(ind)", "-nan", "nan(ind)", "#n/a"}
_SHOWN = 40


def to_numbers(rows: Sequence[Sequence[str]], names: Sequence[str], first: int) -> FloatArray:
    """Return cells as numbers, shape (rows, columns); NaN where a cell is empty.

    "0,5" is a half: a comma within a cell cannot be what separates the cells.

    Args:
        rows: The cells of the columns that are wanted.
        names: Of these columns, for what is said of a cell.
        first: Number of the first row, from 1.

    Raises:
        InvalidTrack: For a cell that is no number, with its row and column.
    """
    try:
        flat = [float(cell) for row in rows for cell in row]
    except ValueError:
        flat = [
            _number(cell, name, first + index)
            for index, row in enumerate(rows)
            for cell, name in zip(row, names, strict=True)
        ]
    return np.array(flat, dtype=np.float64).reshape(len(rows), len(names))


def _number(cell: str, name: str, row: int) -> float:
    text = cell.strip()
    try:
        return float(text)
    except ValueError:
        pass
    if text.lower() in _MISSING:
        return float("nan")
    if _DECIMAL_COMMA.fullmatch(text):
        return float(text.replace(",", "."))
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
    raise InvalidTrack(f"row {row}: {name} is {shown!r}; expected a number such as 0.37")
