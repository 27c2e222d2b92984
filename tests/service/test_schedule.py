"""Keyframes that wait for their time: in order, each once, carried over as they are."""

from __future__ import annotations

import time

from hypothesis import given
from hypothesis import strategies as st

from engine import Keyframe, ticks
from service.schedule import Schedule

TIMES = st.lists(st.floats(0.0, 2.0), max_size=20)


def said(time: float, owner: str = "voice", layer: str = "speech") -> Keyframe:
    """Return a keyframe of an owner."""
    return Keyframe(time=time, owner=owner, layer=layer)


@given(TIMES, st.integers(0, 500))
def test_each_is_due_once_at_its_tick(times: list[float], now: int) -> None:
    schedule = Schedule()
    schedule.plan("face", [said(time) for time in times], now)
    seen = []
    for tick in range(now, now + 130):
        seen += [(tick, keyframe.time) for _, keyframe in schedule.due(tick)]
    assert sorted(seen) == sorted((now + ticks(time), time) for time in times)
    assert schedule.empty


@given(TIMES, st.integers(0, 500), st.integers(0, 500))
def test_what_is_left_is_carried_over(times: list[float], here: int, there: int) -> None:
    old, new = Schedule(), Schedule()
    old.plan("face", [said(time) for time in times], here)
    new.carry_on("face", old.leave("face", here), there)
    assert old.empty
    waiting = new.leave("face", there)
    assert [tick for tick, _ in waiting] == sorted(ticks(time) for time in times)


def test_an_owner_takes_back_what_it_had_to_say_and_nobody_else_does() -> None:
    schedule = Schedule()
    schedule.plan("face", [said(0.5), said(0.7)], 0)
    schedule.plan("face", [said(0.6, owner="other")], 0)
    schedule.plan("face", [said(0.6, layer="mood")], 0)
    schedule.plan("face", [said(0.1)], 0)
    assert schedule.coming("face") == 3
    assert [keyframe.time for _, keyframe in schedule.due(6)] == [0.1]
    assert {keyframe.owner for _, keyframe in schedule.due(60)} == {"voice", "other"}


def test_faces_do_not_mix() -> None:
    schedule = Schedule()
    schedule.plan("one", [said(0.0)], 0)
    schedule.plan("two", [said(0.0)], 5)
    assert [face for face, _ in schedule.due(4)] == ["one"]
    assert schedule.leave("two", 4) == [(1, said(0.0))]
    assert schedule.due(100) == []


def test_a_tick_costs_no_more_when_much_is_to_come() -> None:
    def seconds(count: int) -> float:
        schedule = Schedule()
        schedule.plan("face", [said(1.0 + n / 60) for n in range(count)], 0)
        best = 1.0
        for _ in range(20):
            begin = time.perf_counter()
            for tick in range(20):
                schedule.due(tick)
            best = min(best, time.perf_counter() - begin)
        return best

    assert seconds(20_000) < 50 * seconds(2)
