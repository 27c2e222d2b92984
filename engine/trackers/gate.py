"""Which rows count: a face was found, with enough confidence, and every number is one."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..errors import InvalidTrack
from .layout import Layout
from .table import Chunk

NO_SUCCESS = "the tracker found no face (success is 0)"
LOW_CONFIDENCE = "the confidence is below {:g}"
NO_NUMBERS = "there are no numbers: a frame without a face"
LEAST, MOST = -0.05, 2.0
"""Shares of full scale: what lies between them is noise, held to 0..1; beyond, the column is no
intensity. Ours."""


class Gate:
    """Passes the rows that count, and counts the others by reason."""

    def __init__(self, layout: Layout, full: float, min_confidence: float) -> None:
        names = layout.number_columns
        self._units = [names.index(name) for name in layout.unit_columns]
        self._names = layout.unit_columns
        self._success = None if layout.success is None else names.index(layout.success)
        self._confidence = None if layout.confidence is None else names.index(layout.confidence)
        self._least = min_confidence
        self._low = LOW_CONFIDENCE.format(min_confidence)
        self.full = full
        self.dropped: dict[str, int] = {}
        self.held = 0

    def passed(self, chunk: Chunk, rows: BoolArray) -> BoolArray:
        """Return which of some rows count, shape (rows,); the others of them are counted.

        Args:
            chunk: Rows of a file.
            rows: Which of them are of the face, shape (rows,).

        Raises:
            InvalidTrack: For a row that counts and has a number missing, infinite or out of range.
        """
        good = self.good(chunk) & rows
        for reason, bad in self._reasons(chunk):
            count = int((bad & rows).sum())
            if count:
                self.dropped[reason] = self.dropped.get(reason, 0) + count
        self._check(chunk, good)
        return good

    def good(self, chunk: Chunk) -> BoolArray:
        """Return which rows have a face found with enough confidence, shape (rows,)."""
        good = np.ones(len(chunk), dtype=bool)
        for _, bad in self._reasons(chunk):
            good &= ~bad
        return good

    def _reasons(self, chunk: Chunk) -> list[tuple[str, BoolArray]]:
        """Return why rows do not count, and which; each row is in one of them at most."""
        found: list[tuple[str, BoolArray]] = []
        left = np.ones(len(chunk), dtype=bool)
        numbers = chunk.numbers
        if self._success is not None:
            found.append((NO_SUCCESS, ~(numbers[:, self._success] > 0.0)))
        if self._confidence is not None:
            found.append((self._low, ~(numbers[:, self._confidence] >= self._least)))
        found.append((NO_NUMBERS, np.asarray(np.isnan(numbers[:, self._units]).all(axis=1))))
        reasons = []
        for reason, bad in found:
            reasons.append((reason, bad & left))
            left &= ~bad
        return reasons

    def _check(self, chunk: Chunk, good: BoolArray) -> None:
        values = chunk.numbers[:, self._units]
        shares = values / self.full
        fair = (shares >= LEAST) & (shares <= MOST)
        wrong = ~fair & good[:, None]
        if wrong.any():
            row, place = np.argwhere(wrong)[0]
            raise InvalidTrack(
                self._complaint(chunk.first + int(row), self._names[place], values[row, place])
            )
        outside = ((shares < 0.0) | (shares > 1.0)) & good[:, None]
        self.held += int(outside.sum())

    def _complaint(self, row: int, name: str, value: float) -> str:
        if np.isnan(value):
            return (
                f"row {row}: {name} is missing or NaN while others are there; expected a number: "
                "fill it, or leave all of a row without a face empty"
            )
        hint = "an intensity is not negative: give the tracker's own file, not one with means off"
        if value > 0.0:
            hint = "say what the file calls full with full_scale, or give the tracker's own file"
        return f"row {row}: {name} is {value:g}; expected a number from 0 to {self.full:g}: {hint}"


def mean_confidence(layout: Layout, numbers: FloatArray) -> float:
    """Return the mean confidence of rows, shape (n, columns); 1 where none is told."""
    if layout.confidence is None or len(numbers) == 0:
        return 1.0
    place = layout.number_columns.index(layout.confidence)
    return float(np.nan_to_num(numbers[:, place]).mean())
