"""Faces on somebody else's page: an element that obeys, rests and says how it is."""

from __future__ import annotations

import io
import threading
import time
from collections.abc import Iterator
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
PAGE = """<!doctype html><title>A chat</title>
<style>body {{ margin: 0; background: rgb(255, 0, 255) }} risorius-face {{ width: 240px }}</style>
<script type="module" src="{service}/embed.js"></script>
<risorius-face id="one" session="{session}"></risorius-face>
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


def test_a_face_stands_on_a_page_of_another_origin(
    page: playwright_api.Page, tmp_path: Path
) -> None:
    with other_origin() as (origin, pages):
        settings = Settings(data_dir=tmp_path, allowed_origins=(origin,))
        app = create_app(settings)
        with running(app, settings) as url:
            deadline = time.monotonic() + START_SECONDS
            while not app.state.parts.ready.is_set():
                assert time.monotonic() < deadline, app.state.parts.stage
                time.sleep(0.1)
            api = f"{url}/api/sessions"
            session = page.request.post(api, data={}).json()["id"]
            pages.append(PAGE.format(service=url, session=session))
            page.set_viewport_size({"width": 640, "height": 400})
            page.goto(origin)
            face = page.locator("#one")
            playwright_api.expect(face).to_have_attribute("state", "ready", timeout=120_000)
            # Beside the head one sees the page behind; the head itself is no magenta.
            with Image.open(io.BytesIO(face.screenshot())) as taken:
                picture = taken.convert("RGB")
            assert picture.getpixel((4, 4)) == (255, 0, 255)
            middle = picture.getpixel((picture.width // 2, picture.height // 2))
            assert isinstance(middle, tuple)
            assert middle[1] > 30
            face.evaluate("face => face.setAttribute('emotion', 'joy')")
            while "emotion" not in page.request.get(f"{api}/{session}").json()["layers"]:
                assert time.monotonic() < deadline
                page.wait_for_timeout(100)
            page.evaluate("() => window.scrollTo(0, 2000)")
            playwright_api.expect(face).to_have_attribute("state", "resting", timeout=60_000)
            while page.request.get(f"{api}/{session}").json()["viewers"] > 0:
                assert time.monotonic() < deadline
                page.wait_for_timeout(100)
            page.evaluate("() => window.scrollTo(0, 0)")
            playwright_api.expect(face).to_have_attribute("state", "ready", timeout=60_000)
            gone = page.locator("#none")
            playwright_api.expect(gone).to_have_attribute("state", "waiting", timeout=60_000)
