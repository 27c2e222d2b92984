"""A face on the viewer's page in headless Chromium, put as it is wanted and photographed.

The page has its rig, surface and maps from a service; its frames come from here, so that it shows
any moment of any performance, and none is waited for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from engine import Frame, JawHinge

from .protocol import encode_frame, surface_frame

if TYPE_CHECKING:
    from playwright.sync_api import Browser, FloatRect, Page, WebSocketRoute

CLOSE_UPS = ("eye", "mouth", "ear")
VIEWS = ("front", "three-quarter", "profile", "left", *CLOSE_UPS)
NOT_BUILT = "The viewer is not built: run `npm ci && npm run build` in static/."
TIMEOUT_MS = 240_000
"""A first picture waits until the person's maps are baked."""
ROOM = 1.34
"""Side of the page against a picture's: the page frames the whole head, a picture its face."""
ABOVE = 0.12
"""Share of the page above a picture: the hair."""
_NO_CONTENT = 204
_SHOWN = """t => window.__viewer.ready && window.__viewer.textured !== false
    && window.__viewer.tick === t"""
_SIZED = "side => document.getElementById('face').width === side"
_STREAM = "**/api/sessions/*/stream*"
THEMES = ("dark", "light")


class CallRefused(Exception):
    """The service refused what a picture needs; the message is its own."""


@dataclass(frozen=True)
class Look:
    """How a face is photographed.

    Attributes:
        view: One of `VIEWS`, or degrees to the side.
        size: Side of the picture [pixels].
        whole: Show the head with its hair and neck, not the face alone.
        theme: One of `THEMES`.
    """

    view: str = "front"
    size: int = 512
    whole: bool = False
    theme: str = "dark"

    @property
    def side(self) -> int:
        """Side of the page that holds the picture [pixels]."""
        full = self.whole or self.view in CLOSE_UPS
        return self.size if full else round(self.size * ROOM)

    @property
    def frame(self) -> FloatRect:
        """Part of the page that is the picture: all, or from hairline to chin."""
        spare = self.side - self.size
        above = ABOVE * self.side if spare else 0.0
        return {"x": spare // 2, "y": round(above), "width": self.size, "height": self.size}


class Stage:
    """One page, which shows one rig at a time."""

    def __init__(self, browser: Browser, url: str) -> None:
        self._url = url
        self._page: Page = browser.new_page()
        self._page.set_default_timeout(TIMEOUT_MS)
        self._page.route_web_socket(_STREAM, self._take_socket)
        self._socket: WebSocketRoute | None = None
        self._session = ""
        self._rig = ""
        self._tick = 0

    def enter(self, rig: str) -> None:
        """Show a rig by its name or id, at rest.

        Raises:
            CallRefused: If the service does not have it.
        """
        if rig == self._rig:
            return
        self._rig = ""
        if self._session:
            # The page first: it would open a session anew when its own is gone.
            self._page.goto("about:blank")
            call(self._page, "DELETE", f"{self._url}/api/sessions/{self._session}")
        self._session = call(self._page, "POST", f"{self._url}/api/sessions", {"rig": rig})["id"]
        self._socket, self._tick = None, 0
        self._page.goto(f"{self._url}/?session={self._session}&bare=1&still=1&dpr=1")
        self._page.wait_for_function("() => window.__viewer.connected")
        self._rig = rig

    def derive(self, root: str, steps: Sequence[Mapping[str, Any]]) -> str:
        """Return the id of what `steps` make of a named rig, one after another.

        Raises:
            CallRefused: If one cannot be made.
        """
        for step in steps:
            changes = {name: value for name, value in step.items() if value is not None}
            root = call(self._page, "POST", f"{self._url}/api/rigs", {**changes, "base": root})[
                "id"
            ]
        return root

    def photograph(self, frame: Frame, jaw: JawHinge, look: Look) -> bytes:
        """Return a PNG file of a face as `frame` has it."""
        page = self._page
        page.set_viewport_size({"width": look.side, "height": look.side})
        assert self._socket is not None, "a rig is shown first"
        self._tick += 1
        shown = surface_frame(replace(frame, tick=self._tick, asleep=True), jaw)
        self._socket.send(encode_frame(shown))
        page.wait_for_function(_SHOWN, arg=self._tick)
        page.wait_for_function(_SIZED, arg=look.side)
        page.evaluate("ground => window.__viewer.setGround(ground)", look.theme)
        page.evaluate("view => window.__viewer.setView(view)", look.view)
        page.evaluate("() => window.__viewer.render()")
        return page.screenshot(clip=look.frame)

    def _take_socket(self, route: WebSocketRoute) -> None:
        """Let the service greet the page, and keep its frames from it."""
        server = route.connect_to_server()

        def pass_text(message: str | bytes) -> None:
            if isinstance(message, str):
                with suppress(Exception):  # The page has gone to another rig.
                    route.send(message)

        server.on_message(pass_text)
        self._socket = route


def call(page: Page, method: str, url: str, body: dict[str, Any] | None = None) -> Any:
    """Return what the service answers to a call.

    Raises:
        CallRefused: If it refuses.
    """
    answer = page.request.fetch(url, method=method, data=body, timeout=TIMEOUT_MS)
    content: Any = answer.json() if answer.status != _NO_CONTENT else None
    if not answer.ok:
        raise CallRefused(content["message"])
    return content
