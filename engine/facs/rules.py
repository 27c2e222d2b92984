"""What FACS does not score together: rules as data, and the units that break them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import combinations, product
from typing import Any

from ..errors import InvalidNotation
from .codes import facs_codes
from .notation import Term, term_of
from .warning import FacsWarning

_ONE_SIDED = ("AU30", "AU46")
"""Codes of one side only, the left one where none is named."""


@dataclass(frozen=True)
class Exclusion:
    """Codes of which FACS scores one only.

    Attributes:
        rule: Its name.
        pairs: The codes, two by two: ("AU51", "AU52").
        sentence: Why.
        source: Where FACS says so.
    """

    rule: str
    pairs: tuple[tuple[str, str], ...]
    sentence: str
    source: str


@dataclass(frozen=True)
class Need:
    """A code that FACS scores only with another one.

    Attributes:
        rule: Its name.
        unit: The code.
        any_of: Codes of which one at least goes with it.
        sentence: Why.
        source: Where FACS says so.
    """

    rule: str
    unit: str
    any_of: tuple[str, ...]
    sentence: str
    source: str


@cache
def exclusions() -> tuple[Exclusion, ...]:
    """Return the rules about codes that exclude each other."""
    return tuple(
        Exclusion(**{**entry, "pairs": tuple((one, other) for one, other in entry["pairs"])})
        for entry in _read()["exclusions"]
    )


@cache
def needs() -> tuple[Need, ...]:
    """Return the rules about codes that need others."""
    return tuple(Need(**{**entry, "any_of": tuple(entry["any_of"])}) for entry in _read()["needs"])


def broken_rules(units: Mapping[str, float]) -> list[FacsWarning]:
    """Return which rules units break that are seen together, a warning for each.

    Args:
        units: Intensity 0..1 by key: "AU12", "L12". Units at 0 are not seen, and names that are
            no codes are nobody's business.
    """
    terms = list(_seen(units))
    return [
        *_excluded(terms),
        *_on_both_sides(terms),
        *_across(terms),
        *_alone(terms),
        *_unsided(terms),
    ]


def _seen(units: Mapping[str, float]) -> Iterator[Term]:
    for key, intensity in units.items():
        if intensity > 0.0:
            try:
                yield term_of(key, intensity)
            except InvalidNotation:
                continue  # A unit of the rig's own: no rule of FACS is about it.


def _excluded(terms: list[Term]) -> Iterator[FacsWarning]:
    for rule in exclusions():
        for pair in rule.pairs:
            found = [[term for term in terms if term.name == name] for name in pair]
            for one, other in product(*found):
                if _places(one) & _places(other):
                    message = (
                        f"{one.key} and {other.key} exclude each other: {_clause(rule.sentence)} "
                        f"({rule.source}); both are played"
                    )
                    yield FacsWarning(rule.rule, (one.key, other.key), message)


def _on_both_sides(terms: list[Term]) -> Iterator[FacsWarning]:
    """A code of one side only, named for both."""
    for one, other in combinations([term for term in terms if term.name in _ONE_SIDED], 2):
        if one.name == other.name and not _places(one) & _places(other):
            message = (
                f"{one.key} and {other.key} exclude each other: FACS scores {one.name} on one "
                "side; both are played"
            )
            yield FacsWarning("one_side_only", (one.key, other.key), message)


def _across(terms: list[Term]) -> Iterator[FacsWarning]:
    """A side and a lip of one unit, which have a quarter of the mouth in common."""
    for one, other in combinations(sorted(terms, key=lambda term: term.order), 2):
        if one.name == other.name and one.side in ("L", "R") and other.side in ("T", "B"):
            message = f"{one.key} and {other.key} overlap; where they do, they add up"
            yield FacsWarning("side_and_lip", (one.key, other.key), message)


def _alone(terms: list[Term]) -> Iterator[FacsWarning]:
    present = {term.name for term in terms}
    for rule in needs():
        for term in terms:
            if term.name == rule.unit and present.isdisjoint(rule.any_of):
                others = " or ".join(rule.any_of)
                message = (
                    f"{term.key} is written without {others}: {_clause(rule.sentence)} "
                    f"({rule.source}); it is played as it is"
                )
                yield FacsWarning(rule.rule, (term.key,), message)


def _unsided(terms: list[Term]) -> Iterator[FacsWarning]:
    for term in terms:
        code = facs_codes().get(term.name)
        if code is not None and term.side in ("L", "R") and term.side not in code.sides:
            message = (
                f"{term.key}: FACS scores {term.name} without a side; one side plays half of it"
            )
            yield FacsWarning("no_side", (term.key,), message)


def _places(term: Term) -> set[str]:
    """Return the quarters of the mouth, or sides of the face, that a term is about."""
    side = term.side or ("L" if term.name in _ONE_SIDED else "")
    return {
        f"{across}{along}"
        for across in ("LR" if side not in ("L", "R") else side)
        for along in ("TB" if side not in ("T", "B") else side)
    }


def _clause(sentence: str) -> str:
    """Return a sentence as a part of another one."""
    return sentence[0].lower() + sentence[1:].removesuffix(".")


def _read() -> dict[str, Any]:
    path = resources.files("engine").joinpath("data", "facs_rules.json")
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return data
