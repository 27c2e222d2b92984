"""What every test shares: the switch that rewrites golden files."""

from __future__ import annotations

import os

import pytest

# How many faces a machine moves is measured, and tests run beside other work: none is refused but
# where a test says so.
os.environ.setdefault("RISORIUS_CAPACITY_SHARE", "1000")
# As in the service, and before anything imports NumPy: many workers would wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="rewrite the golden files from what the code does now; review the diff",
    )


@pytest.fixture(scope="session")
def update_golden(request: pytest.FixtureRequest) -> bool:
    """Tell whether this run rewrites golden files instead of comparing with them."""
    return bool(request.config.getoption("--update-golden"))
