"""The ear: rings round the bowl, from the hole in the side of the head over the rim to the canal.

From outside in: the hole, P1 the root on the head, P2 and P3 the back of the auricle, P4 the rim's
outer edge, P5 and P6 the crest and inner lip of the helix, P7 the furrow behind it (scapha), P8 the
antihelix and the fork of its two arms, P9 the wall of the bowl (above, the lower arm), P10 and P11
its floor with the canal's mouth. In front the same rings make the tragus and, over it, the crus of
the helix that runs into the bowl. Spokes count from the top of the front edge over the top to the
back, as the hole's points do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from ...arrays import FloatArray
from .half import HalfCage
from .side import EAR_ROWS, EAR_STEPS, ear_rim

SPOKES = 20
LAST_RING = 10
FLOOR = "P11"
"""Points within the last ring: a grid like the hole's, row by row, each from front to back."""

RIM_RINGS = (4, 5, 6)
RIM_SPOKES = range(2, 13)
"""The ear's free edge and crest, which show as an outline."""

ORIGIN = np.array([72.0, -14.0, 0.0])
"""The notch over the tragus, mm."""
TILT = np.radians(17)
"""The ear's long axis leans back by this."""
FLARE = np.radians(22)
"""The ear stands off the head by this."""
CANT = np.radians(8)
"""Its top stands out and its lobe in by this."""

FLUSH = (16, 17, 18, 19)
"""Spokes before the canal, on which the ear rises from the head without a back."""


def add_ear(half: HalfCage, authored: Mapping[str, Sequence[Sequence[float]]]) -> None:
    """Place the ear's rings and add its faces."""
    frame = _frame()
    rim = ear_rim()
    hole = (np.array([half.points[name] for name in rim]) - ORIGIN) @ frame.T
    on_head = _fitted(hole)
    rings = {
        int(name[1:]): np.array([_standing(point, on_head) for point in points])
        for name, points in authored.items()
    }
    for ring, points in rings.items():
        for spoke, point in enumerate(points @ frame + ORIGIN):
            half.place(f"P{ring}_{spoke}", point)
    names = [rim] + [[f"P{ring}_{k}" for k in range(SPOKES)] for ring in range(1, LAST_RING + 1)]
    for outer, inner in pairwise(names):
        for spoke in range(SPOKES):
            following = (spoke + 1) % SPOKES
            half.face("ear", outer[spoke], outer[following], inner[following], inner[spoke])
    _add_floor(half, names[-1])


def rim_points() -> list[str]:
    """Return the names of the points on the ear's free edge and crest."""
    return [f"P{ring}_{spoke}" for ring in RIM_RINGS for spoke in RIM_SPOKES]


def _add_floor(half: HalfCage, ring: Sequence[str]) -> None:
    """Add the faces within the last ring, whose corners lie on the spokes of the hole's corners."""
    rows, columns = EAR_ROWS[1] - EAR_ROWS[0], EAR_STEPS[1] - EAR_STEPS[0]

    def at(row: int, column: int) -> str:
        if row == 0:
            return ring[column]
        if column == columns:
            return ring[columns + row]
        if row == rows:
            return ring[2 * columns + rows - column]
        if column == 0:
            return ring[SPOKES - row]
        return f"{FLOOR}_{(row - 1) * (columns - 1) + column - 1}"

    for row in range(rows):
        for column in range(columns):
            half.face(
                "ear",
                at(row, column),
                at(row, column + 1),
                at(row + 1, column + 1),
                at(row + 1, column),
            )


def _frame() -> FloatArray:
    """Return the ear's forward, up and outward directions in the head's frame, as rows."""
    up = np.array([0.0, np.cos(TILT), -np.sin(TILT)])
    ahead = np.array([0.0, np.sin(TILT), np.cos(TILT)])
    side = np.array([1.0, 0.0, 0.0])
    forward = ahead * np.cos(FLARE) - side * np.sin(FLARE)
    outward = side * np.cos(FLARE) + ahead * np.sin(FLARE)
    return np.array(
        [
            forward,
            up * np.cos(CANT) + outward * np.sin(CANT),
            outward * np.cos(CANT) - up * np.sin(CANT),
        ]
    )


def _terms(forward: FloatArray, up: FloatArray) -> FloatArray:
    return np.stack([np.ones_like(up), forward, up, forward**2, forward * up, up**2], axis=-1)


def _fitted(hole: FloatArray) -> FloatArray:
    """Return the head's surface in the ear's frame: a quadric through the hole's points."""
    fit, *_ = np.linalg.lstsq(_terms(hole[:, 0], hole[:, 1]), hole[:, 2], rcond=None)
    return np.asarray(fit)


def _standing(point: Sequence[float], on_head: FloatArray) -> FloatArray:
    """Return an authored point, put on the head if it has no height of its own."""
    if len(point) == 3:
        return np.array(point, dtype=float)
    forward, up = (np.asarray(value, dtype=float) for value in point)
    return np.array([forward, up, _terms(forward, up) @ on_head])
