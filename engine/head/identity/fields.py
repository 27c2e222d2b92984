"""Smooth displacement fields in the space of the built-in head, from which every face is made.

A field is a sum of terms. Each term is even about the midline: a face that is symmetric stays so,
to the last bit, and no term has an edge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray

Vector = tuple[float, float, float]
Anchors = Mapping[str, FloatArray]
"""Where named points of the left half and the midline lie on the built-in head, mm."""

NEVER = 1.0e9
"""A reach that never ends, mm."""


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

    def at(self, points: FloatArray, anchors: Anchors) -> FloatArray:
        """Return the displacement at points (k, 3), mm."""
        middle = anchors[self.anchor] + np.array(self.offset)
        if abs(middle[0]) < 1e-6:
            return self._side(points, middle)
        mirrored = np.array([-1.0, 1.0, 1.0])
        image = self._side(points * mirrored, middle) * mirrored
        return np.asarray(self._side(points, middle) + image)

    def _side(self, points: FloatArray, middle: FloatArray) -> FloatArray:
        away = points - middle
        weight = np.exp(-0.5 * ((away / np.array(self.reach)) ** 2).sum(axis=1))
        moved = np.array(self.push) + away * np.array(self.stretch)
        for along, to, amount in self.shear:
            moved[:, "xyz".index(to)] += amount * away[:, "xyz".index(along)]
        return np.asarray(moved * weight[:, None])


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

    def at(self, points: FloatArray, anchors: Anchors) -> FloatArray:
        """Return the displacement at points (k, 3), mm."""
        axis = "xyz".index(self.axis)
        low, high = anchors[self.start][axis], anchors[self.end][axis]
        span = high - low
        along = (points[:, axis] - low) / span
        ease = self.ease / abs(span)
        rise = ease * (np.logaddexp(0.0, along / ease) - np.logaddexp(0.0, (along - 1) / ease))
        away = np.abs(points - (anchors[self.anchor] + np.array(self.offset)))
        away = np.maximum(away - np.array(self.plateau), 0.0) / np.array(self.reach)
        window = np.exp(-0.5 * (away**2).sum(axis=1))
        return np.asarray((rise * window)[:, None] * np.array(self.push))


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

    def at(self, points: FloatArray, anchors: Anchors) -> FloatArray:
        """Return the displacement at points (k, 3), mm."""
        seam, corner = anchors[self.seam], anchors[self.corner]
        size = abs(anchors[self.border][1] - seam[1])
        away = np.maximum(self.side * (points[:, 1] - seam[1]), 0.0) / size
        share = np.clip(np.abs(points[:, 0]) / corner[0], 0.0, 1.0)
        across = (1.0 - share**4) ** 2
        behind = np.maximum(seam[2] - 8.0 - points[:, 2] - 16.0 * share**2, 0.0) / 6.0
        weight = away * np.exp(0.5 - 0.5 * away**2) * across * np.exp(-0.5 * behind**2)
        x, y, z = self.push
        return np.asarray(weight[:, None] * np.array([x, self.side * y, z]))


Term = Bump | Ramp | Lip


def field_at(terms: Sequence[Term], points: FloatArray, anchors: Anchors) -> FloatArray:
    """Return the sum of `terms` at points (k, 3), mm."""
    total = np.zeros_like(points)
    for term in terms:
        total += term.at(points, anchors)
    return total
