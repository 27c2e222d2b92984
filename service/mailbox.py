"""Questions to a thread: asked on the event loop, answered between two pieces of its work."""

from __future__ import annotations

import asyncio
import queue
import threading
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from typing import Any, Generic, TypeVar

from .errors import Busy

Answer = TypeVar("Answer")


class _Question(Generic[Answer]):
    """A question and the place for its answer."""

    def __init__(self, ask: Callable[[], Answer]) -> None:
        self._ask = ask
        self.future: Future[Answer] = Future()

    def answer(self) -> None:
        """Answer it; whatever goes wrong goes to the asker."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            self.future.set_result(self._ask())
        except Exception as error:
            self.future.set_exception(error)

    def refuse(self) -> None:
        """Tell the asker that nobody answers any more."""
        if self.future.set_running_or_notify_cancel():
            message = "the simulation has stopped; restart the service, whose log says why"
            self.future.set_exception(Busy("simulation_stopped", message, retry_after=10))


class Mailbox:
    """What waits for one thread; nobody waits in vain for a thread that has ended."""

    def __init__(self) -> None:
        self._waiting: queue.SimpleQueue[_Question[Any] | None] = queue.SimpleQueue()
        self._ended = threading.Event()

    async def ask(self, ask: Callable[[], Answer]) -> Answer:
        """Have the thread call `ask`, and return what it returns.

        Raises:
            Busy: If the thread has ended.
        """
        question = _Question(ask)
        self._waiting.put(question)
        if self._ended.is_set():
            self._refuse_all()
        return await asyncio.wrap_future(question.future)

    def stop(self) -> None:
        """Have `answer_all` return False once all that was asked before is answered."""
        self._waiting.put(None)

    def answer_all(self, *, block: bool) -> bool:
        """Answer everything asked so far; with `block`, wait for a first question.

        Returns:
            Whether the thread is to go on.
        """
        while True:
            try:
                question = self._waiting.get(block=block)
            except queue.Empty:
                return True
            if question is None:
                return False
            question.answer()
            block = False

    def end(self) -> None:
        """Refuse what waits and whatever comes; the thread calls it last."""
        # First the flag: who asks after it refuses himself.
        self._ended.set()
        self._refuse_all()

    def _refuse_all(self) -> None:
        with suppress(queue.Empty):
            while True:
                question = self._waiting.get_nowait()
                if question is not None:
                    question.refuse()
