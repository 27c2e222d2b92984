"""A viewer's slot: the newest frame only, and a window for those who acknowledge."""

from __future__ import annotations

import asyncio

from service.viewers import Viewer


def test_only_the_newest_frame_waits() -> None:
    viewer = Viewer()
    viewer.take_frame(0)
    for _ in range(100):
        viewer.offer_frame()
    assert viewer.skipped == 99
    assert viewer.take_frame(100)
    assert not viewer.take_frame(100)


def test_the_window_holds_two_frames() -> None:
    viewer = Viewer()
    assert viewer.take_frame(1)
    viewer.acknowledge(1)
    for tick in (2, 3):
        viewer.offer_frame()
        assert viewer.take_frame(tick)
    viewer.offer_frame()
    assert not viewer.take_frame(4)
    viewer.acknowledge(2)
    assert viewer.take_frame(4)


def test_an_old_tick_acknowledges_nothing_and_a_wrapped_one_does() -> None:
    viewer = Viewer()
    viewer.acknowledge(0)
    viewer.take_frame(2**32 - 1)
    viewer.offer_frame()
    viewer.take_frame(2)
    viewer.offer_frame()
    viewer.acknowledge(2**32 - 10)
    assert not viewer.take_frame(3)
    viewer.acknowledge(2)
    assert viewer.take_frame(3)


def test_a_repeat_opens_the_window() -> None:
    viewer = Viewer()
    viewer.acknowledge(0)
    for tick in (1, 2):
        viewer.offer_frame()
        assert viewer.take_frame(tick)
    viewer.offer_frame()
    assert not viewer.take_frame(3)
    viewer.repeat_frame(2, asleep=True)
    assert viewer.take_frame(3)


def test_nothing_is_repeated_to_a_viewer_that_drew_the_frame_of_a_face_that_sleeps() -> None:
    viewer = Viewer()
    assert viewer.take_frame(5)
    viewer.repeat_frame(5, asleep=True)
    assert viewer.take_frame(5)
    viewer.acknowledge(5)
    viewer.repeat_frame(5, asleep=True)
    assert not viewer.take_frame(5)


def test_a_repeat_of_a_face_that_moves_waits_for_its_next_frame_and_has_it_whole() -> None:
    viewer = Viewer(packed=True)
    bases = []
    for tick in (1, 2, 3, 4):
        if tick == 3:
            viewer.repeat_frame(2, asleep=False)
            assert not viewer.take_frame(2)
        viewer.offer_frame()
        assert viewer.take_frame(tick)
        bases.append(viewer.base)
    assert bases == [None, 1, None, 3]


def test_a_newer_state_replaces_an_older_one() -> None:
    viewer = Viewer()
    viewer.offer({"type": "state", "tick": 1})
    viewer.offer({"type": "error"})
    viewer.offer({"type": "state", "tick": 2})
    assert viewer.take_events() == [{"type": "error"}, {"type": "state", "tick": 2}]


def test_events_are_bounded() -> None:
    viewer = Viewer()
    for number in range(1000):
        viewer.offer({"type": "error", "number": number})
    assert len(viewer.take_events()) <= 64


def test_a_frame_is_written_at_once_only_while_nothing_else_is_being_sent() -> None:
    viewer, written = Viewer(), []

    def write() -> bool:
        assert viewer.take_frame(len(written))
        written.append(len(written))
        return True

    viewer.write_by(write)
    viewer.offer_frame()
    assert written == []  # Its first frame, and what it is told first, are still being sent.
    assert viewer.take_frame(0)

    async def waits() -> None:
        await viewer.wait()
        waiting = asyncio.create_task(viewer.wait())
        await asyncio.sleep(0)
        viewer.offer_frame()
        assert written == [0]
        viewer.offer({"type": "error"})
        viewer.offer_frame()  # After what is told: the one who waits sends both.
        assert written == [0]
        await waiting
        viewer.offer_frame()
        assert written == [0]
        assert viewer.take_frame(1)

    asyncio.run(waits())


def test_a_frame_that_cannot_be_written_at_once_is_sent_by_who_waits() -> None:
    viewer = Viewer()
    viewer.write_by(lambda: False)

    async def waits() -> None:
        await viewer.wait()
        assert viewer.take_frame(0)
        waiting = asyncio.create_task(viewer.wait())
        await asyncio.sleep(0)
        viewer.offer_frame()
        async with asyncio.timeout(5):
            await waiting
        assert viewer.take_frame(1)

    asyncio.run(waits())
