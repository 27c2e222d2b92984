"""Viewers that cost next to nothing: they count frames, acknowledge them, and decode none."""

from __future__ import annotations

import asyncio
import struct
import urllib.parse
from typing import cast

from ..protocol import SUBPROTOCOL

_BINARY = 2
_KEY = "cmlzb3JpdXMtdmlld2VyIQ=="
"""Sixteen bytes, as the handshake wants; nobody checks the answer."""


class Onlooker(asyncio.Protocol):
    """One socket on a face.

    Attributes:
        frames: Binary frames that came.
        bytes: That came in all.
        tick: Of the latest frame.
        closed: Whether the service has ended it.
    """

    def __init__(self, host: str, stream: str) -> None:
        self._request = (
            f"GET {stream}?frames=packed HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {_KEY}\r\n"
            f"Sec-WebSocket-Protocol: {SUBPROTOCOL}\r\n\r\n"
        )
        self._rest = b""
        self._open = False
        self.frames = self.bytes = 0
        self.tick = -1
        self.closed = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for the stream."""
        self._transport = cast(asyncio.Transport, transport)
        self._transport.write(self._request.encode("ascii"))

    def connection_lost(self, exc: Exception | None) -> None:
        """Take notice."""
        self.closed = True

    def data_received(self, data: bytes) -> None:
        """Count what came, and acknowledge the newest frame in it."""
        self.bytes += len(data)
        data = self._rest + data
        start = 0
        if not self._open:
            start = data.find(b"\r\n\r\n") + 4
            if start < 4:
                self._rest = data
                return
            self._open = True
        tick = None
        while (found := _frame_at(data, start)) is not None:
            kind, payload, start = found
            if kind == _BINARY:
                self.frames += 1
                (tick,) = struct.unpack_from("<I", data, payload + 4)
        self._rest = data[start:]
        if tick is not None:
            self.tick = tick
            self._transport.write(_masked(b'{"type":"ack","tick":%d}' % tick))

    def pause(self) -> None:
        """Read no more, as a page does whose machine sleeps."""
        self._transport.pause_reading()

    def go_on(self) -> None:
        """Read again."""
        self._transport.resume_reading()

    def leave(self) -> None:
        """Close the socket."""
        self._transport.abort()


def _frame_at(data: bytes, start: int) -> tuple[int, int, int] | None:
    """Return opcode, start and end of the payload of a frame; None if it is not all there."""
    if len(data) < start + 4:
        return None
    length, payload = data[start + 1] & 127, start + 2
    if length == 126:
        length, payload = struct.unpack_from(">H", data, payload)[0], payload + 2
    elif length == 127:
        if len(data) < payload + 8:
            return None
        length, payload = struct.unpack_from(">Q", data, payload)[0], payload + 8
    end = payload + length
    return None if len(data) < end else (data[start] & 15, payload, end)


def _masked(text: bytes) -> bytes:
    """Return a text frame under a mask of zeros, which leaves it as it is."""
    return b"\x81" + bytes([0x80 | len(text)]) + b"\0\0\0\0" + text


async def onlooker(url: str, stream: str) -> Onlooker:
    """Return a viewer of a face.

    Args:
        url: Of the service.
        stream: Path of the stream.
    """
    place = urllib.parse.urlsplit(url)
    loop = asyncio.get_running_loop()
    _, made = await loop.create_connection(
        lambda: Onlooker(place.netloc, stream), place.hostname or "127.0.0.1", place.port or 80
    )
    return made
