"""Wrinkles of expression: where skin is pressed together, measured between points of the tissue.

A gauge is a pair of tissue points; what it loses of its length beyond the slack that skin takes up
without a fold, times its gain, is the strength of the wrinkles around it. Pairs, slack and gains
were chosen by settling the standard rig under each action unit: a site reaches about 1 under its
own units and stays at 0 under the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .anatomy import smoothstep
from .head import Head

_LEAST = 0.01
"""Weights below this are left out."""


class Site(NamedTuple):
    """An ellipse in the front view of the built-in head [mm] where wrinkles form together."""

    x: float
    y: float
    width: float
    height: float
    behind: float = 20.0
    """No skin further back than this belongs to it."""


class Gauge(NamedTuple):
    """A pair of tissue points; on both sides of the face where a name ends in ".L".

    Attributes:
        site: Where it tells of wrinkles.
        first: Name of one end.
        second: Name of the other.
        gain: Strength per share of length lost beyond the slack.
        slack: Share of its length that skin gives way before it folds.
        weight: Its share of the site.
        column: Where across the site it is felt most, mm from the midline; None for all of it.
    """

    site: str
    first: str
    second: str
    gain: float
    slack: float = 0.0
    weight: float = 1.0
    column: float | None = None


SITES = {
    "forehead": Site(0, 50, 64, 26),
    "glabella": Site(0, 17, 17, 17),
    "nasal_root": Site(0, 3, 13, 11),
    "nose_side": Site(11, -14, 9, 14),
    "crows_feet": Site(61, 0, 19, 20, behind=8.0),
    "lower_lid": Site(33, -12, 18, 8),
    "nasolabial": Site(29, -58, 15, 30),
    "nasolabial_upper": Site(26, -53, 13, 24),
    "chin": Site(0, -99, 24, 16),
}

GAUGES = (
    Gauge("forehead", "G4_0", "G2_0", 10.5, slack=0.037, column=0),
    Gauge("forehead", "G4_2.L", "G2_1.L", 10.5, slack=0.03, column=14),
    Gauge("forehead", "G4_3.L", "G2_3.L", 13.0, slack=0.024, column=27),
    Gauge("forehead", "G4_5.L", "G2_5.L", 20.5, slack=0.05, column=41),
    Gauge("forehead", "T1_6.L", "G2_7.L", 12.0, slack=0.034, column=56),
    Gauge("glabella", "b1_2.L", "b1_2.R", 9.2, slack=0.013),
    Gauge("nasal_root", "b1_0", "b3_0", 17.0, slack=0.045),
    Gauge("nose_side", "C4_1.L", "A7.L", 16.0, slack=0.021),
    Gauge("crows_feet", "C8_1.L", "E2_8.L", 15.0, slack=0.015, weight=0.5),
    Gauge("crows_feet", "E4_9.L", "E4_6.L", 18.0, slack=0.016, weight=0.5),
    Gauge("lower_lid", "E1_11.L", "E3_11.L", 6.0, slack=0.04),
    Gauge("nasolabial", "M4_4.L", "C4_3.L", 5.6, slack=0.017),
    Gauge("nasolabial_upper", "E3_15.L", "A6.L", 13.0, slack=0.009, weight=0.8),
    Gauge("chin", "M4_10", "M0_2.L", 11.5, slack=0.05),
)


@dataclass(frozen=True, eq=False)
class Wrinkles:
    """Gauges and how they spread over the drawn skin.

    Attributes:
        first: Tissue point at one end of each gauge, shape (g,).
        second: At the other, shape (g,).
        rest: Length below which skin folds, a little less than at rest [mm], shape (g,).
        gain: Strength per share of length lost, shape (g,).
        spread: Strength at drawn vertices from that of gauges, sparse (d, g).
    """

    first: IntArray
    second: IntArray
    rest: FloatArray
    gain: FloatArray
    spread: sp.csr_array

    def strengths(self, points: FloatArray) -> FloatArray:
        """Return how far each gauge is pressed, 0..1, shape (g,), by tissue points [mm] (s, 3)."""
        length = np.linalg.norm(points[self.first] - points[self.second], axis=1)
        return np.asarray(np.clip(self.gain * (1 - length / self.rest), 0.0, 1.0))

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return how wrinkled each drawn vertex is, 0..1, shape (d,).

        The viewer computes the same in TypeScript; this is the reference.
        """
        return np.asarray(np.clip(self.spread @ self.strengths(points), 0.0, 1.0))


def wrinkles_of(head: Head) -> Wrinkles | None:
    """Return a head's wrinkles, None for one without textures.

    Raises:
        UnknownName: The head lacks a point that a gauge needs.
    """
    reference = head.drawn.reference
    if reference is None:
        return None
    first, second, gain, taut, columns = [], [], [], [], []
    for gauge in GAUGES:
        for side in _sides(gauge):
            first.append(head.point(_on(gauge.first, side)))
            second.append(head.point(_on(gauge.second, side)))
            gain.append(gauge.gain)
            taut.append(1 - gauge.slack)
            columns.append(_weights(reference, gauge, side))
    spread = np.column_stack(columns)
    spread[np.abs(spread) < _LEAST] = 0
    ends = head.points[first], head.points[second]
    return Wrinkles(
        first=np.array(first),
        second=np.array(second),
        rest=np.array(taut) * np.linalg.norm(ends[0] - ends[1], axis=1),
        gain=np.array(gain),
        spread=sp.csr_array(spread),
    )


def _sides(gauge: Gauge) -> Sequence[str]:
    ends = {gauge.first[-2:], gauge.second[-2:]}
    return (".L", ".R") if ".L" in ends and ".R" not in ends else ("",)


def _on(name: str, side: str) -> str:
    """Return the point's name on a side; a gauge across the face has its own ends."""
    return name[:-2] + side if side and name.endswith(".L") else name


def _weights(places: FloatArray, gauge: Gauge, side: str) -> FloatArray:
    """Return how strongly a gauge is felt at places (d, 3) on the built-in head, shape (d,)."""
    site = SITES[gauge.site]
    x, y = places[:, 0], places[:, 1]
    oval = ((np.abs(x) - site.x) / site.width) ** 2 + ((y - site.y) / site.height) ** 2
    mask = np.exp(-(oval**2)) * smoothstep(site.behind, site.behind + 15, places[:, 2])
    if gauge.column is not None:
        mask = mask * _column_share(x, gauge, side)
    elif side:
        mask = mask * smoothstep(-5, 5, x if side == ".L" else -x)
    return np.asarray(gauge.weight * mask)


def _column_share(x: FloatArray, gauge: Gauge, side: str) -> FloatArray:
    """Return a column's share of its row: 1 at its middle, none at the next column's."""
    columns = sorted({c for g in GAUGES if g.site == gauge.site and (c := g.column) is not None})
    middles = np.array([-c for c in columns[:0:-1]] + columns)
    own = float(gauge.column or 0.0) * (-1 if side == ".R" else 1)
    return np.asarray(np.interp(x, middles, (middles == own).astype(float)))
