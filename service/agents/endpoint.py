"""The address of the Model Context Protocol: what answers there is made when it is first asked."""

from __future__ import annotations

import asyncio
from types import ModuleType
from typing import TYPE_CHECKING

from starlette.types import Receive, Scope, Send

from ..components import Components
from ..errors import Busy, error_body, json_response

if TYPE_CHECKING:
    from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

PATHS = ("/mcp", "/mcp/")
_READY_SECONDS = 25.0
"""Waited for a service that has just been started; clients wait for half a minute or more."""


class McpEndpoint:
    """An ASGI application for `PATHS`.

    The protocol's package is imported at the first request, in a thread: a start does not wait for
    it, and neither do live faces.
    """

    def __init__(self) -> None:
        self._manager: StreamableHTTPSessionManager | None = None
        self._serving: asyncio.Task[None] | None = None
        self._starting = asyncio.Lock()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one message.

        Raises:
            Busy: If the service is not ready in time.
        """
        if scope["method"] != "POST":
            # Nothing is sent unasked and nothing is kept, so there is no stream, nor a session.
            body = error_body("method_not_allowed", "MCP clients send POST there: streamable HTTP")
            await json_response(body, status=405, headers={"Allow": "POST"})(scope, receive, send)
            return
        async with self._starting:
            manager = self._manager or await self._start(scope["app"].state.parts)
        await manager.handle_request(scope, receive, send)

    async def stop(self) -> None:
        """End what is being answered."""
        if self._serving is not None:
            self._serving.cancel()
            await asyncio.gather(self._serving, return_exceptions=True)
        self._manager = self._serving = None

    async def _start(self, parts: Components) -> StreamableHTTPSessionManager:
        try:
            await asyncio.wait_for(parts.ready.wait(), _READY_SECONDS)
        except TimeoutError:
            raise Busy("not_ready", f"the service is {parts.stage}", retry_after=5) from None
        rig = await parts.rigs.get("standard")
        protocol = await asyncio.to_thread(_protocol)
        manager: StreamableHTTPSessionManager = protocol.manager_of(parts, rig)
        started = asyncio.Event()
        self._serving = asyncio.create_task(_serve(manager, started), name="mcp")
        await started.wait()
        self._manager = manager
        return manager


async def _serve(manager: StreamableHTTPSessionManager, started: asyncio.Event) -> None:
    """Run a manager in a task of its own, as it asks for, until that is cancelled."""
    async with manager.run():
        started.set()
        await asyncio.Event().wait()


def _protocol() -> ModuleType:
    from . import protocol

    return protocol
