"""Who runs when: live ticks on time, what is late counted, other work behind them."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
import time

import pytest
from conftest import parts_of, until
from starlette.testclient import TestClient

import service.embedded
from engine import Frame, Keyframe, Model, Timeline, builtin_rig
from service.embedded import EmbeddedRunner
from service.latest_first import LatestFirst
from service.load import TICK_SECONDS
from service.priority import AWAITED, BEHIND, background_pool, take_short_turns
from service.runner import Played, Tick
from service.sessions import Session
from service.timing import BOUNDS, Times, quantile_of

NOTHING = Timeline((), 1.0)
on_linux = pytest.mark.skipif(sys.platform != "linux", reason="threads have no priority there")


def niceness() -> int:
    return os.getpriority(os.PRIO_PROCESS, threading.get_native_id())


class Clock:
    """A clock that moves only by what is slept and worked."""

    def __init__(self) -> None:
        self.now = 100.0

    def perf_counter(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def paced(monkeypatch: pytest.MonkeyPatch, ticks: list[float]) -> tuple[EmbeddedRunner, float]:
    """Return a runner whose ticks took so many ticks' time each, and the time all took [s]."""
    clock = Clock()
    monkeypatch.setattr(service.embedded, "time", clock)
    runner = EmbeddedRunner()
    due = clock.now + TICK_SECONDS
    for took in ticks:
        started = clock.now
        clock.now += took * TICK_SECONDS
        due = runner._pace(started, due, 1)
    return runner, clock.now - 100.0


def test_ticks_on_time_are_a_tick_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    runner, elapsed = paced(monkeypatch, [0.5] * 60)
    assert elapsed == pytest.approx(1.0)
    assert runner.counters.ticks == 60
    assert runner.counters.overruns == 0
    assert runner.counters.lateness.quantile(1.0) == 0.0


def test_a_late_tick_is_counted_and_made_up_for(monkeypatch: pytest.MonkeyPatch) -> None:
    runner, elapsed = paced(monkeypatch, [0.5, 1.8, *[0.5] * 58])
    assert elapsed == pytest.approx(1.0)
    assert runner.counters.overruns == 1
    assert runner.counters.lateness.quantile(1.0) == pytest.approx(0.8 * TICK_SECONDS)


def test_a_long_stall_is_not_made_up_for(monkeypatch: pytest.MonkeyPatch) -> None:
    _, elapsed = paced(monkeypatch, [0.5, 31.0, *[0.1] * 58])
    assert elapsed == pytest.approx(1.5, abs=2.5 * TICK_SECONDS)


def test_a_machine_too_slow_makes_every_tick_late(monkeypatch: pytest.MonkeyPatch) -> None:
    runner, elapsed = paced(monkeypatch, [2.0] * 60)
    assert elapsed == pytest.approx(2.0)
    assert runner.counters.overruns == 60
    assert runner.counters.durations.quantile(0.5) == pytest.approx(2 * TICK_SECONDS)
    assert runner.load.share_of(1) >= 1.0


def test_late_ticks_of_live_faces_are_counted() -> None:
    async def body() -> EmbeddedRunner:
        runner = EmbeddedRunner()
        step = runner._step_group

        def slow(group: object) -> object:
            time.sleep(2 * TICK_SECONDS)
            return step(group)  # type: ignore[arg-type]

        runner._step_group = slow  # type: ignore[method-assign,assignment]
        runner.start()
        rig = builtin_rig("standard")
        await runner.open("a", rig, NOTHING, Model.for_rig(rig))
        while runner.counters.ticks < 5:
            await asyncio.sleep(0.01)
        await runner.apply("a", Keyframe(action_units={"AU12": 1.0}))
        await asyncio.to_thread(runner.stop)
        return runner

    counters = asyncio.run(asyncio.wait_for(body(), 60)).counters
    assert counters.overruns >= 5
    assert counters.lateness.count == counters.durations.count == counters.ticks
    assert counters.lateness.quantile(0.5) > TICK_SECONDS / 2
    assert counters.waits.count == 1


@on_linux
def test_building_stands_back_behind_live_faces() -> None:
    seen: dict[str, int] = {}

    async def body() -> None:
        runner = EmbeddedRunner()
        step, make = runner._step, runner._simulator

        def stepping() -> int:
            seen["live"] = niceness()
            return step()

        def making(*args: object) -> object:
            seen["build"] = niceness()
            return make(*args)  # type: ignore[arg-type]

        runner._step = stepping  # type: ignore[method-assign]
        runner._simulator = making  # type: ignore[method-assign,assignment]
        runner.start()
        rig = builtin_rig("standard")
        await runner.open("a", rig, NOTHING, Model.for_rig(rig))
        while "live" not in seen:
            await asyncio.sleep(0.01)
        await asyncio.to_thread(runner.stop)

    asyncio.run(asyncio.wait_for(body(), 120))
    most = 19 - niceness()
    assert seen["live"] == niceness()
    assert seen["build"] - seen["live"] == min(AWAITED, most)


