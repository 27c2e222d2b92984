"""Commands to a face, one after another over a socket, without waiting for each one's answer."""

from __future__ import annotations

import json
import time
from contextlib import suppress
from typing import Any

from websockets.exceptions import WebSocketException
from websockets.sync.connection import Connection

from .client_error import ServiceError, said


class CommandStream:
    """Where commands go out that come many times a second, as a tracker's do.

    What the service says of a command is heard with one of the next. The last commands before the
    end may not take effect: give them a `ttl`, so that the face lets go by itself.
    """

    def __init__(self, socket: Connection) -> None:
        """Use a socket that is open; whoever opened it closes it."""
        self._socket = socket
        # One frame is acknowledged and no other, so that hardly any are sent.
        self._send({"type": "ack", "tick": 0})

    def set_controls(self, *, replace: bool = False, **controls: Any) -> list[str]:
        """Move what is named, as `Face.set_controls`; return the warnings heard since the last one.

        Raises:
            ServiceError: If an earlier command was refused, or the stream has ended.
        """
        return self._send({"type": "controls", **controls, "replace": replace})

    def set_emotion(self, label: str | None = None, **emotion: Any) -> list[str]:
        """Play an emotion, as `Face.set_emotion`; return the warnings heard since the last one.

        Raises:
            ServiceError: If an earlier command was refused, or the stream has ended.
        """
        named = {} if label is None else {"label": label}
        return self._send({"type": "emotion", **named, **emotion})

    def heard(self, seconds: float = 0.0) -> list[str]:
        """Return the warnings heard since they were returned last.

        Args:
            seconds: How long to listen for more.

        Raises:
            ServiceError: If an earlier command was refused, or the stream has ended.
        """
        warnings: list[str] = []
        end = time.monotonic() + seconds
        try:
            with suppress(TimeoutError):
                while True:
                    told = self._socket.recv(timeout=end - time.monotonic())
                    event = json.loads(told) if isinstance(told, str) else {}
                    if event.get("type") == "error":
                        raise said(0, event)
                    if event.get("type") == "warning":
                        warnings.append(event["message"])
        except WebSocketException as error:
            raise ended(error) from error
        return warnings

    def _send(self, message: dict[str, Any]) -> list[str]:
        try:
            self._socket.send(json.dumps(message))
        except WebSocketException as error:
            raise ended(error) from error
        return self.heard()


def ended(error: WebSocketException) -> ServiceError:
    """Return what a stream that has ended is."""
    return ServiceError(0, "stream_ended", f"the stream has ended: {error}", [])
