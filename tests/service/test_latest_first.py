"""The thread of long work: newest first, failures handed on, closed without what waits."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import pytest

from service.latest_first import LatestFirst


def test_what_was_asked_last_is_done_first() -> None:
    pool, go, done = LatestFirst("test", most=3), threading.Event(), []
    started = threading.Event()
    pool.submit(lambda: (started.set(), go.wait()))
    assert started.wait(5)
    waiting = [pool.submit(done.append, number) for number in range(3)]
    go.set()
    for future in waiting:
        future.result(5)
    assert done == [2, 1, 0]
    pool.shutdown()


def test_a_failure_is_handed_on_and_the_thread_lives() -> None:
    pool = LatestFirst("test", most=3)
    with pytest.raises(ZeroDivisionError):
        pool.submit(lambda: 1 // 0).result(5)
    assert pool.submit(lambda: 2).result(5) == 2
    pool.shutdown()


def test_closing_ends_what_runs_and_cancels_what_waits() -> None:
    pool, go, started = LatestFirst("test", most=3), threading.Event(), threading.Event()
    running = pool.submit(lambda: (started.set(), go.wait(5)))
    assert started.wait(5)
    waiting = pool.submit(lambda: 1)
    threading.Timer(0.1, go.set).start()
    pool.shutdown(cancel_futures=True)
    assert running.done()
    with pytest.raises(CancelledError):
        waiting.result(0)
    with pytest.raises(RuntimeError):
        pool.submit(lambda: 1)


def test_what_waits_longest_makes_room_for_the_newest() -> None:
    pool, go, done = LatestFirst("test", most=2), threading.Event(), []
    started = threading.Event()
    pool.submit(lambda: (started.set(), go.wait()))
    assert started.wait(5)
    waiting = [pool.submit(done.append, number) for number in range(5)]
    assert [future.cancelled() for future in waiting] == [True, True, True, False, False]
    go.set()
    pool.shutdown()
    assert done == [4, 3]


def test_closing_one_that_never_worked_does_nothing() -> None:
    LatestFirst("test", most=3).shutdown()
