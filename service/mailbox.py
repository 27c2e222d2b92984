"""Questions to a thread: asked on the event loop, answered between two pieces of its work."""

from __future__ import annotations

import asyncio
import queue
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any, Generic, TypeVar

from .errors import Busy

Answer = TypeVar("Answer")


class _Question(Generic[Answer]):
    """A question, who waits for its answer, and how that is handed over."""

    def __init__(self, ask: Callable[[], Answer], loop: asyncio.AbstractEventLoop) -> None:
        self._ask = ask
        self.loop = loop
        self.future: asyncio.Future[Answer] = loop.create_future()
        self._hand_over: Callable[[], None] = self._refuse

    def answer(self) -> None:
        """Answer it, unless nobody waits any more; the asker is not told yet."""
        if self.future.cancelled():
            return
        try:
            self._hand_over = partial(self.future.set_result, self._ask())
        except Exception as error:
            self._hand_over = partial(self.future.set_exception, error)

    def tell(self) -> None:
        """Tell the asker, on his loop, what came of it; one that nobody answered is refused."""
        if not self.future.done():
            self._hand_over()

    def _refuse(self) -> None:
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
        question = _Question(ask, asyncio.get_running_loop())
        self._waiting.put(question)
        if self._ended.is_set():
            self._refuse_all()
        return await question.future

    def stop(self) -> None:
        """Have `answer_all` return False once all that was asked before is answered."""
        self._waiting.put(None)

    def answer_all(self, *, block: bool) -> bool:
        """Answer everything asked so far; with `block`, wait for a first question.

        Returns:
            Whether the thread is to go on.
        """
        answered: list[_Question[Any]] = []
        try:
            while True:
                try:
                    question = self._waiting.get(block=block)
                except queue.Empty:
                    return True
                if question is None:
                    return False
                answered.append(question)
                question.answer()
                block = False
        finally:
            _tell(answered)

    def end(self) -> None:
        """Refuse what waits and whatever comes; the thread calls it last."""
        # First the flag: who asks after it refuses himself.
        self._ended.set()
        self._refuse_all()

    def _refuse_all(self) -> None:
        refused: list[_Question[Any]] = []
        with suppress(queue.Empty):
            while True:
                question = self._waiting.get_nowait()
                if question is not None:
                    refused.append(question)
        _tell(refused)


def _tell(questions: Sequence[_Question[Any]]) -> None:
    """Have the loops of those who asked tell them, all at once.

    A loop that is woken wants the interpreter of the thread that woke it, which has a tick to step.
    """
    for loop in {question.loop for question in questions}:
        own = [question for question in questions if question.loop is loop]
        with suppress(RuntimeError):  # It is closed, and nobody waits any more.
            loop.call_soon_threadsafe(_tell_each, own)


def _tell_each(questions: Sequence[_Question[Any]]) -> None:
    for question in questions:
        question.tell()
