"""Idle life: by the literature's figures, by seed alone, and under whatever anybody commands."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from itertools import islice, pairwise, takewhile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import (
    IDLE,
    Idle,
    InvalidValue,
    Keyframe,
    Model,
    Rig,
    Simulator,
    end_of_life,
    idle_keyframes,
    ticks,
)
from engine.idle.blinks import onsets
from engine.idle.chance import Chance
from engine.idle.saccades import Shift, saccade_seconds, shifts
from engine.mixing import Mixer
from engine.rates import AXIS_RATES

HOUR = 3600.0
SEEDS = st.integers(0, 2**32 - 1)
UNITS = frozenset({"AU1", "AU2", "AU4", "AU7", "AU12", "AU14", "AU15", "AU17", "AU24", "AU45"})
ONLY_BLINKS = Idle(seed=3, gaze=0.0, head=0.0, micro=0.0)


def lived(idle: Idle, seconds: float, units: frozenset[str] = UNITS) -> list[Keyframe]:
    """Return what a life does in its first seconds."""
    return list(takewhile(lambda each: each.time < seconds, idle_keyframes(idle, units)))


def blinks(seed: int, seconds: float = HOUR) -> list[float]:
    """Return when blinks begin, s."""
    begun = onsets(seed, 1.0, shifts(seed, 1.0, 1.0))
    return list(takewhile(lambda each: each < seconds, (tick / 60.0 for tick in begun)))


def hour_of_shifts(seed: int) -> list[Shift]:
    return list(takewhile(lambda each: each.tick < 60.0 * HOUR, shifts(seed, 1.0, 1.0)))


# By the figures.


@pytest.mark.parametrize("seed", range(5))
def test_blinks_come_two_to_ten_seconds_apart_and_skewed_to_the_right(seed: int) -> None:
    between = [after - before for before, after in pairwise(blinks(seed))]
    assert min(between) >= 2.0
    assert max(between) <= 10.0
    mean, median = statistics.mean(between), statistics.median(between)
    assert 3.5 < mean < 4.5
    assert median < mean
    assert np.quantile(between, 0.9) - median > 1.5 * (median - np.quantile(between, 0.1))


def test_some_blinks_come_in_pairs_and_some_do_not_close() -> None:
    told = [each for each in lived(ONLY_BLINKS, 4 * HOUR) if each.action_units["AU45"] > 0.0]
    between = [after.time - before.time for before, after in pairwise(told)]
    pairs = sum(gap < 1.0 for gap in between)
    assert 0.07 < pairs / (len(between) - pairs) < 0.13
    partial = sum(each.action_units["AU45"] < 1.0 for each in told)
    assert 0.1 < partial / len(told) < 0.2


def test_a_lid_is_told_to_close_faster_than_to_open_and_always_to_open() -> None:
    told = lived(ONLY_BLINKS, HOUR)
    assert len(told) % 2 == 0
    for shut, opened in zip(told[::2], told[1::2], strict=True):
        assert opened.action_units == {"AU45": 0.0}
        assert shut.fade is not None
        assert opened.fade is not None
        assert 0.08 <= shut.fade <= 0.1
        assert 0.2 <= opened.fade <= 0.26
        assert opened.time >= shut.time + shut.fade


def test_blinks_go_with_some_far_glances() -> None:
    far = [shift.tick / 60.0 for shift in hour_of_shifts(1) if shift.size >= 7.0]
    begun = set(blinks(1))
    share = sum(each in begun for each in far) / len(far)
    assert 0.1 < share < 0.35


@pytest.mark.parametrize("seed", range(3))
def test_eyes_are_mostly_on_the_partner_and_come_back(seed: int) -> None:
    seen = hour_of_shifts(seed)
    looked = sum(
        after.tick - before.tick
        for before, after in pairwise(seen)
        if abs(before.yaw) <= 1.6 and -3.6 <= before.pitch <= 0.0
    )
    assert 0.6 < looked / (seen[-1].tick - seen[0].tick) < 0.85
    stays = [(after.tick - before.tick) / 60.0 for before, after in pairwise(seen)]
    assert 0.29 < min(stays)
    assert max(stays) < 12.0
    assert max(max(abs(each.yaw), abs(each.pitch)) for each in seen) < 20.0


def test_saccades_take_the_main_sequence_s_time() -> None:
    assert saccade_seconds(10.0) == pytest.approx(0.043)
    fades = {ticks(each.time): each.fade for each in lived(Idle(seed=2), 300.0) if each.gaze}
    seen = [shift for shift in hour_of_shifts(2) if shift.tick < 290 * 60]
    assert len(seen) > 100
    for shift in seen:
        told = fades[shift.tick]
        assert told == pytest.approx(saccade_seconds(shift.size), abs=0.51 / 60.0)


def test_a_head_sways_by_fractions_of_a_degree_as_it_breathes() -> None:
    still = Idle(seed=4, gaze=0.0, blinks=0.0, micro=0.0)
    told = lived(still, HOUR)
    nods = [each for each in told if "pitch" in each.head]
    turning = [after.time - before.time for before, after in pairwise(nods)]
    breaths = len(nods) / 2 / HOUR
    assert 0.2 < breaths < 0.3
    assert min(turning) >= 1.3
    steps = [abs(b.head["pitch"] - a.head["pitch"]) for a, b in pairwise(nods)]
    assert 0.1 < statistics.mean(steps) < 0.8
    for axis in ("yaw", "pitch", "roll"):
        most = max(abs(each.head[axis]) for each in told if axis in each.head)
        assert 0.5 < most < 4.0, axis


def test_brief_expressions_are_faint_rare_and_gone_in_half_a_second() -> None:
    told = lived(Idle(seed=5, blinks=0.0, gaze=0.0, head=0.0, micro=0.3), 4 * HOUR)
    begun, ended = told[::2], told[1::2]
    for start, end in zip(begun, ended, strict=True):
        assert end.action_units == dict.fromkeys(start.action_units, 0.0)
        assert max(start.action_units.values()) <= 0.4
        assert end.fade is not None
        assert 1 / 25 < end.time + end.fade - start.time <= 0.5
    between = [after.time - before.time for before, after in pairwise(begun)]
    assert 25.0 < statistics.mean(between) < 60.0
    assert len({tuple(each.action_units) for each in begun}) > 6


# By seed alone.


@settings(max_examples=30)
@given(SEEDS)
def test_the_same_seed_lives_the_same_life_and_another_another(seed: int) -> None:
    life = lived(Idle(seed=seed), 60.0)
    assert life == lived(Idle(seed=seed), 60.0)
    assert life != lived(Idle(seed=(seed + 1) % 2**32), 60.0)


@settings(max_examples=30)
@given(SEEDS, *[st.sampled_from([0.0, 0.2, 1.0, 2.0])] * 4)
def test_a_life_is_told_in_order_at_whole_ticks_within_what_a_face_can_do(
    seed: int, blinks: float, gaze: float, head: float, micro: float
) -> None:
    idle = Idle(seed, blinks, gaze, head, micro)
    told = list(islice(takewhile(lambda k: k.time < 120.0, idle_keyframes(idle, UNITS)), 3000))
    assert [each.time for each in told] == sorted(each.time for each in told)
    for each in told:
        assert (each.layer, each.owner, each.replace) == ("idle", IDLE, False)
        assert ticks(each.time) / 60.0 == each.time
        assert each.fade is not None
        assert each.fade >= 1 / 60.0
        assert (each.hold, each.ttl, each.weight) == (None, None, 1.0)
    assert bool(told) == any((blinks, gaze, head, micro))
    assert any(each.gaze for each in told) == (gaze > 0.0)
    assert any(each.head for each in told) == (head > 0.0)


def test_parts_do_not_shift_each_other() -> None:
    def eyes(idle: Idle) -> list[Keyframe]:
        return [each for each in lived(idle, 300.0) if each.gaze]

    assert eyes(Idle(seed=9)) == eyes(Idle(seed=9, blinks=2.0, micro=0.0))


@pytest.mark.parametrize("part", ["blinks", "gaze", "head", "micro"])
@pytest.mark.parametrize("little", [5e-324, 1e-200, 1e-9, 0.009])
def test_next_to_nothing_is_nothing(part: str, little: float) -> None:
    """What comes next to never was sought for ever."""
    none, nearly = (Idle(**{"seed": 3, part: amount}) for amount in (0.0, little))  # type: ignore[arg-type]
    first = list(islice(idle_keyframes(none, UNITS), 100))
    assert list(islice(idle_keyframes(nearly, UNITS), 100)) == first


def test_a_rig_without_a_unit_leaves_out_what_needs_it() -> None:
    told = lived(Idle(seed=1, micro=2.0), HOUR, frozenset({"AU4"}))
    assert {key for each in told for key in each.action_units} == {"AU4"}
    assert not any(each.action_units for each in lived(Idle(seed=1), HOUR, frozenset()))


@pytest.mark.parametrize(
    "wrong", [{"seed": -1}, {"seed": 2**32}, {"blinks": 2.1}, {"head": -0.1}, {"micro": np.nan}]
)
def test_a_life_that_cannot_be_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(InvalidValue, match=next(iter(wrong))):
        Idle(**wrong)  # type: ignore[arg-type]


def test_chance_is_even_and_log_normals_keep_to_their_ends() -> None:
    chance = Chance(1, "test")
    shares = [chance.share() for _ in range(20_000)]
    assert 0.0 < min(shares) < 0.001
    assert 0.999 < max(shares) < 1.0
    assert np.histogram(shares, 20, (0, 1))[0] == pytest.approx(1000, abs=150)
    assert statistics.stdev(chance.normal(2.0) for _ in range(5000)) == pytest.approx(2, abs=0.1)
    drawn = [chance.log_normal(3.6, 0.45, 2.0, 10.0) for _ in range(5000)]
    assert min(drawn) >= 2.0
    assert max(drawn) <= 10.0
    counts = [chance.one_of([("a", 1.0), ("b", 3.0)]) for _ in range(4000)].count("a")
    assert counts == pytest.approx(1000, abs=120)


# On a face.


def blink() -> Iterator[tuple[int, Keyframe]]:
    """Yield one blink, from tick 0 on."""
    first = islice(idle_keyframes(ONLY_BLINKS, UNITS), 2)
    shut, opened = first
    start = ticks(shut.time)
    yield 0, shut
    yield ticks(opened.time) - start, opened


def test_a_simulated_lid_closes_faster_than_it_opens(standard_rig: Rig) -> None:
    simulator = Simulator(standard_rig, model=Model.for_rig(standard_rig, integrator="verlet"))
    simulator.add("a")
    told = dict(blink())
    lid = standard_rig.head.names.index("E1_4.L")
    down = []
    for tick in range(60):
        if tick in told:
            simulator.apply("a", told[tick])
        simulator.step()
        down.append(-simulator.frame("a").displacements[lid, 1])
    most = max(down)
    assert most > 5.0
    lowest = down.index(most)
    closing = sum(0.1 * most < each < 0.9 * most for each in down[:lowest])
    opening = sum(0.1 * most < each < 0.9 * most for each in down[lowest:])
    assert 2 <= closing < opening
    assert opening <= 20
    assert abs(down[-1]) < 0.3
    assert max(abs(b - a) for a, b in pairwise(down)) * 60.0 < 400.0


HELD = {
    "a blink": Keyframe(action_units={"AU45": 1.0}),
    "eyes kept open": Keyframe(action_units={"AU45": 1e-3}),
    "eyes closed": Keyframe(action_units={"AU43": 1.0}),
    "gaze": Keyframe(gaze={"yaw": 10.0, "pitch": -4.0}),
    "head": Keyframe(head={"yaw": 8.0, "pitch": 3.0, "roll": -2.0}),
}


@pytest.mark.parametrize("name", HELD)
def test_what_a_person_holds_is_not_disturbed_by_a_bit(standard_rig: Rig, name: str) -> None:
    """Nor for a moment: channel by channel, the commands are those of a face without idle life."""
    alone, alive = Mixer(standard_rig), Mixer(standard_rig)
    for mixer in (alone, alive):
        mixer.apply(HELD[name], 0)
    held = alone.at(1) != 0.0
    assert held.any()
    coming = lived(Idle(seed=6, micro=2.0), 60.0)
    others = 0
    for tick in range(1, 3600):
        while coming and ticks(coming[0].time) <= tick:
            alive.apply(coming.pop(0), tick)
        told = alive.at(tick)
        assert np.array_equal(told[held], alone.at(tick)[held])
        others += bool((told[~held] != 0.0).any())
    assert others > 3000


def test_idle_life_comes_back_smoothly_once_a_command_is_released(standard_rig: Rig) -> None:
    mixer, yaw = Mixer(standard_rig), standard_rig.channels.index("head", "yaw")
    mixer.apply(HELD["head"], 0)
    coming = lived(Idle(seed=6), 20.0)
    seen = []
    for tick in range(1, 900):
        while coming and ticks(coming[0].time) <= tick:
            mixer.apply(coming.pop(0), tick)
        if tick == 500:
            mixer.apply(Keyframe(replace=True, fade=0.5), tick)
        seen.append(float(mixer.at(tick)[yaw]))
    assert set(seen[:499]) == {8.0}
    assert max(abs(b - a) for a, b in pairwise(seen)) < 0.5
    assert abs(seen[540]) < 4.0
    assert len(set(seen[600:])) > 200


def test_no_axis_is_asked_to_go_faster_than_it_can(standard_rig: Rig) -> None:
    mixer, coming = Mixer(standard_rig), lived(Idle(seed=8, gaze=2.0, head=2.0), 60.0)
    before = mixer.at(0)
    most = np.zeros(standard_rig.channels.count)
    for tick in range(1, 3600):
        while coming and ticks(coming[0].time) <= tick:
            mixer.apply(coming.pop(0), tick)
        told = mixer.at(tick)
        most, before = np.maximum(most, np.abs(told - before) * 60.0), told
    for (group, axis), rate in AXIS_RATES.items():
        if group in ("gaze", "head"):
            assert most[standard_rig.channels.index(group, axis)] <= rate


def test_a_life_that_ends_lets_go_of_all(standard_rig: Rig) -> None:
    mixer = Mixer(standard_rig)
    for each in lived(Idle(seed=1), 12.0):
        mixer.apply(each, ticks(each.time))
    assert mixer.report(720)["layers"]
    mixer.apply(end_of_life(), 720)
    assert mixer.report(721)["layers"] == {}
    assert not mixer.at(760).any()
