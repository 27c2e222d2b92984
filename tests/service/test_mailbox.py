"""Questions to a thread: answered in order, told of at once, and nobody waits in vain."""

import asyncio
import threading
from collections.abc import Awaitable, Callable
from functools import partial
from unittest import mock

import pytest

from service.errors import Busy
from service.mailbox import Mailbox


def run(test: Callable[[Mailbox], Awaitable[None]]) -> int:
    """Run a test on a loop of its own; return how often another thread woke that."""

    async def main() -> int:
        loop = asyncio.get_running_loop()
        with mock.patch.object(
            loop, "call_soon_threadsafe", wraps=loop.call_soon_threadsafe
        ) as waking:
            await test(Mailbox())
        return waking.call_count

    return asyncio.run(main())


async def asked(mailbox: Mailbox, *questions: Callable[[], object]) -> list[asyncio.Task[object]]:
    tasks = [asyncio.create_task(mailbox.ask(question)) for question in questions]
    await asyncio.sleep(0)
    return tasks


def answer_elsewhere(mailbox: Mailbox) -> bool:
    """Answer what waits on another thread, and wait for that."""
    goes_on: list[bool] = []
    thread = threading.Thread(target=lambda: goes_on.append(mailbox.answer_all(block=False)))
    thread.start()
    thread.join()
    return goes_on[0]


def test_a_storm_of_questions_wakes_the_loop_once() -> None:
    async def test(mailbox: Mailbox) -> None:
        order: list[int] = []

        def note(number: int) -> int:
            order.append(number)
            return number

        tasks = await asked(mailbox, *(partial(note, number) for number in range(20)))
        assert answer_elsewhere(mailbox)
        assert await asyncio.gather(*tasks) == list(range(20)) == order

    assert run(test) == 1


def test_what_goes_wrong_goes_to_who_asked_alone() -> None:
    async def test(mailbox: Mailbox) -> None:
        wrong, right = await asked(mailbox, lambda: 1 / 0, lambda: "well")
        answer_elsewhere(mailbox)
        with pytest.raises(ZeroDivisionError):
            await wrong
        assert await right == "well"

    run(test)


def test_who_went_away_is_not_answered() -> None:
    async def test(mailbox: Mailbox) -> None:
        done: list[str] = []
        gone, there = await asked(
            mailbox, lambda: done.append("gone"), lambda: done.append("there")
        )
        gone.cancel()
        await asyncio.sleep(0)
        answer_elsewhere(mailbox)
        await there
        assert done == ["there"]

    run(test)


def test_who_goes_away_while_answered_does_no_harm() -> None:
    async def test(mailbox: Mailbox) -> None:
        gone, there = await asked(mailbox, lambda: 1, lambda: 2)
        answer_elsewhere(mailbox)
        gone.cancel()
        assert await there == 2

    run(test)


def test_what_waits_behind_the_end_is_refused() -> None:
    async def test(mailbox: Mailbox) -> None:
        (first,) = await asked(mailbox, lambda: 1)
        mailbox.stop()
        (second,) = await asked(mailbox, lambda: 2)
        assert not answer_elsewhere(mailbox)
        mailbox.end()
        (third,) = await asked(mailbox, lambda: 3)
        assert await first == 1
        for task in (second, third):
            with pytest.raises(Busy, match="restart the service"):
                await task

    run(test)
