"""Every equation of the paper is cited where the engine implements it."""

from __future__ import annotations

import re
from pathlib import Path

ENGINE = Path(__file__).parents[2] / "engine"


def cited() -> set[int]:
    """Return the numbers of the equations that the engine's sources cite."""
    numbers: set[int] = set()
    for path in ENGINE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for match in re.finditer(r"Eqs?\.\s+([\d,\s]*\d(?:-\d+)?(?:\s+and\s+\d+)?)", text):
            numbers |= numbers_in(match[1])
    return numbers


def numbers_in(text: str) -> set[int]:
    """Return {7, 15} for "7, 15" and {1, 2, 3} for "1-3"."""
    found: set[int] = set()
    for part in re.split(r",|\sand\s", text):
        low, _, high = part.strip().partition("-")
        found |= set(range(int(low), int(high or low) + 1))
    return found


def test_the_reader_reads_ranges_and_lists():
    assert numbers_in("7, 15") == {7, 15}
    assert numbers_in("19-22") == {19, 20, 21, 22}


def test_equations_1_to_22_are_all_cited():
    assert set(range(1, 23)) <= cited()
