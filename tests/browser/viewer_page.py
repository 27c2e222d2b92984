"""What tests read off a page of the viewer."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from playwright.sync_api import TimeoutError

if TYPE_CHECKING:
    from playwright.sync_api import Page

PATIENCE_SECONDS = 30.0
_STANDING = """() => {
  const { ready, connected, session, rig, tick, framesDrawn, asleep } = window.__viewer ?? {};
  const marks = performance.getEntriesByType('mark').map((mark) => mark.name);
  const words = document.body.innerText.slice(0, 400);
  return { ready, connected, session, rig, tick, framesDrawn, asleep, marks, words };
}"""


def height(page: Page, landmark: str) -> float:
    """Return how high the drawn landmark is now, in metres."""
    return float(
        page.evaluate(
            "name => window.__viewer.drawnVertex(window.__viewer.landmarks[name])[1]", landmark
        )
    )


def settle(page: Page, after: int = -1) -> int:
    """Wait until the face sleeps, later than a tick, and is drawn; return its tick."""
    try:
        page.wait_for_function(
            "t => window.__viewer?.ready && window.__viewer.asleep && window.__viewer.tick > t",
            arg=after,
        )
    except TimeoutError as error:
        raise AssertionError(f"the face did not come to rest: {_standing(page)}") from error
    page.evaluate("() => window.__viewer.render()")
    return int(page.evaluate("() => window.__viewer.tick"))


def _standing(page: Page) -> object:
    """Return where a page stands that did not come as far as it should have."""
    try:
        return page.wait_for_function(_STANDING, timeout=5_000).json_value()
    except TimeoutError:
        return "its script does not answer"


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
