"""What goes wrong is said, and what can come back does."""

from __future__ import annotations

import re

import pytest
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser
PAGE = "?idle=0&level=low&dpr=0.5&draw=sketch"
expect = playwright_api.expect
NO_WEBGL = "This browser cannot draw the face: it has no WebGL 2."


def sessions(page: playwright_api.Page, url: str) -> set[str]:
    """Return the ids of all that are open; those that other tests left end when they end."""
    return {each["id"] for each in page.request.get(f"{url}/api/sessions").json()["sessions"]}


def test_a_browser_without_webgl_is_told_and_leaves_no_session_behind(
    browser: playwright_api.Browser, url: str
) -> None:
    page = browser.new_page()
    methods: list[str] = []
    page.on("requestfinished", lambda request: methods.append(request.method))
    try:
        before = sessions(page, url)
        page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
        page.goto(f"{url}/{PAGE}")
        expect(page.locator("#curtain")).to_have_text(NO_WEBGL)
        for _ in range(600):
            if "DELETE" in methods:
                break
            page.wait_for_timeout(100)
        assert methods.count("POST") == methods.count("DELETE") == 1
        assert sessions(page, url) <= before
    finally:
        page.close()


def test_an_embed_without_webgl_says_so_to_the_page_around(
    browser: playwright_api.Browser, url: str
) -> None:
    page = browser.new_page()
    try:
        page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
        html = "<risorius-face></risorius-face><script type=module src=/embed.js></script>"
        page.route("**/a-chat", lambda route: route.fulfill(content_type="text/html", body=html))
        page.goto(f"{url}/a-chat")
        expect(page.locator("risorius-face")).to_have_attribute("state", "closed", timeout=30_000)
    finally:
        page.close()


def test_an_embed_says_once_what_is_refused_for_good_and_tries_again_what_passes(
    browser: playwright_api.Browser, url: str
) -> None:
    page = browser.new_page()
    asked: list[str] = []

    def answer(route: playwright_api.Route) -> None:
        rig = route.request.post_data_json["rig"]
        asked.append(rig)
        if rig == "nobody":
            route.fallback()
            return
        full = {"error": "at_capacity", "message": "start more of them"}
        route.fulfill(status=429, headers={"Retry-After": "1"}, json=full)

    try:
        html = """<risorius-face rig=nobody></risorius-face>
        <risorius-face rig=amara></risorius-face><script>
        addEventListener('face', ({target, detail}) => target.words = detail.words, true)</script>
        <script type=module src=/embed.js></script>"""
        page.route("**/a-chat", lambda route: route.fulfill(content_type="text/html", body=html))
        page.route("**/api/sessions", answer)
        page.goto(f"{url}/a-chat")
        gone, full = page.locator("risorius-face").all()
        expect(gone).to_have_attribute("state", "closed", timeout=30_000)
        expect(full).to_have_attribute("state", "waiting", timeout=30_000)
        assert "nobody" in gone.evaluate("face => face.words")
        assert full.evaluate("face => face.words") == "start more of them"
        inside = [face.frame_locator("iframe").locator("#curtain p") for face in (gone, full)]
        expect(inside[0]).to_have_text("This face is not here.")
        expect(inside[1]).to_have_text("No face is free just now. One moment, please.")
        for _ in range(300):
            if asked.count("amara") > 2:
                break
            page.wait_for_timeout(100)
        assert asked.count("amara") > 2
        assert asked.count("nobody") == 1
    finally:
        page.close()


def test_a_face_that_was_not_given_at_once_is_asked_for_again(
    page: playwright_api.Page, url: str
) -> None:
    refused: list[str] = []

    def refuse_once(route: playwright_api.Route) -> None:
        address = route.request.url.split("?")[0]
        if address in refused:
            route.fallback()
            return
        refused.append(address)
        route.fulfill(status=503, json={"error": "busy", "message": "try again"})

    page.route("**/surface.glb*", refuse_once)
    page.route(re.compile(r"/api/rigs/[0-9a-f]+$"), refuse_once)
    page.goto(f"{url}/{PAGE}")
    settle(page)
    assert len(refused) == 2


def test_a_service_of_another_version_is_told_apart(page: playwright_api.Page, url: str) -> None:
    def refuse(socket: playwright_api.WebSocketRoute) -> None:
        socket.close(code=1002, reason="this service speaks risorius.v9 only")

    page.set_viewport_size({"width": 1200, "height": 800})
    page.route_web_socket("**/stream*", refuse)
    page.goto(f"{url}/{PAGE}")
    expect(page.get_by_role("alert")).to_contain_text("risorius.v9 only")
    expect(page.locator(".status")).to_contain_text("Disconnected")


def test_a_lost_network_is_told_and_found_again(page: playwright_api.Page, url: str) -> None:
    page.set_viewport_size({"width": 1200, "height": 800})
    sockets: list[playwright_api.WebSocketRoute] = []

    def keep(socket: playwright_api.WebSocketRoute) -> None:
        socket.connect_to_server()
        sockets.append(socket)

    page.route_web_socket("**/stream*", keep)
    page.goto(f"{url}/{PAGE}")
    settle(page)
    session = page.evaluate("() => window.__viewer.session")
    page.context.set_offline(True)
    sockets[-1].close()
    expect(page.locator(".status")).to_contain_text("Reconnecting")
    page.context.set_offline(False)
    page.wait_for_function("() => window.__viewer.connected")
    assert page.evaluate("() => window.__viewer.session") == session
