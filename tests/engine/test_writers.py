"""Writers of a layer: whose word counts, what returns when a lease ends, that nobody jitters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import InvalidTrack, InvalidValue, Keyframe, Rig, Timeline, Writers, builtin_rig
from engine.mixing import Mixer
from engine.writers import AT_IT, MOST_WRITERS

RIG: Rig = builtin_rig("standard")
ZYGOMATIC = RIG.muscle_names.index("zygomatic_major.L")
FADE_OUT = 0.4
LETTING_GO = round(FADE_OUT * 60)

OWNERS = st.sampled_from(["anyone", "a", "b"])
UNITS = st.dictionaries(
    st.sampled_from(["AU12", "L12", "R12", "12", "AU6", "L6", "AU28", "T28", "B28"]),
    st.sampled_from([0.0, 0.5, 1.0]),
    max_size=3,
)
WRITES = st.builds(
    Keyframe,
    layer=st.sampled_from(["emotion", "puppet"]),
    owner=OWNERS,
    action_units=UNITS,
    jaw=st.dictionaries(st.just("pitch"), st.sampled_from([0.0, 5.0]), max_size=1),
    muscles=st.dictionaries(st.just("mentalis.L"), st.sampled_from([0.0, 0.4]), max_size=1),
    emotion=st.none() | st.just(("happiness", 0.5)),
    expression=st.booleans(),
    plays=st.sampled_from([{}, {"label": "joy"}]),
    weight=st.sampled_from([0.5, 1.0]),
    hold=st.none() | st.just(1.0),
    ttl=st.none() | st.just(2.0),
    replace=st.booleans(),
)
STEPS = st.lists(st.tuples(st.sampled_from([0, 1, 20, 70]), WRITES), max_size=6)


def smile(owner: str, value: float, **more: Any) -> Keyframe:
    return Keyframe(owner=owner, action_units={"AU12": value}, **more)


def told(mixer: Mixer, tick: int, layer: str = "puppet") -> dict[str, Any]:
    layers = mixer.report(tick)["layers"]
    assert isinstance(layers, dict)
    return dict(layers.get(layer, {}))


def units(mixer: Mixer, tick: int, layer: str = "puppet") -> dict[str, float]:
    return dict(told(mixer, tick, layer).get("action_units", {}))


def after(*steps: tuple[int, Keyframe]) -> Mixer:
    mixer = Mixer(RIG)
    for tick, keyframe in steps:
        mixer.apply(keyframe, tick)
    return mixer


def test_the_later_writer_counts_and_what_lies_beneath_returns_smoothly() -> None:
    mixer = after((0, smile("a", 0.8)), (10, smile("b", 0.2, ttl=1.0, fade_out=FADE_OUT)))
    assert units(mixer, 11) == {"AU12": 0.2}
    values = np.array([mixer.at(tick)[ZYGOMATIC] for tick in range(60, 70 + LETTING_GO + 2)])
    high, low = (RIG.contraction({"AU12": value})[ZYGOMATIC] for value in (0.8, 0.2))
    assert values[0] == pytest.approx(low)
    assert values[-1] == pytest.approx(high)
    # An ease of n ticks goes 1.5 / n of its way in a tick at most.
    assert (np.diff(values) >= 0.0).all()
    assert np.diff(values).max() <= 1.5 * (high - low) / LETTING_GO + 1e-9


def test_only_what_a_writer_held_lets_go() -> None:
    other = Keyframe(owner="b", action_units={"AU1": 1.0}, jaw={"pitch": 5.0}, ttl=0.5)
    mixer = after((0, smile("a", 0.8)), (0, other))
    assert units(mixer, 29) == {"AU12": 0.8, "AU1": 1.0}
    assert units(mixer, 30) == {"AU12": 0.8}
    assert "jaw" not in told(mixer, 30)


def test_a_write_renews_its_owners_lease_and_no_other() -> None:
    mixer = after((0, smile("a", 0.8, ttl=1.0)), (0, Keyframe(owner="b", jaw={"yaw": 3}, ttl=1.0)))
    mixer.apply(Keyframe(owner="a", action_units={"AU1": 0.5}, ttl=1.0), 50)
    assert [writer["owner"] for writer in told(mixer, 61)["writers"]] == ["a"]
    assert units(mixer, 109) == {"AU12": 0.8, "AU1": 0.5}
    assert told(mixer, 110) == {}


def test_the_lease_counts_from_the_write_and_the_hold_from_arrival() -> None:
    leased = after((0, smile("a", 0.8, fade=1.0, ttl=2.0)))
    held = after((0, smile("a", 0.8, fade=1.0, hold=2.0)))
    assert told(leased, 119)["writers"][0]["expires_in"] == pytest.approx(1 / 60)
    assert told(leased, 120) == {}
    assert told(held, 120)["writers"][0]["expires_in"] == pytest.approx(1.0)
    both = after((0, smile("a", 0.8, fade=1.0, ttl=1.5, hold=2.0)))
    assert told(both, 90) == {}


def test_a_writer_is_told_with_what_it_holds() -> None:
    mixer = after((3, smile("a", 0.8)), (9, smile("b", 0.2, ttl=1.0, weight=0.5)))
    first, second = told(mixer, 9)["writers"]
    assert (first["owner"], first["since"], first["expires_in"]) == ("a", 3, None)
    assert (second["owner"], second["since"], second["expires_in"]) == ("b", 9, 1.0)
    assert (second["weight"], second["action_units"]) == (0.5, {"AU12": 0.2})


def test_a_weight_counts_over_the_writers_beneath_too() -> None:
    mixer = after((0, smile("a", 0.8)), (0, smile("b", 0.2, weight=0.25)))
    assert units(mixer, 1)["AU12"] == pytest.approx(0.65)
    merged = mixer.report(1)["merged"]
    assert isinstance(merged, dict)
    assert merged["action_units"]["AU12"] == pytest.approx(0.65)
    alone = RIG.contraction({"AU12": 0.65})[ZYGOMATIC]
    assert mixer.at(1)[ZYGOMATIC] == pytest.approx(alone)


def test_who_replaces_lets_go_of_its_own_and_without_a_name_of_all() -> None:
    writes = [(0, smile("a", 0.8)), (0, Keyframe(owner="b", action_units={"AU1": 1.0}))]
    mine = after(*writes, (1, Keyframe(owner="b", action_units={"AU4": 1.0}, replace=True)))
    assert units(mine, 2) == {"AU12": 0.8, "AU4": 1.0}
    released = after(*writes, (1, Keyframe(owner="a", replace=True)))
    assert units(released, 2) == {"AU1": 1.0}
    everybody = after(*writes, (1, Keyframe(action_units={"AU4": 1.0}, replace=True)))
    assert units(everybody, 2) == {"AU4": 1.0}


def test_two_who_write_by_turns_do_not_jitter() -> None:
    mixer = Mixer(RIG)
    commands = []
    for tick in range(180):
        mixer.apply(smile("ab"[tick % 2], (0.9, 0.2)[tick % 2], ttl=1.0), tick)
        commands.append(mixer.at(tick)[ZYGOMATIC])
    high, low = (RIG.contraction({"AU12": value})[ZYGOMATIC] for value in (0.9, 0.2))
    # The later one takes over once, and keeps it.
    assert commands[0] == high
    assert set(commands[1:]) == {low}


def test_who_waits_comes_up_once_the_other_is_quiet() -> None:
    mixer = after((0, smile("a", 0.9)), (10, smile("b", 0.2)), (12, smile("a", 0.8)))
    assert units(mixer, 13) == {"AU12": 0.2}
    mixer.apply(smile("a", 0.7), 10 + AT_IT)
    assert units(mixer, 10 + AT_IT) == {"AU12": 0.7}


def test_a_writer_is_told_under_whom_it_waits() -> None:
    writers = Writers(RIG)
    writers.take(smile("a", 0.9), 0)
    assert writers.beneath(smile("a", 0.9)) == {}
    writers.take(smile("b", 0.2), 1)
    again = Keyframe(owner="a", action_units={"L12": 0.9, "AU1": 0.3})
    writers.take(again, 2)
    assert writers.beneath(again) == {"b": ["AU12"]}


def test_an_expression_covers_what_others_show_and_uncovers_it() -> None:
    sad = Keyframe(layer="emotion", owner="a", action_units={"AU15": 0.6, "AU1": 0.5})
    happy = Keyframe(layer="emotion", owner="b", emotion=("happiness", 1.0), ttl=1.0)
    mixer = after((0, sad), (5, happy))
    assert "AU15" not in units(mixer, 6, "emotion")
    assert units(mixer, 6, "emotion")["AU12"] > 0.0
    assert told(mixer, 6, "emotion")["emotion"]["label"] == "happiness"
    assert units(mixer, 65, "emotion") == {"AU15": 0.6, "AU1": 0.5}


def test_an_expression_without_a_name_covers_as_well() -> None:
    first = Keyframe(owner="a", action_units={"AU15": 0.6})
    second = Keyframe(owner="b", action_units={"AU12": 0.5}, expression=True)
    assert units(after((0, first), (1, second)), 2) == {"AU12": 0.5}


def test_what_an_expression_plays_is_told_until_the_next_one() -> None:
    mix = {"label": None, "parts": [{"recipe": "joy"}, {"recipe": "surprise"}]}
    first = Keyframe(owner="a", action_units={"AU12": 0.6}, expression=True, plays=mix)
    more = Keyframe(owner="a", action_units={"AU1": 0.2})
    assert told(after((0, first), (1, more)), 2)["emotion"] == mix
    nameless = Keyframe(owner="a", action_units={"AU12": 0.6}, expression=True)
    assert "emotion" not in told(after((0, first), (1, nameless)), 2)
    rest = Keyframe(owner="b", expression=True, plays={"label": "neutral"})
    covered = after((0, first), (1, rest))
    assert told(covered, 2)["emotion"] == {"label": "neutral"}
    assert units(covered, 2) == {}


def test_one_lip_of_a_writer_parts_the_unit_of_another() -> None:
    lips = after(
        (0, Keyframe(owner="a", action_units={"AU28": 0.6})),
        (1, Keyframe(owner="b", action_units={"T28": 0.2})),
    )
    assert units(lips, 2) == {"T28": 0.2, "B28": 0.6}


def test_a_layer_has_room_for_so_many_writers() -> None:
    writers = Writers(RIG)
    for number in range(MOST_WRITERS):
        writers.take(smile(f"w{number}", 0.5), 0)
    with pytest.raises(InvalidValue, match="64 writers"):
        writers.take(smile("one-more", 0.5), 0)
    writers.take(smile("w0", 0.7), 0)
    writers.take(Keyframe(owner="w1", replace=True), 0)
    writers.take(smile("one-more", 0.5), 0)


@pytest.mark.parametrize("owner", ["", "two words", "ü", "x" * 65, "a\n"])
def test_a_text_that_names_no_owner_is_refused(owner: str) -> None:
    with pytest.raises(InvalidValue, match="owner"):
        RIG.check(Keyframe(owner=owner))
    with pytest.raises(InvalidTrack, match="keyframe 0: owner"):
        Timeline.from_json({"timeline": [{"time": 0, "owner": owner}]})


def test_a_timeline_carries_owners_and_leases() -> None:
    keyframe = Keyframe(owner="agent:1", action_units={"AU12": 0.5}, ttl=2.0, fade=0.1)
    line = Timeline.of([keyframe, replace(keyframe, time=1.0, hold=0.5, expression=True)])
    assert Timeline.from_json(line.to_json()) == line
    assert line.duration == pytest.approx(2.0 + 0.4 + 1.0)
    entry = {"time": 0, "fade_in": 0.3, "action_units": {"AU1": 1}}
    assert Timeline.from_json({"timeline": [entry]}).keyframes[0].fade == 0.3


def played(steps: Sequence[tuple[int, Keyframe]]) -> tuple[Mixer, int]:
    """Return the commands after one write after another, and when that was."""
    mixer, tick = Mixer(RIG), 0
    for wait, keyframe in steps:
        tick += wait
        mixer.apply(keyframe, tick)
    return mixer, tick


def without_since(layers: Any) -> Any:
    for layer in layers.values():
        for writer in layer["writers"]:
            del writer["since"]
    return layers


@given(steps=STEPS)
@settings(max_examples=200, deadline=None)
def test_what_is_held_can_be_told_again(steps: list[tuple[int, Keyframe]]) -> None:
    mixer, tick = played(steps)
    again = Mixer(RIG)
    for keyframe in mixer.held(tick):
        again.apply(keyframe, tick)
    assert without_since(again.report(tick)["layers"]) == without_since(
        mixer.report(tick)["layers"]
    )
    later = tick + 1000
    np.testing.assert_allclose(again.at(later), mixer.at(later), atol=1e-12)


@given(steps=STEPS)
@settings(max_examples=100, deadline=None)
def test_when_every_lease_is_over_the_face_is_asked_for_nothing(
    steps: list[tuple[int, Keyframe]],
) -> None:
    mixer, tick = played([(wait, replace(keyframe, ttl=2.0)) for wait, keyframe in steps])
    end = tick + 120 + LETTING_GO + 1
    for each in range(tick, end):
        mixer.at(each)
    assert mixer.report(end)["layers"] == {}
    assert not mixer.at(end).any()
    assert mixer.alarm() is None
    assert not mixer.due(end + 1)


@given(steps=STEPS)
@settings(max_examples=60, deadline=None)
def test_a_take_over_begins_where_the_face_is(steps: list[tuple[int, Keyframe]]) -> None:
    """With a fade of half a second nothing that is asked for jumps, whoever writes or lets go."""
    mixer, now, before = Mixer(RIG), 0, np.zeros(RIG.channels.count)
    fade, most = 0.5, np.full(RIG.channels.count, 1.5)
    most[RIG.channels.index("jaw", "pitch")] = 40.0
    for wait, keyframe in [*steps, (200, Keyframe())]:
        smooth = replace(keyframe, fade=fade, fade_out=fade)
        for tick in range(now, now + wait):
            value = mixer.at(tick)
            # An ease goes 1.5 / 30 of its way in a tick at most; two layers have three of them.
            assert (np.abs(value - before) <= 3 * 1.5 / 30 * most + 1e-9).all()
            before = value
        now += wait
        mixer.apply(smooth, now)


@given(steps=STEPS)
@settings(max_examples=60, deadline=None)
def test_the_same_writes_are_the_same_bits(steps: list[tuple[int, Keyframe]]) -> None:
    (first, tick), (second, _) = played(steps), played(steps)
    for each in range(tick, tick + 200, 7):
        assert np.array_equal(first.at(each), second.at(each))
