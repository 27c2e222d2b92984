"""The built-in heads, built once for all tests of heads."""

from __future__ import annotations

import pytest

from engine.head import LEVELS, Head, paper_head, standard_head
from engine.head.standard import Sculpture, sculpt


@pytest.fixture(scope="session")
def sculpture() -> Sculpture:
    """Return the built-in head before it becomes tissue and skin."""
    return sculpt()


@pytest.fixture(scope="session")
def heads() -> dict[str, Head]:
    """Return the standard head by level of detail, and the paper's as "paper"."""
    return {level: standard_head(level) for level in LEVELS} | {"paper": paper_head()}


@pytest.fixture(scope="session")
def head(heads: dict[str, Head]) -> Head:
    """Return the standard head at its finest."""
    return heads["high"]
