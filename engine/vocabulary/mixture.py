"""Several recipes on one face: each action unit by the recipes' shares of it."""

from __future__ import annotations

from collections.abc import Sequence

from ..facs import Term, parse_facs

HALVES = {"L": "R", "R": "L"}
"""Sides of the face, each with the other one; lips, T and B, are no halves of a unit."""


def mixed(shares: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Return the intensities of a weighted sum of FACS strings, by unit or by side of one.

    A unit that any of them has on one side is summed by side, and told by side where the sides
    differ.

    Args:
        shares: FACS strings, empty for rest, each with its share, 0..1.
    """
    read = [(term, share) for facs, share in shares if facs.strip() for term in parse_facs(facs)]
    sided = {term.name for term, _ in read if term.side in HALVES}
    sums: dict[tuple[str, str], float] = {}
    for term, share in read:
        both = term.name in sided and not term.side
        for side in HALVES if both else (term.side,):
            place = (term.name, side)
            sums[place] = min(1.0, sums.get(place, 0.0) + share * term.intensity)
    units: dict[str, float] = {}
    for (name, side), value in sums.items():
        if value == 0.0:
            continue
        even = side in HALVES and value == sums.get((name, HALVES[side]))
        units[Term(name, "" if even else side, value).key] = value
    return units
