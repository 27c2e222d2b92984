"""Values that are slow to make: each is made once, however many ask, and the latest are kept."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Generic, TypeVar

from .errors import Busy

Value = TypeVar("Value")
_RETRY_SECONDS = 10
"""After which somebody whose value was not made may ask again: about as long as a bake takes."""


class Shelf(Generic[Value]):
    """A bounded memory of values by key, made in a thread pool."""

    def __init__(self, size: int, pool: Executor) -> None:
        self._size = size
        self._pool = pool
        self._tasks: OrderedDict[str, asyncio.Future[Value]] = OrderedDict()

    def __contains__(self, key: str) -> bool:
        """Whether the value of `key` is there, or being made."""
        return key in self._tasks

    def put(self, key: str, value: Value) -> None:
        """Keep a value that was made elsewhere."""
        done: asyncio.Future[Value] = asyncio.get_running_loop().create_future()
        done.set_result(value)
        self._keep(key, done)

    async def get(self, key: str, make: Callable[[], Value]) -> Value:
        """Return the value of `key`; `make` it in the pool when nobody has.

        A failure is handed to everybody who waits, and not kept.

        Raises:
            Busy: If the pool had too much to do to make it.
        """
        task = self.begin(key, make)
        try:
            # Shielded: one asker who leaves must not cancel it for the others.
            return await asyncio.shield(task)
        except asyncio.CancelledError:
            if not task.cancelled():
                raise
            message = "too many others asked for what takes long; ask for it again"
            raise Busy("too_much_to_make", message, retry_after=_RETRY_SECONDS) from None

    def begin(self, key: str, make: Callable[[], Value]) -> asyncio.Future[Value]:
        """Have the value of `key` made in the pool, if nobody has; return its future."""
        task = self._tasks.get(key)
        if task is None:
            task = asyncio.get_running_loop().run_in_executor(self._pool, make)
            self._keep(key, task)
            task.add_done_callback(lambda done: self._drop_failed(key, done))
        else:
            self._tasks.move_to_end(key)
        return task

    def _keep(self, key: str, task: asyncio.Future[Value]) -> None:
        self._tasks[key] = task
        self._tasks.move_to_end(key)
        for old, kept in list(self._tasks.items()):
            if len(self._tasks) <= self._size:
                return
            if kept.done():
                del self._tasks[old]

    def _drop_failed(self, key: str, task: asyncio.Future[Value]) -> None:
        if (task.cancelled() or task.exception()) and self._tasks.get(key) is task:
            del self._tasks[key]
