"""Chromium, a service with the built viewer, and pages that fail their test when a script fails."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from service.app import create_app
from service.browser import NoBrowser, chromium
from service.server import running
from service.settings import Settings

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

TIMEOUT_MS = 120_000
START_SECONDS = 300.0


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium; without it these tests skip.

    It goes with its module: while Playwright runs, its event loop counts as running in this thread,
    and no test that comes after in the same process could run one of its own.
    """
    try:
        with chromium() as started:
            yield started
    except NoBrowser as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A real server with the built viewer."""
    folder = tmp_path_factory.mktemp("browser")
    settings = Settings(data_dir=folder)
    if not (settings.viewer_dir / "index.html").is_file():
        pytest.fail("the viewer is not built: run `npm ci && npm run build` in static/")
    app = create_app(settings)
    with running(app, settings) as address:
        # What the pages are timed by is drawing, not the first start's building and compiling.
        deadline = time.monotonic() + START_SECONDS
        while not app.state.parts.ready.is_set():
            assert time.monotonic() < deadline, app.state.parts.stage
            time.sleep(0.1)
        yield address


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A small page that fails the test if a script fails."""
    page = browser.new_page(viewport={"width": 320, "height": 240})
    page.set_default_timeout(TIMEOUT_MS)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    page.close()
    assert errors == []
