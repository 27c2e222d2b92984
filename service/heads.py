"""HEAD of every file that GET gives: how long it is and its checksum, without its bytes.

Whoever fetches many files asks first which of them changed. Routes know GET alone, and a stream of
events has no end to wait for, so this is for addresses that end as files do.
"""

from __future__ import annotations

from starlette.types import ASGIApp, Message, Receive, Scope, Send

_FILES = (".glb", ".png", ".csv", ".json")
_RENDERED = "/recording.glb"
"""A clip is rendered for it, and forgotten with the answer: that is no question."""


class Heads:
    """The middleware, right in front of the routes."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have HEAD of a file answered as GET is, and keep its bytes back."""
        path = str(scope.get("path", ""))
        if scope.get("method") != "HEAD" or not _is_file(path):
            await self.app(scope, receive, send)
            return

        async def without_body(message: Message) -> None:
            if message["type"] == "http.response.body":
                if message.get("more_body", False):
                    return
                message = {"type": "http.response.body", "body": b""}
            await send(message)

        await self.app({**scope, "method": "GET"}, receive, without_body)


def _is_file(path: str) -> bool:
    return path.startswith("/api/") and path.endswith(_FILES) and not path.endswith(_RENDERED)
