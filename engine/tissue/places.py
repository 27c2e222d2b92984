"""What is special about places of the built-in head's tissue, all in one table each.

Regions are those of the head's polygons, points those of its cage; other meshes have neither, and
their tissue is the same everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..head import Head
from .layers import Sheet

WHOLE_FACE = "face"
"""Region that holds every other one."""

TAUT: Mapping[str, float] = {
    "submental": 3.3,
    "neck": 1.7,
    "forehead": 2.5,
    "scalp": 2.0,
}
"""How much more than the face's the skin of some regions is pre-tensioned.

Over the platysma: with as little tension as the rest a wide open mouth comes to rest in one of two
shapes, 9 mm apart. Over the galea: a raised brow pushes the middle of the forehead 3 mm aside, to
the left or to the right after what went before.
"""
FIRM: Mapping[str, float] = {"submental": 1.9, "neck": 1.9}
"""Factor on the volume modulus: a wide open jaw pushes the skin under the chin together."""
STUBBORN: Mapping[str, float] = {"upper_lip_inner": 1.6}
"""Factor on the resistance to being pressed flat: these elements are the thinnest, and are
stretched over the teeth by every smile."""
STUBBORN_POINTS: Mapping[str, float] = {
    **dict.fromkeys(("M0_4", "M0_5", "M0_6", "M1_4", "M1_5", "M1_6"), 3.2),  # corner of the lips
    **dict.fromkeys(("E1_8", "E2_8", "E2_9"), 3.2),  # the outer corner of the eye
}
"""The same for elements between such points, where skin turns sharply."""
LIGAMENT_POINTS = ("M4_3", "M4_4", "C4_5")
"""On the nasolabial fold, where ligaments tie the skin to the bone."""


def tautness(sheet: Sheet) -> FloatArray:
    """Return the factor on the pre-tension of each node, shape (n,)."""
    return _greatest(sheet, TAUT)


def firmness(sheet: Sheet, corners: IntArray) -> FloatArray:
    """Return the factor on the volume modulus of elements over `corners` (e, 3), shape (e,)."""
    return np.asarray(_greatest(sheet, FIRM)[corners].max(axis=1))


def stubbornness(head: Head, sheet: Sheet, corners: IntArray) -> FloatArray:
    """Return the factor on what resists pressing elements over `corners` (e, 3) flat, (e,)."""
    by_region = _greatest(sheet, STUBBORN)[corners].max(axis=1)
    names = [name.partition(".")[0] for name in head.names[: head.sheet_count]]
    by_point = np.array([STUBBORN_POINTS.get(name, 1.0) for name in names])
    return np.asarray(np.maximum(by_region, by_point[corners].min(axis=1)))


def region_share(sheet: Sheet, region: str) -> FloatArray:
    """Return each node's share of the polygons of a region, shape (n,).

    Args:
        sheet: The surface.
        region: A label, a part of several ("lip"), or "face"; ".L" or ".R" takes one side of it.
    """
    stem, _, side = region.partition(".")
    inside = np.array([stem == WHOLE_FACE or stem in label for label in sheet.polygon_regions])
    share, total = np.zeros(len(sheet.points)), np.zeros(len(sheet.points))
    for k in range(4):
        has = sheet.polygons[:, k] >= 0
        corner = sheet.polygons[has, k]
        np.add.at(share, corner, inside[has].astype(float))
        np.add.at(total, corner, 1.0)
    share = np.asarray(share / np.maximum(total, 1.0))
    if side:
        sign = np.sign(sheet.points[:, 0]) * (1.0 if side == "L" else -1.0)
        share = share * (0.5 + 0.5 * sign)
    return share


def _greatest(sheet: Sheet, factors: Mapping[str, float]) -> FloatArray:
    by_region: Sequence[FloatArray] = [
        1.0 + (factor - 1.0) * region_share(sheet, name) for name, factor in factors.items()
    ]
    return np.asarray(np.max(by_region, axis=0))
