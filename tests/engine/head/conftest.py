"""The built-in heads, built once for all tests of heads."""

from __future__ import annotations

from dataclasses import replace

import pytest

from engine.head import LEVELS, STANDARD, Head, paper_head, person_head
from engine.head.standard import Sculpture, sculpt

EVEN = replace(STANDARD, asymmetry=0.0)
"""The standard head as it was before its sides were made to differ, which is how it is tested."""


@pytest.fixture(scope="session")
def sculpture() -> Sculpture:
    """Return the built-in head before it becomes tissue and skin."""
    return sculpt()


@pytest.fixture(scope="session")
def heads() -> dict[str, Head]:
    """Return the standard head with both sides alike, by level, and the paper's as "paper"."""
    return {level: person_head(EVEN, level) for level in LEVELS} | {"paper": paper_head()}


@pytest.fixture(scope="session")
def head(heads: dict[str, Head]) -> Head:
    """Return the standard head at its finest."""
    return heads["high"]
