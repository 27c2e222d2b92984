"""What every test shares: the switch that rewrites golden files, and which files come first."""

from __future__ import annotations

import os

import pytest

# How many faces a machine moves is measured, and tests run beside other work: none is refused but
# where a test says so.
os.environ.setdefault("RISORIUS_CAPACITY_SHARE", "1000")
# As in the service, and before anything imports NumPy: many workers would wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

LONGEST = (
    "test_bench",
    "test_viewer",
    "test_accuracy",
    "test_inside_panel",
    "test_expression_files",
    "test_stage",
    "test_accessibility",
    "test_puppeteering",
    "test_take",
    "test_first_frame",
    "test_inside",
    "test_soak",
    "test_stability",
    "test_embed",
    "test_starting",
    "test_readme",
    "test_paper_rig",
    "test_clip_keeping",
    "test_clip_files",
    "test_screens",
)
"""Files that take longest, in the order in which they begin: who begins one of them last is waited
for by all the others."""


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


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the files that take longest first; the rest stay in order."""
    rank = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.path.stem, len(rank)))
