"""Faces on somebody else's page: an element that obeys, rests and says how it is."""

from __future__ import annotations

import io
import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from PIL import Image
from playwright import sync_api as playwright_api

from service.app import create_app
from service.server import running
from service.settings import Settings

pytestmark = pytest.mark.browser
START_SECONDS = 300.0
PATIENCE_SECONDS = 60.0
KEY = "a-key-of-this-test-alone"
BEARER = {"Authorization": f"Bearer {KEY}"}
PAGE = """<!doctype html><title>A chat</title>
<style>body {{ margin: 0; background: rgb(255, 0, 255) }} risorius-face {{ width: 240px }}</style>
<script type="module" src="{service}/embed.js"></script>
<risorius-face id="one" session="{one}" ticket="{one_ticket}"></risorius-face>
<risorius-face id="two" session="{two}" ticket="{two_ticket}" emotion="anger"></risorius-face>
<risorius-face id="none" session="gone"></risorius-face>
<p style="height: 3000px"></p>"""


@contextmanager
def other_origin() -> Iterator[tuple[str, list[str]]]:
    """A server of one page, which the list holds; yields its origin."""
    pages: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(pages[0].encode())

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", pages
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def opened(page: playwright_api.Page, api: str) -> str:
    """Open a session and return its id."""
    return str(page.request.post(api, data={}, headers=BEARER).json()["id"])


def ticket(page: playwright_api.Page, session: str) -> str:
    """Return a ticket that lets a page move a face."""
    answer = page.request.post(f"{session}/tickets", data={"role": "control"}, headers=BEARER)
    return str(answer.json()["ticket"])


def until(page: playwright_api.Page, true: Callable[[], bool]) -> None:
    """Wait, while the page goes on, until `true` holds."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while not true():
        assert time.monotonic() < deadline, "it did not come true in time"
        page.wait_for_timeout(100)


def felt(page: playwright_api.Page, session: str) -> str | None:
    """Return the label that a face plays."""
    layers = page.request.get(session, headers=BEARER).json()["layers"]
    return layers["emotion"]["emotion"]["label"] if "emotion" in layers else None


def test_faces_stand_on_a_page_of_another_origin_by_tickets(
    page: playwright_api.Page, tmp_path: Path
) -> None:
    with other_origin() as (origin, pages):
        settings = Settings(data_dir=tmp_path, allowed_origins=(origin,), api_keys=(KEY,))
        app = create_app(settings)
        with running(app, settings) as url:
            deadline = time.monotonic() + START_SECONDS
            while not app.state.parts.ready.is_set():
                assert time.monotonic() < deadline, app.state.parts.stage
                time.sleep(0.1)
            api = f"{url}/api/sessions"
            one, two = (opened(page, api) for _ in range(2))
            tickets = {"one_ticket": ticket(page, f"{api}/{one}")}
            tickets["two_ticket"] = ticket(page, f"{api}/{two}")
            pages.append(PAGE.format(service=url, one=one, two=two, **tickets))
            page.set_viewport_size({"width": 640, "height": 400})
            page.goto(origin)
            face = page.locator("#one")
            playwright_api.expect(face).to_have_attribute("state", "ready", timeout=120_000)
            other = page.locator("#two")
            playwright_api.expect(other).to_have_attribute("state", "ready", timeout=120_000)
            # Beside the head one sees the page behind; the head itself is no magenta.
            with Image.open(io.BytesIO(face.screenshot())) as taken:
                picture = taken.convert("RGB")
            assert picture.getpixel((4, 4)) == (255, 0, 255)
            middle = picture.getpixel((picture.width // 2, picture.height // 2))
            assert isinstance(middle, tuple)
            assert middle[1] > 30
            face.evaluate("face => face.setAttribute('emotion', 'joy')")
            until(page, lambda: felt(page, f"{api}/{one}") == "joy")
            until(page, lambda: felt(page, f"{api}/{two}") == "anger")
            # What it does not know it says, and it stays as it was.
            face.evaluate("face => face.addEventListener('refused', e => face.refused = e.detail)")
            for attribute, wrong in (("intensity", "strong"), ("emotion", "flurbl")):
                with page.expect_console_message(lambda said: said.type == "warning") as warning:
                    face.evaluate("(face, to) => face.setAttribute(...to)", [attribute, wrong])
                assert wrong in warning.value.text
                assert wrong in face.evaluate("face => face.refused.words")
                face.evaluate("face => face.removeAttribute('intensity')")
            assert "anger" in face.evaluate("face => face.refused.known")
            assert felt(page, f"{api}/{one}") == "joy"
            page.evaluate("() => window.scrollTo(0, 2000)")
            playwright_api.expect(face).to_have_attribute("state", "resting", timeout=60_000)
            until(
                page,
                lambda: page.request.get(f"{api}/{one}", headers=BEARER).json()["viewers"] == 0,
            )
            # What it is asked where nobody sees it, it does when it is seen.
            face.evaluate("face => face.setAttribute('emotion', 'anger')")
            page.evaluate("() => window.scrollTo(0, 0)")
            playwright_api.expect(face).to_have_attribute("state", "ready", timeout=60_000)
            until(page, lambda: felt(page, f"{api}/{one}") == "anger")
            stranger = page.locator("#none")
            playwright_api.expect(stranger).to_have_attribute("state", "locked", timeout=60_000)
            page.request.delete(f"{api}/{two}", headers=BEARER)
            over = re.compile("closed|locked")
            playwright_api.expect(other).to_have_attribute("state", over, timeout=60_000)
            playwright_api.expect(face).to_have_attribute("state", "ready")
