"""Rigs and small tissues that the engine's tests share."""

from __future__ import annotations

import pytest
from small_tissue import SmallTissue, small_tissue

from engine import Rig, builtin_rig


@pytest.fixture(scope="session")
def standard_rig() -> Rig:
    """Return the built-in standard rig."""
    return builtin_rig("standard")


@pytest.fixture(scope="session")
def paper_rig() -> Rig:
    """Return the paper's literal rig."""
    return builtin_rig("paper")


@pytest.fixture(scope="session")
def patch() -> SmallTissue:
    """Return a small patch of tissue with every term on."""
    return small_tissue()
