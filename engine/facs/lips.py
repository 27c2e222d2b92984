"""One lip of a unit that moves both: T is the top one, B the bottom one."""

from __future__ import annotations

from dataclasses import replace

from .notation import split_side
from .unit import ActionUnit

LIPS = ("T", "B")
"""Sides of a unit that are lips."""
PARTED = ("AU22", "AU24", "AU28")
"""Units of which one lip can go by itself. 18 and 23 are the rings' work, which pull both lips:
half of 18 with the upper lip's muscles brings the lower lip farther forward than the upper."""
_OWN = {
    "T": (
        "orbicularis_oris_superior",
        "levator_labii_superioris",
        "levator_labii_alaeque_nasi",
        "depressor_septi",
    ),
    "B": ("orbicularis_oris_inferior", "depressor_labii_inferioris", "mentalis"),
}
"""Muscles that act on one lip, without side; all others act on both."""
_TITLES = {"T": "top lip", "B": "bottom lip"}


def lip_part(unit: ActionUnit, lip: str) -> ActionUnit | None:
    """Return what one lip does of `unit`, None where it cannot go without the other.

    It has the muscles of that lip, and half of what moves both: two parts are the unit again.

    Args:
        unit: The whole.
        lip: One of `LIPS`.
    """
    if unit.name not in PARTED:
        return None
    (other,) = set(LIPS) - {lip}
    muscles = {}
    for muscle, weight in unit.muscles.items():
        stem = muscle.partition(".")[0]
        if stem not in _OWN[other]:
            muscles[muscle] = weight if stem in _OWN[lip] else 0.5 * weight
    return replace(
        unit,
        name=part_name(unit.name, lip),
        title=f"{unit.title}, {_TITLES[lip]}",
        muscles=muscles,
        pose={place: 0.5 * value for place, value in unit.pose.items()},
    )


def part_name(name: str, lip: str) -> str:
    """Return how one lip of a unit is called: "T28" of "AU28"."""
    return f"{lip}{name.removeprefix('AU')}"


def whole_of(name: str) -> str:
    """Return the unit that a part is of: "AU28" for "T28", and "" for what is no part."""
    if not name.startswith(LIPS) or not name[1:].isdigit():
        return ""
    whole, _ = split_side(name)
    return whole if whole in PARTED else ""