@on_linux
def test_pools_in_the_background_stand_back() -> None:
    most = 19 - niceness()
    with background_pool(1, "test") as pool:
        assert pool.submit(niceness).result(10) - niceness() == min(BEHIND, most)
    pool_of_latest = LatestFirst("test", most=1)
    assert pool_of_latest.submit(niceness).result(10) - niceness() == min(BEHIND, most)
    pool_of_latest.shutdown()


def test_short_turns_change_no_priority() -> None:
    found: list[object] = []

    def work() -> None:
        before = niceness()
        found.extend([take_short_turns(), niceness() == before])

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert isinstance(found[0], bool)
    assert found[1]


def test_the_interpreter_changes_hands_often() -> None:
    runner = EmbeddedRunner()
    runner.start()
    runner.stop()
    assert sys.getswitchinterval() < 0.001


def test_delays_and_ticks_are_in_the_metrics(client: TestClient, session: str) -> None:
    client.patch(f"/api/sessions/{session}/controls", json={"action_units": {"AU12": 1}})
    until(lambda: parts_of(client).runner.counters.ticks > 3)
    until(lambda: parts_of(client).loop_delay.times.count > 0)
    text = client.get("/metrics").text
    for name in ("loop_delay", "tick_duration", "tick_lateness", "command_wait"):
        assert f'risorius_{name}_seconds_bucket{{le="+Inf"}}' in text
        assert f'risorius_{name}_seconds_recent{{quantile="0.99"}}' in text
        assert f"risorius_{name}_seconds_count 0.0" not in text
    for name in ("tick_overruns_total", "face_cost_seconds", "load_share", "capacity_share"):
        assert f"\nrisorius_{name} " in text


def test_health_tells_the_pace(client: TestClient) -> None:
    pace = client.get("/api/health").json()["pace"]
    assert pace["ticks"] >= pace["late_ticks"] >= 0
    assert pace["capacity"] == parts_of(client).settings.capacity_share
    assert {"awake", "load", "lateness_p99", "loop_delay_p99"} < set(pace)


def test_frames_of_many_faces_leave_the_loop_to_others_in_between(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ten faces whose frames take 2 ms each: the loop turns between them, and one closes."""
    opened = [client.post("/api/sessions", json={}).json()["id"] for _ in range(10)]
    sessions, closed = parts_of(client).sessions, opened[-1]
    shown: list[str] = []
    frames = {each: sessions._live[each].frame for each in opened}

    def show(session: Session, frame: Frame) -> None:
        assert frame is frames[session.id]
        shown.append(session.id)
        time.sleep(0.002)

    async def beside_others() -> list[int]:
        """Return how many frames were handed on by each turn that the loop had meanwhile."""
        monkeypatch.setattr(Session, "show", show)
        showing = asyncio.create_task(sessions._show_frames(frames))
        turns = []
        while not showing.done():
            await asyncio.sleep(0.0)
            turns.append(len(shown))
            if len(shown) == 5:
                sessions._live.pop(closed, None)
        monkeypatch.undo()
        return turns

    assert client.portal is not None
    kept = sessions._live[closed]
    try:
        turns = client.portal.call(beside_others)
    finally:
        sessions._live[closed] = kept
        for each in opened:
            client.delete(f"/api/sessions/{each}")
    assert shown == opened[:-1]
    assert turns[:5] == [1, 2, 3, 4, 5]


def test_what_took_effect_is_noted_before_the_loop_turns_to_others(
    client: TestClient, session: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Between two frames a command may come: it is later than what a face was just played."""
    sessions = parts_of(client).sessions
    noted: list[list[int]] = []
    live = sessions._live[session]
    played = Played(session, live.frame.tick + 5, Keyframe(action_units={"AU12": 0.5}))

    def show(each: Session, frame: Frame) -> None:
        noted.append([command.tick for command in each.tail.commands])

    async def take() -> None:
        monkeypatch.setattr(Session, "show", show)
        await sessions._take(Tick({session: live.frame}, played=[played]))
        monkeypatch.undo()

    assert client.portal is not None
    client.portal.call(take)
    assert played.tick in noted[-1]


def test_times_are_counted_in_their_buckets() -> None:
    times = Times()
    for seconds in (0.0, 0.0001, 0.00015, 5.0):
        times.add(seconds)
    buckets = dict(times.buckets())
    assert buckets["0.0001"] == 2
    assert buckets["0.0002"] == 3
    assert buckets["1.0"] == 3
    assert buckets["+Inf"] == 4
    assert times.quantile(0.5) == 0.00015
    assert times.quantile(1.0) == 5.0
    assert Times().quantile(0.5) == 0.0


def test_a_quantile_of_a_histogram_lies_within_its_bucket() -> None:
    times = Times()
    for _ in range(99):
        times.add(0.0045)
    times.add(0.0309)
    buckets = [(float(end), count) for end, count in times.buckets()]
    assert 0.004 < quantile_of(buckets, 0.5) <= 0.005
    assert 0.025 < quantile_of(buckets, 0.999) <= 0.0333
    assert quantile_of([], 0.5) == 0.0
    times.add(100.0)
    assert quantile_of([(float(end), n) for end, n in times.buckets()], 1.0) == BOUNDS[-1]
