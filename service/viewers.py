"""One socket's slot: the newest frame and a few events wait in it, never a queue of frames."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

_EVENTS_KEPT = 64
# Frames that a viewer who acknowledges may have unread at once.
_WINDOW = 2

Write = Callable[[], bool]


class Viewer:
    """What waits for one viewer. A slow one misses frames and delays nobody.

    Attributes:
        packed: Whether it asked for packed frames.
        base: Tick of the frame that it was sent before the last one it was allowed, None for none.
        skipped: Frames that it missed.
        ended: Code and reason with which its socket is to be closed.
    """

    def __init__(self, *, packed: bool = False) -> None:
        self.packed = packed
        self.base: int | None = None
        self._sent: int | None = None
        self._drawn: int | None = None
        self._news = asyncio.Event()
        self._events: deque[Mapping[str, Any]] = deque(maxlen=_EVENTS_KEPT)
        self._frame_waits = True
        self._acknowledges = False
        self._unread: deque[int] = deque(maxlen=_WINDOW)
        self.skipped = 0
        self.ended: tuple[int, str] | None = None
        self._write: Write | None = None
        self._sending = True
        self._news.set()

    def write_by(self, write: Write) -> None:
        """Have frames written as soon as there are any.

        Args:
            write: Sends the newest frame, if that can be done at once, and tells whether it was.
                Before it does, it asks `take_frame`.
        """
        self._write = write

    def offer_frame(self) -> None:
        """Tell it that there is a newer frame; an older one that still waits is skipped."""
        self.skipped += self._frame_waits
        self._frame_waits = True
        self._go_on()

    def repeat_frame(self, tick: int, *, asleep: bool) -> None:
        """Have it be whole again, whatever was lost or not acknowledged.

        The latest frame of a face that is `asleep`, that of `tick`, is sent again, unless the
        viewer has said that it drew it; where the face is awake the next one comes, and whole.
        """
        if asleep and self._drawn == tick:
            return
        self._unread.clear()
        self._sent = None
        self._frame_waits |= asleep
        self._news.set()

    def offer(self, event: Mapping[str, Any]) -> None:
        """Leave an event; a state that still waits is replaced by a newer one."""
        if event["type"] == "state":
            kept = [waiting for waiting in self._events if waiting["type"] != "state"]
            self._events = deque(kept, maxlen=_EVENTS_KEPT)
        self._events.append(event)
        self._news.set()

    def acknowledge(self, tick: int) -> None:
        """Note that the viewer has drawn the frame of `tick`."""
        self._acknowledges = True
        self._drawn = tick
        while self._unread and (tick - self._unread[0]) % 2**32 < 2**31:
            self._unread.popleft()
        if self._frame_waits:
            self._go_on()

    def end(self, code: int, reason: str) -> None:
        """Have the socket closed."""
        self.ended = (code, reason)
        self._news.set()

    async def wait(self) -> None:
        """Wait until there is something to send."""
        self._sending = False
        await self._news.wait()
        self._sending = True
        self._news.clear()

    def take_events(self) -> list[Mapping[str, Any]]:
        """Return the events that wait."""
        events = list(self._events)
        self._events.clear()
        return events

    @property
    def may_have_frame(self) -> bool:
        """Whether a frame waits that may go out now."""
        return self._frame_waits and not (self._acknowledges and len(self._unread) >= _WINDOW)

    def take_frame(self, tick: int) -> bool:
        """Tell whether the frame of `tick` may go out now; it then counts as sent."""
        if not self.may_have_frame:
            return False
        self._frame_waits = False
        self.base, self._sent = self._sent, tick
        self._unread.append(tick)
        return True

    def _go_on(self) -> None:
        """Have the frame that waits sent: at once, or by who waits for news, who else may be busy.

        What is told in between must not overtake a frame that is on its way already.
        """
        if not self.may_have_frame:
            return  # An acknowledgement comes first.
        if self._sending or self._news.is_set() or self._write is None or not self._write():
            self._news.set()
