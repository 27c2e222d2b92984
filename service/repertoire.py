"""What a face can do, as Markdown: its action units, their combinations, and how they differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from engine import (
    ALIKE,
    LANDMARKS,
    MOST_ALIKE,
    REGIONS,
    ActionUnit,
    AirPressure,
    Combination,
    Rig,
    Separability,
)

from .tables import markdown_table

UNITS_COMMAND = "risorius units"
SEPARABILITY_COMMAND = "risorius separability"
_REGION_TITLES: Mapping[str, str] = {
    "upper": "Upper face",
    "lids": "Lids",
    "lower": "Lower face",
    "cheeks": "Cheeks",
    "jaw": "Jaw",
    "tongue": "Tongue",
    "gaze": "Eyes",
    "head": "Head",
}
_CLOSEST = 20
"""Pairs listed by name, the most alike first."""


def units_markdown(rig: Rig) -> str:
    """Return every unit with what is seen, its recipe and its range, then the combinations."""
    lines = [
        "# Action units",
        "",
        f"`{UNITS_COMMAND}` prints this page. A weight is a muscle's activation at intensity 1,",
        "along the unit's calibrated curve; `L12` and `R12` move one side, `AU12` both. A weight",
        "below 0 relaxes a muscle that has tone, or is air sucked in; rows in italics are air and",
        "not muscle. Figures are what a landmark does on living faces at full intensity, our",
        "estimates.",
    ]
    for region in (*REGIONS, *sorted({u.region for u in rig.action_units.values()} - {*REGIONS})):
        units = [unit for unit in rig.action_units.values() if unit.region == region]
        if units:
            lines += ["", f"## {_REGION_TITLES.get(region, region.capitalize())}"]
        for unit in units:
            lines += _unit(rig, unit)
    lines += ["", "## Combinations", "", "Everything else adds up.", ""]
    rules = [
        (rule.name, rule.look, "; ".join(_rule(rule)), rule.source) for rule in rig.combinations
    ]
    lines += markdown_table(("units", "look", "rule", "source"), rules)
    return "\n".join(lines)


def _unit(rig: Rig, unit: ActionUnit) -> list[str]:
    sided = " It is one-sided: `L` or `R` says which, and without either it is the left." * (
        unit.one_sided
    )
    lines = ["", f"### {unit.name} {unit.title}", "", f"{unit.description}{sided}", ""]
    figures = [
        f"{mark.what} {_span(mark.low, mark.high)} {mark.scale}"
        for mark in LANDMARKS
        if mark.unit == unit.name
    ]
    if figures:
        lines += [f"On living faces: {', '.join(figures)}. {_sentence(unit.source)}", ""]
    else:
        lines += [_sentence(unit.source), ""]
    lines += [
        f"In its own time it takes {unit.onset:g} s to come and {unit.offset:g} s to go: "
        f"{unit.timing}.",
        "",
    ]
    air = {
        muscle.name.partition(".")[0] for muscle in rig.muscles if isinstance(muscle, AirPressure)
    }
    moves = []
    for muscle, weight in unit.muscles.items():
        name = f"*{muscle}*" if muscle in air else muscle
        moves.append((name, f"{weight:g}", unit.sources.get(muscle, unit.source)))
    for place, value in unit.pose.items():
        scale = "mm" if place.endswith("thrust") else "°"
        moves.append((place, f"{value:g} {scale}", unit.source))
    return [*lines, *markdown_table(("moves", "weight", "source"), moves)]


def _rule(rule: Combination) -> Iterator[str]:
    if rule.yields:
        reach = ", ".join(f"{name} {value:g}" for name, value in rule.yields.items())
        yield f"the greatest is seen, by reach in mm: {reach}"
    for unit, factors in rule.factors.items():
        for muscle, factor in factors.items():
            yield f"{muscle} of {unit} times {factor:g}"
    for muscle, activation in rule.adds.items():
        yield f"{muscle} plus {activation:g} of the weaker"


def separability_markdown(found: Separability) -> str:
    """Return the closest pairs and the whole matrix, in hundredths."""
    numbers = [unit.removeprefix("AU") for unit in found.units]
    groups = "; ".join("/".join(sorted(u.removeprefix("AU") for u in group)) for group in ALIKE)
    lines = [
        "# How action units differ",
        "",
        f"`{SEPARABILITY_COMMAND}` prints this page: the cosine similarity of the settled",
        "displacement of skin and tongue at intensity 1, each point by its area, on the standard",
        f"face. 1 is the same look at another size. A test holds every pair under {MOST_ALIKE:g},",
        f"but for those that FACS itself tells by extent or by time: {groups}.",
        "Units of gaze and head (51 to 66) move no skin.",
        "",
        "## Most alike",
        "",
    ]
    pairs = ((f"{one}, {other}", f"{v:.2f}") for one, other, v in found.pairs()[:_CLOSEST])
    lines += markdown_table(("units", "similarity"), pairs)
    lines += ["", "## All pairs, in hundredths", ""]
    rows = []
    for row, number in enumerate(numbers):
        cells = [f"{100 * value:.0f}".replace("-0", "0") for value in found.cosines[row, : row + 1]]
        rows.append((f"**{number}**", *cells, *[""] * (len(numbers) - row - 1)))
    return "\n".join([*lines, *markdown_table(("AU", *numbers), rows)])


def _span(low: float, high: float) -> str:
    return f"up to {high:g}" if low < 0 else f"{low:g} to {high:g}"


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + "."
