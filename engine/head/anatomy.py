"""Anatomy as fields over the skin: depth of the tissue, its hold on the skull, the jaw's share.

Depths are of the order that forensic tables of facial tissue give, simplified; weights were chosen
so that retaining ligaments hold and the cheek, lips and lids slide. None comes from Zhang et al.
2001, whose tissue is uniform.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray


class Blob(NamedTuple):
    """An ellipse in the front view, both sides alike, where a field takes another value."""

    x: float
    y: float
    radius_x: float
    radius_y: float
    value: float


DEPTH_ELSEWHERE = 8.0
DEPTHS = (
    Blob(0, 50, 80, 36, 5.0),  # forehead
    Blob(31, 20, 34, 9, 6.0),  # brow
    Blob(0, 3, 9, 18, 4.0),  # bridge of the nose
    Blob(0, -35, 16, 14, 6.0),  # tip of the nose
    Blob(31, -1, 20, 11, 3.0),  # lids
    Blob(40, -45, 20, 24, 14.0),  # cheek
    Blob(0, -72, 36, 17, 10.0),  # lips
    Blob(0, -106, 24, 12, 9.0),  # chin
    Blob(58, -20, 13, 7, 7.0),  # cheekbone
    Blob(58, -86, 16, 18, 9.0),  # angle of the jaw
)

ANCHOR_ELSEWHERE = 0.5
ANCHORS = (
    Blob(0, 45, 75, 34, 0.15),  # forehead
    Blob(31, 20, 34, 11, 0.10),  # brow
    Blob(0, 3, 8, 18, 1.2),  # bridge of the nose
    Blob(0, -35, 16, 12, 0.8),  # tip of the nose
    Blob(31, -2, 20, 13, 0.2),  # lids
    Blob(42, -48, 24, 26, 0.12),  # cheek
    Blob(0, -72, 38, 17, 0.08),  # lips
    Blob(0, -108, 24, 13, 0.5),  # chin
    Blob(58, -20, 14, 7, 0.9),  # cheekbone
    Blob(58, -86, 16, 20, 0.8),  # angle of the jaw
    Blob(70, -30, 16, 60, 0.8),  # edge of the face
)
MUCOSA_ANCHOR = 1.0
LID_CREASE_ANCHOR = 3.0
THROAT_ANCHOR = {
    "C7": {9: 0.8, 10: 0.8},
    "C8": {8: 1.5, 9: 2.5, 10: 2.5},
    "Q0": {0: 2.5, 1: 2.5, 2: 2.0, 3: 1.5},
    "Q1": {0: 1.5, 1: 1.5, 2: 1.5, 3: 1.2},
}
"""By row and place: the hyoid holds the throat, or the open jaw would push its skin in."""

# Share of the jaw's rotation by row of the cage and place in the row.
MOUTH_ROWS = ("S1", "S2", "S3", "S4", "M0", "M1", "M2", "M3", "M4")
JAW_OF_MOUTH = {4: 0.08, 5: 0.48, 6: 0.92, 7: 1.0, 8: 1.0, 9: 1.0, 10: 1.0}
JAW_OF_COLUMN = {
    4: {3: 0.02, 4: 0.16, 5: 0.5, 6: 0.86, 7: 1.0, 8: 1.0, 9: 1.0, 10: 1.0},
    5: {3: 0.02, 4: 0.16, 5: 0.5, 6: 0.86, 7: 1.0, 8: 1.0, 9: 1.0, 10: 1.0},
    6: {3: 0.04, 4: 0.2, 5: 0.48, 6: 0.8, 7: 0.95, 8: 0.95, 9: 0.9, 10: 0.9},
    7: {3: 0.036, 4: 0.18, 5: 0.432, 6: 0.72, 7: 0.855, 8: 0.8, 9: 0.62, 10: 0.55},
    8: {3: 0.05, 4: 0.2, 5: 0.45, 6: 0.66, 7: 0.6, 8: 0.34, 9: 0.16, 10: 0.1},
}
JAW_OF_SIDE = {
    "W12": {1: 0.2, 2: 0.1, 3: 0.04},
    "W13": {1: 0.38, 2: 0.24, 3: 0.1, 4: 0.04},
    "W14": {1: 0.58, 2: 0.45, 3: 0.26, 4: 0.12, 5: 0.04},
    "W15": {1: 0.68, 2: 0.56, 3: 0.4, 4: 0.2, 5: 0.08},
}
JAW_OF_NECK = {"Q0": (0.0, 0.0, 0.03, 0.08, 0.14, 0.18, 0.14, 0.08, 0.02)}


def tissue_depth(points: FloatArray) -> FloatArray:
    """Return the depth from skin to bone at points (n, 3), mm."""
    return _field(points, DEPTH_ELSEWHERE, DEPTHS)


def anchor_weight(points: FloatArray, names: Sequence[str]) -> FloatArray:
    """Return how strongly the skull holds the tissue at points (n, 3), 0.08 to 3, 0.5 typical.

    Args:
        points: Positions [mm], shape (n, 3).
        names: Cage name of each point without side; empty strings for meshes without names.
    """
    weight = _field(points, ANCHOR_ELSEWHERE, ANCHORS)
    rows = np.array([name.split("_")[0] for name in names])
    weight[rows == "S1"] = MUCOSA_ANCHOR
    weight[rows == "E2"] = LID_CREASE_ANCHOR
    for index, name in enumerate(names):
        row, _, place = name.partition("_")
        if row in THROAT_ANCHOR:
            weight[index] = THROAT_ANCHOR[row].get(int(place), weight[index])
    return weight


def jaw_share(name: str) -> float:
    """Return a cage point's share of the jaw's rotation, 0 (skull) to 1 (jaw)."""
    row, _, place = name.partition("_")
    index = int(place) if place else 0
    if row in MOUTH_ROWS:
        return JAW_OF_MOUTH.get(index, 0.0)
    if row[0] == "C":
        return JAW_OF_COLUMN[int(row[1:])].get(index, 0.0)
    if row in JAW_OF_SIDE:
        return JAW_OF_SIDE[row].get(index, 0.0)
    if row in JAW_OF_NECK:
        return dict(enumerate(JAW_OF_NECK[row])).get(index, 0.0)
    return 0.0


def _field(points: FloatArray, elsewhere: float, blobs: Sequence[Blob]) -> FloatArray:
    side, height = np.abs(points[:, 0]), points[:, 1]
    value = np.full(len(points), elsewhere)
    for blob in blobs:
        distance = np.hypot((side - blob.x) / blob.radius_x, (height - blob.y) / blob.radius_y)
        inside = 1 - smoothstep(0.6, 1.4, distance)
        value += (blob.value - value) * inside
    return value


def smoothstep(low: float, high: float, value: FloatArray) -> FloatArray:
    """Return the cubic step from 0 at `low` to 1 at `high` (either may be the larger)."""
    share = np.clip((np.asarray(value) - low) / (high - low), 0.0, 1.0)
    return np.asarray(share * share * (3 - 2 * share))
