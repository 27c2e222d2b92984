"""A thread for long work that can wait: what was asked for last is done first."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any, TypeVar

from .priority import stand_back

T = TypeVar("T")
_Job = tuple[Future[Any], Callable[[], Any]]


class LatestFirst(Executor):
    """One thread that takes the newest job: somebody who has just arrived waits for it now.

    Args:
        name: Of the thread.
        most: How many jobs may wait; beyond it the one that waits longest is cancelled.
    """

    def __init__(self, name: str, *, most: int) -> None:
        self._most = most
        self._jobs: list[_Job] = []
        self._changed = threading.Condition()
        self._closed = False
        self._thread = threading.Thread(target=self._work, name=name, daemon=True)

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Take a job before those that wait.

        Raises:
            RuntimeError: After `shutdown`.
        """
        future: Future[T] = Future()
        with self._changed:
            if self._closed:
                raise RuntimeError("cannot schedule new futures after shutdown")
            self._jobs.append((future, lambda: fn(*args, **kwargs)))
            too_many, self._jobs = self._jobs[: -self._most], self._jobs[-self._most :]
            self._changed.notify()
            if not self._thread.is_alive():
                self._thread.start()
        for old, _ in too_many:
            old.cancel()
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more jobs; with `wait`, return when the last one has ended."""
        with self._changed:
            self._closed = True
            if cancel_futures:
                for future, _ in self._jobs:
                    future.cancel()
                self._jobs.clear()
            self._changed.notify()
        if wait and self._thread.is_alive():
            self._thread.join()

    def _work(self) -> None:
        stand_back()
        while (job := self._next()) is not None:
            future, make = job
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(make())
            except BaseException as error:
                future.set_exception(error)
            del future, make, job  # Else its result lives until the next one is done.

    def _next(self) -> _Job | None:
        with self._changed:
            self._changed.wait_for(lambda: self._jobs or self._closed)
            return self._jobs.pop() if self._jobs else None
