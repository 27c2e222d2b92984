"""From the numbers of a row to intensities and angles: every signal that a track has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..channels import LIMITS
from .angles import angles_of, gaze_angles, seen_from
from .layout import Layout, Turn
from .table import Chunk

HEAD = (("head", "yaw"), ("head", "pitch"), ("head", "roll"))
GAZE = (("gaze", "yaw"), ("gaze", "pitch"))
ANGLE_SCALE = 30.0
"""Degrees that count as one unit where signals are filtered: a wide turn of head or eyes. Ours."""


class Signals:
    """Reads the signals of rows.

    Attributes:
        units: "AU12", "L12" or "T28", in the order of the header's columns.
        columns: The columns that each unit comes from.
        axes: What turns.
    """

    def __init__(self, layout: Layout, full: float, sample: Chunk, rows: BoolArray) -> None:
        """Settle what the header leaves open by the first rows, those of them that count."""
        self._names = layout.number_columns
        self._full = full
        self.units = tuple(dict.fromkeys(unit.key for unit in layout.units))
        self.columns = {
            key: tuple(unit.column for unit in layout.units if unit.key == key)
            for key in self.units
        }
        columns = layout.unit_columns
        self._places = [self._names.index(name) for name in columns]
        self._shares = np.zeros((len(columns), len(self.units)))
        for unit in layout.units:
            self._shares[columns.index(unit.column), self.units.index(unit.key)] += unit.share
        counted = sample.numbers[rows]
        self._head = self._settled(layout.head, counted)
        self._gaze = self._settled(layout.gaze, counted)
        shaped = () if self._gaze else tuple(dict.fromkeys(axis.axis for axis in layout.axes))
        self._degrees = np.zeros((len(columns), len(shaped)))
        for axis in layout.axes if shaped else ():
            self._degrees[columns.index(axis.column), shaped.index(axis.axis)] += axis.degrees
        self.axes: tuple[tuple[str, str], ...] = (
            *(HEAD if self._head else ()),
            *(GAZE if self._gaze else ()),
            *((name.split(".")[0], name.split(".")[1]) for name in shaped),
        )
        self._last = np.zeros(len(self.axes))

    @property
    def resting(self) -> BoolArray:
        """Which signals go to 0 where a face is lost: the units, not the angles; (signals,)."""
        return np.arange(len(self.units) + len(self.axes)) < len(self.units)

    @property
    def scales(self) -> FloatArray:
        """What of each signal counts as one unit, shape (signals,)."""
        return np.where(self.resting, 1.0, ANGLE_SCALE)

    def of(self, numbers: FloatArray) -> FloatArray:
        """Return the signals of rows that count, shape (n, signals).

        Args:
            numbers: The rows' numbers, shape (n, columns).
        """
        shares = np.clip(numbers[:, self._places] / self._full, 0.0, 1.0)
        units = np.minimum(shares @ self._shares, 1.0)
        parts = [units, self._angles(numbers, shares)]
        return np.concatenate(parts, axis=1)

    def _angles(self, numbers: FloatArray, shares: FloatArray) -> FloatArray:
        parts: list[FloatArray] = []
        turns = None
        if self._head is not None:
            values, bad = self._values(self._head, numbers)
            turns = self._head.read(values)
            parts.append(np.where(bad[:, None], np.nan, angles_of(turns)))
        if self._gaze is not None:
            values, bad = self._values(self._gaze, numbers)
            sights = self._gaze.read(values)
            if self._gaze.in_space and turns is not None:
                sights = seen_from(turns, sights)
            parts.append(np.where(bad[:, None], np.nan, gaze_angles(sights)))
        parts.append(shares @ self._degrees)
        angles = np.concatenate(parts, axis=1)
        for place, axis in enumerate(self.axes):
            angles[:, place] = np.clip(angles[:, place], *LIMITS[axis])
        return self._filled(angles)

    def _filled(self, angles: FloatArray) -> FloatArray:
        """Return angles with the last known one where a row has none: eyes that are shut."""
        if np.isnan(angles).any():
            for row in angles:
                row[:] = np.where(np.isnan(row), self._last, row)
                self._last = row
        if len(angles):
            self._last = angles[-1].copy()
        return angles

    def _values(self, turn: Turn, numbers: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return a turn's values, 0 in rows where any is missing, and which rows these are."""
        values = numbers[:, self._columns(turn.columns)]
        bad = np.asarray(~(np.abs(values) < 1e6).all(axis=1))
        return np.where(bad[:, None], 0.0, values), bad

    def _settled(self, turn: Turn | None, counted: FloatArray) -> Turn | None:
        if turn is None:
            return None
        values = counted[:, self._columns(turn.columns)]
        if len(values) == 0 or np.isnan(values).any(axis=1).all():
            return None
        return turn.settled(values)

    def _columns(self, names: Sequence[str]) -> list[int]:
        return [self._names.index(name) for name in names]
