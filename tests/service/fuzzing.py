"""What the fuzz tests share: how much is tried, data of any kind, and a service to try it on."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from conftest import settings_in, until
from fastapi import FastAPI
from hypothesis import strategies as st

from service.app import create_app
from service.server import running

WANTED = int(os.environ.get("RISORIUS_FUZZ_EXAMPLES", "0"))
"""Examples of each route and of each kind of message; 0 takes a few."""
TIMEOUT = 0 if WANTED else 600
"""Seconds that one test may take; 0 is as long as it lasts."""
ROUTES = os.environ.get("RISORIUS_FUZZ_ROUTES", "")
"""A regular expression for the names of the routes to try, as "POST /api/facs"; empty tries all."""
MANY = 1_000_000
LIMITS = {
    "requests_per_second": MANY,
    "max_sessions": MANY,
    "max_rigs": MANY,
    "max_clips": MANY,
    "max_queued_clips": MANY,
    "max_clip_seconds": 0.2,
}
"""Limits that are not met, so that a 503 is a fault; and no example renders for long."""

ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)
"""Any JSON, and numbers that JSON does not have."""


def examples(few: int) -> int:
    """Return how many examples to try: as many as are wanted, or a few."""
    return WANTED or few


@contextmanager
def fuzzed(folder: Path) -> Iterator[tuple[str, FastAPI]]:
    """Serve an application, ready, for as long as the block lasts; yield its URL too."""
    settings = settings_in(folder, **LIMITS)
    app = create_app(settings)
    with running(app, settings) as url:
        until(lambda: bool(app.state.parts.ready.is_set()), seconds=120)
        yield url, app
