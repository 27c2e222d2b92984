"""Lives of live faces: each keyframe once at its tick, carried over as they are."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine import Idle, Keyframe, idle_keyframes, ticks
from service.lives import Lives

NOW = st.integers(0, 1000)


@given(st.lists(st.integers(0, 100), max_size=20).map(sorted), NOW)
def test_each_is_due_once_at_its_tick_and_a_life_can_end(times: list[int], now: int) -> None:
    lives = Lives()
    lives.begin("face", (Keyframe(time=tick / 60.0) for tick in times), now)
    seen = []
    for tick in range(now, now + 102):
        seen += [(tick, ticks(each.time)) for face, each in lives.due(tick) if face == "face"]
    assert seen == [(now + tick, tick) for tick in times]
    assert lives.empty
    assert "face" not in lives


@given(NOW, NOW, st.integers(0, 300))
def test_a_life_goes_on_elsewhere_where_it_stopped(here: int, there: int, after: int) -> None:
    def lived(moves: bool) -> list[tuple[int, Keyframe]]:
        lives, start, seen = Lives(), here, []
        lives.begin("face", idle_keyframes(Idle(seed=2), ["AU45"]), start)
        for tick in range(600):
            if moves and tick == after:
                others = Lives()
                others.carry_on("face", lives.leave("face", start + tick), there + tick)
                assert lives.empty
                lives, start = others, there
            seen += [(tick, each) for _, each in lives.due(start + tick)]
        return seen

    assert lived(moves=True) == lived(moves=False)


def test_a_face_without_a_life_has_none_to_take_along() -> None:
    lives = Lives()
    lives.carry_on("face", lives.leave("face", 3), 5)
    assert lives.empty
    assert list(lives.due(100)) == []


@given(NOW, st.integers(0, 300), st.integers(0, 300))
def test_a_life_that_waits_goes_on_where_it_stopped(now: int, after: int, wait: int) -> None:
    def lived(waits: int) -> list[tuple[int, Keyframe]]:
        lives, seen = Lives(), []
        lives.begin("face", idle_keyframes(Idle(seed=2), ["AU45"]), now)
        for tick in range(now, now + 600 + waits):
            if waits and tick == now + after:
                assert lives.pause("face", tick)
                assert not lives.pause("face", tick)
                assert lives.empty
            if waits and tick == now + after + waits:
                lives.resume("face", tick)
            late = waits if tick >= now + after else 0
            seen += [(tick - late, each) for _, each in lives.due(tick)]
        return seen

    assert lived(wait) == lived(0)


def test_a_life_that_waits_is_taken_along_and_ended() -> None:
    lives = Lives()
    assert not lives.pause("face", 3)
    lives.resume("face", 4)
    assert lives.empty
    lives.begin("face", iter([Keyframe(time=1.0)]), 10)
    lives.pause("face", 30)
    others = Lives()
    others.carry_on("face", lives.leave("face", 500), 100)
    assert [list(others.due(tick)) != [] for tick in (139, 140)] == [False, True]
    assert lives.leave("face", 600) is None


def test_a_new_life_takes_the_place_of_the_last() -> None:
    lives = Lives()
    lives.begin("face", iter([Keyframe(time=1.0)]), 0)
    lives.begin("face", iter([Keyframe(time=2.0)]), 0)
    assert [each.time for _, each in lives.due(1000)] == [2.0]
