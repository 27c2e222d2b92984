"""Smooth displacement fields in the space of the built-in head, from which every face is made.

A field is a sum of terms. Each term is even about the midline: a face that is symmetric stays so,
to the last bit, and no term has an edge.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...compiling import kept

Vector = tuple[float, float, float]
Anchors = Mapping[str, FloatArray]
"""Where named points of the left half and the midline lie on the built-in head, mm."""

NEVER = 1.0e9
"""A reach that never ends, mm."""
ROW = 20
"""Numbers that a term is told to the kernel in."""
_BUMP, _RAMP, _LIP = 0.0, 1.0, 2.0
_FAINT = 60.0
"""Squared reaches beyond which a bell counts as nothing: below 1e-13."""


@dataclass(frozen=True)
class Bump:
    """A push, and a stretch about its middle, that fade as a bell.

    Attributes:
        anchor: Point at its middle.
        reach: Standard deviations of the bell along x, y, z, mm.
        push: Displacement at the middle, mm.
        stretch: Displacement a millimetre from the middle, along x, y, z.
        offset: Of the middle from the anchor, mm.
        shear: Displacement along the second axis a millimetre from the middle along the first,
            as ("x", "y", amount) rows.
    """

    anchor: str
    reach: Vector
    push: Vector = (0.0, 0.0, 0.0)
    stretch: Vector = (0.0, 0.0, 0.0)
    offset: Vector = (0.0, 0.0, 0.0)
    shear: tuple[tuple[str, str, float], ...] = ()

    def row(self, amount: float, anchors: Anchors) -> FloatArray:
        """Return kind, middle, 1 / reach, push, matrix of stretch and shear, shape (ROW,)."""
        middle = anchors[self.anchor] + np.array(self.offset)
        matrix = np.diag(self.stretch)
        for along, to, amount_of in self.shear:
            matrix["xyz".index(to), "xyz".index(along)] += amount_of
        numbers = [[_BUMP], middle, 1.0 / np.array(self.reach), amount * np.array(self.push)]
        return _row([*numbers, amount * matrix.ravel(), [float(abs(middle[0]) < 1e-6)]])


@dataclass(frozen=True)
class Ramp:
    """A push that rises from nothing to its full size between two points and stays there.

    Attributes:
        start, end: Points between which it rises.
        axis: "x", "y" or "z": the axis along which they are apart.
        push: Full displacement, mm.
        ease: Length over which rise begins and ends, mm.
        anchor: Middle of the window it is seen through.
        reach: Standard deviations of that window along x, y, z, mm; `NEVER` for none.
        offset: Of the window's middle from its anchor, mm.
        plateau: Half size within which the window is fully open, mm.
    """

    start: str
    end: str
    axis: str
    push: Vector
    ease: float = 5.0
    anchor: str = "n"
    reach: Vector = (NEVER, NEVER, NEVER)
    offset: Vector = (0.0, 0.0, 0.0)
    plateau: Vector = (0.0, 0.0, 0.0)

    def row(self, amount: float, anchors: Anchors) -> FloatArray:
        """Return kind, axis, start, span, ease, push and the window, shape (ROW,)."""
        axis = "xyz".index(self.axis)
        low, high = anchors[self.start][axis], anchors[self.end][axis]
        middle = anchors[self.anchor] + np.array(self.offset)
        numbers = [[_RAMP, axis, low, high - low, self.ease], amount * np.array(self.push), middle]
        return _row([*numbers, self.plateau, 1.0 / np.array(self.reach)])


@dataclass(frozen=True)
class Lip:
    """The red of one lip drawn away from the line where the lips meet, which stays.

    Attributes:
        side: 1 for the upper lip, -1 for the lower.
        border: Point in the middle of the lip's border, where most is moved.
        push: Displacement there, mm, y away from the other lip.
        seam, corner: Points in the middle and at the end of the line of contact.
    """

    side: float
    border: str
    push: Vector
    seam: str = "M0_0"
    corner: str = "M1_5"

    def row(self, amount: float, anchors: Anchors) -> FloatArray:
        """Return kind, side, height of the lip, push, seam and end of the line, shape (ROW,)."""
        seam, corner = anchors[self.seam], anchors[self.corner]
        size = abs(anchors[self.border][1] - seam[1])
        x, y, z = self.push
        push = amount * np.array([x, self.side * y, z])
        return _row([[_LIP, self.side, size], push, seam, [corner[0]]])


Term = Bump | Ramp | Lip


def rows_of(terms: Iterable[tuple[float, Sequence[Term]]], anchors: Anchors) -> FloatArray:
    """Return what the kernel needs of so much of each field, shape (k, ROW)."""
    rows = [term.row(amount, anchors) for amount, field in terms for term in field]
    return np.array(rows).reshape(-1, ROW)


def field_of(rows: FloatArray, points: FloatArray) -> FloatArray:
    """Return the displacement at points (k, 3) that `rows` amount to, mm."""
    total = np.zeros(points.shape)
    if not len(rows):  # The built-in head itself needs nothing compiled.
        return total
    _field(rows, np.ascontiguousarray(points), total)
    return total


def field_at(terms: Sequence[Term], points: FloatArray, anchors: Anchors) -> FloatArray:
    """Return the sum of `terms` at points (k, 3), mm."""
    return field_of(rows_of([(1.0, terms)], anchors), points)


def _row(numbers: Sequence[Sequence[float] | FloatArray]) -> FloatArray:
    flat = np.concatenate([np.asarray(part, float) for part in numbers])
    return np.concatenate([flat, np.zeros(ROW - len(flat))])


@kept(nogil=True)
def _field(rows: FloatArray, points: FloatArray, total: FloatArray) -> None:
    """Sum the terms at every point of the left half and mirror them for the right one."""
    for i in range(points.shape[0]):
        side = -1.0 if points[i, 0] < 0.0 else 1.0
        x, y, z = side * points[i, 0], points[i, 1], points[i, 2]
        total[i, 0] = total[i, 1] = total[i, 2] = 0.0
        for k in range(rows.shape[0]):
            if rows[k, 0] == _BUMP:
                _add_bump(rows, k, x, y, z, 1.0, total, i)
                if rows[k, 19] == 0.0:
                    _add_bump(rows, k, -x, y, z, -1.0, total, i)
            elif rows[k, 0] == _RAMP:
                _add_ramp(rows, k, x, y, z, total, i)
            else:
                _add_lip(rows, k, x, y, z, total, i)
        total[i, 0] = side * total[i, 0] if x != 0.0 else 0.0


@kept(nogil=True)
def _add_bump(
    rows: FloatArray, k: int, x: float, y: float, z: float, side: float, to: FloatArray, i: int
) -> None:
    a, b, c = x - rows[k, 1], y - rows[k, 2], z - rows[k, 3]
    square = (a * rows[k, 4]) ** 2 + (b * rows[k, 5]) ** 2 + (c * rows[k, 6]) ** 2
    if square < _FAINT:
        weight = math.exp(-0.5 * square)
        to[i, 0] += (
            side * weight * (rows[k, 7] + rows[k, 10] * a + rows[k, 11] * b + rows[k, 12] * c)
        )
        to[i, 1] += weight * (rows[k, 8] + rows[k, 13] * a + rows[k, 14] * b + rows[k, 15] * c)
        to[i, 2] += weight * (rows[k, 9] + rows[k, 16] * a + rows[k, 17] * b + rows[k, 18] * c)


@kept(nogil=True)
def _add_ramp(
    rows: FloatArray, k: int, x: float, y: float, z: float, to: FloatArray, i: int
) -> None:
    axis = rows[k, 1]
    place = x if axis == 0.0 else y if axis == 1.0 else z
    along = (place - rows[k, 2]) / rows[k, 3]
    square = 0.0
    for n in range(3):
        value = x if n == 0 else y if n == 1 else z
        square += (max(abs(value - rows[k, 8 + n]) - rows[k, 11 + n], 0.0) * rows[k, 14 + n]) ** 2
    if square < _FAINT:
        ease = rows[k, 4] / abs(rows[k, 3])
        rise = ease * (_softplus(along / ease) - _softplus((along - 1.0) / ease))
        weight = rise * math.exp(-0.5 * square)
        to[i, 0] += weight * rows[k, 5]
        to[i, 1] += weight * rows[k, 6]
        to[i, 2] += weight * rows[k, 7]


@kept(nogil=True)
def _add_lip(
    rows: FloatArray, k: int, x: float, y: float, z: float, to: FloatArray, i: int
) -> None:
    away = max(rows[k, 1] * (y - rows[k, 7]), 0.0) / rows[k, 2]
    share = min(x / rows[k, 9], 1.0)
    behind = max(rows[k, 8] - 8.0 - z - 16.0 * share**2, 0.0) / 6.0
    square = away**2 + behind**2
    if square < _FAINT:
        weight = away * math.exp(0.5 - 0.5 * square) * (1.0 - share**4) ** 2
        to[i, 0] += weight * rows[k, 3]
        to[i, 1] += weight * rows[k, 4]
        to[i, 2] += weight * rows[k, 5]


@kept(nogil=True)
def _softplus(x: float) -> float:
    return max(x, 0.0) + math.log1p(math.exp(-abs(x)))
