"""What tests read off a page of the viewer."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from playwright.sync_api import Page

PATIENCE_SECONDS = 30.0


def height(page: Page, landmark: str) -> float:
    """Return how high the drawn landmark is now, in metres."""
    return float(
        page.evaluate(
            "name => window.__viewer.drawnVertex(window.__viewer.landmarks[name])[1]", landmark
        )
    )


def settle(page: Page, after: int = -1) -> int:
    """Wait until the face sleeps, later than a tick, and is drawn; return its tick."""
    page.wait_for_function(
        "t => window.__viewer?.ready && window.__viewer.asleep && window.__viewer.tick > t",
        arg=after,
    )
    page.evaluate("() => window.__viewer.render()")
    return int(page.evaluate("() => window.__viewer.tick"))


def held(page: Page, url: str) -> dict[str, Any]:
    """Return what the service says of the session that the page shows."""
    session = page.evaluate("() => window.__viewer.session")
    answer: dict[str, Any] = page.request.get(f"{url}/api/sessions/{session}").json()
    return answer


def until(page: Page, url: str, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Wait until the layers of the page's session are as said, and return them."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while True:
        layers: dict[str, Any] = held(page, url)["layers"]
        if holds(layers):
            return layers
        assert time.monotonic() < deadline, layers
        page.wait_for_timeout(100)
