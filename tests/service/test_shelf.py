"""The shelf: each value made once; what there was no time to make is made when asked for again."""

from __future__ import annotations

import asyncio
import threading

import pytest

from service.errors import Busy
from service.latest_first import LatestFirst
from service.shelf import Shelf


def wait(started: threading.Event, go: threading.Event) -> str:
    started.set()
    return str(go.wait(5))


def test_what_was_left_out_is_refused_and_made_when_asked_for_again() -> None:
    async def scene() -> list[str]:
        pool, go, started = LatestFirst("test", most=1), threading.Event(), threading.Event()
        shelf: Shelf[str] = Shelf(4, pool)
        running = asyncio.create_task(shelf.get("first", lambda: wait(started, go)))
        assert await asyncio.to_thread(started.wait, 5)
        waiting = asyncio.create_task(shelf.get("second", lambda: "made"))
        await asyncio.sleep(0)  # It is asked for.
        shelf.begin("third", lambda: "newest")
        with pytest.raises(Busy) as refused:
            await waiting
        assert int(refused.value.headers["Retry-After"]) > 0
        go.set()
        made = [await running, await shelf.get("second", lambda: "made")]
        pool.shutdown()
        return made

    assert asyncio.run(scene()) == ["True", "made"]


def test_somebody_who_leaves_cancels_it_for_nobody() -> None:
    async def scene() -> str:
        pool, go, started = LatestFirst("test", most=1), threading.Event(), threading.Event()
        shelf: Shelf[str] = Shelf(4, pool)
        leaving = asyncio.create_task(shelf.get("it", lambda: wait(started, go)))
        assert await asyncio.to_thread(started.wait, 5)
        leaving.cancel()
        with pytest.raises(asyncio.CancelledError):
            await leaving
        go.set()
        value = await shelf.get("it", lambda: "made twice")
        pool.shutdown()
        return value

    assert asyncio.run(scene()) == "True"
