"""Sockets that frames are written to at once, and acknowledgements read from.

Both go sixty times a second: each through a task, a queue and a reader of JSON, two hundred viewers
of one face would take more than a core.
"""

from __future__ import annotations

import re
from asyncio import BaseTransport
from collections.abc import Callable

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame
from websockets.http11 import Request
from websockets.protocol import State

LINE = "risorius.line"
"""What the state of a socket's scope has its `Line` as; with another server it has none."""
_ACK = re.compile(rb'\{"type": ?"ack", ?"tick": ?(0|[1-9]\d{0,8})\}')
"""Acknowledgements in the form of nearly everybody; all others, of which bounds are to be checked
too, take the long way."""
_BINARY = 0x82
_SHORT, _MEDIUM = 126, 0x10000


class Line(WebSocketsSansIOProtocol):
    """A WebSocket of the server that frames can be written to at once.

    Attributes:
        on_ack: Told the tick of each acknowledgement, once it is set.
    """

    on_ack: Callable[[int], None] | None = None

    @property
    def is_free(self) -> bool:
        """Whether all that was sent before is on its way, and more may be sent."""
        return (
            self.handshake_complete
            and not self.close_sent
            and self.conn.state is State.OPEN
            and not self.transport.is_closing()
            and not self.transport.get_write_buffer_size()
        )

    def write(self, data: bytes) -> None:
        """Send a binary message over a line that is free."""
        self.transport.write(_head(len(data)) + data)

    def connection_made(self, transport: BaseTransport) -> None:
        """Begin, with nothing kept back here but what the system did not take of one message."""
        super().connection_made(transport)
        self.transport.set_write_buffer_limits(high=0)

    def handle_connect(self, event: Request) -> None:
        """Begin, with the line in the scope."""
        super().handle_connect(event)
        if not self.close_sent:
            self.scope["state"][LINE] = self

    def handle_text(self, event: Frame) -> None:
        """Take a message; an acknowledgement is done with at once."""
        if self.on_ack is not None and event.fin:
            found = _ACK.fullmatch(event.data)
            if found is not None:
                self.on_ack(int(found[1]))
                return
        super().handle_text(event)


def _head(size: int) -> bytes:
    """Return what goes before a binary message that is not masked (RFC 6455, section 5.2)."""
    if size < _SHORT:
        return bytes((_BINARY, size))
    if size < _MEDIUM:
        return bytes((_BINARY, 126)) + size.to_bytes(2, "big")
    return bytes((_BINARY, 127)) + size.to_bytes(8, "big")
