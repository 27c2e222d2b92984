"""The action units that a clip's ground truth names."""

from __future__ import annotations

import pytest

from engine import Keyframe, Rig, Timeline, builtin_rig
from service.commanded import commanded_units


@pytest.fixture(scope="module")
def rig() -> Rig:
    """The standard rig."""
    return builtin_rig("standard")


def column(rig: Rig, name: str, times: list[float], *keyframes: Keyframe) -> list[float]:
    names, rows = commanded_units(Timeline(keyframes, 10.0), rig, times)
    return [round(float(value), 6) for value in rows[:, names.index(name)]]


def test_a_unit_eases_in_and_stays(rig: Rig) -> None:
    smile = Keyframe(time=1.0, action_units={"AU12": 0.8}, fade=1.0)
    assert column(rig, "AU12", [0, 1, 1.5, 2, 9], smile) == [0, 0, 0.4, 0.8, 0.8]
    assert column(rig, "AU1", [0, 5], smile) == [0, 0]


def test_a_hold_lets_go(rig: Rig) -> None:
    smile = Keyframe(action_units={"L12": 1.0}, hold=1.0, fade_out=1.0)
    assert column(rig, "L12", [0, 1, 1.5, 2, 3], smile) == [1, 1, 0.5, 0, 0]


def test_zero_and_replace_let_go(rig: Rig) -> None:
    first = Keyframe(action_units={"AU12": 1.0, "AU1": 0.5})
    drop = Keyframe(time=1.0, action_units={"AU12": 0.0})
    other = Keyframe(time=2.0, action_units={"AU4": 1.0}, replace=True)
    assert column(rig, "AU12", [0, 1], first, drop, other) == [1, 0]
    assert column(rig, "AU1", [0, 1, 2], first, drop, other) == [0.5, 0.5, 0]


def test_lips_have_columns_of_their_own(rig: Rig) -> None:
    both = Keyframe(action_units={"AU28": 0.6})
    top = Keyframe(time=1.0, action_units={"T28": 0.2})
    values = [column(rig, name, [0, 1], both, top) for name in ("AU28", "T28", "B28")]
    assert values == [[0.6, 0], [0, 0.2], [0, 0.6]]


def test_a_higher_layer_overrides_by_its_weight(rig: Rig) -> None:
    low = Keyframe(layer="mood", action_units={"AU12": 1.0})
    high = Keyframe(layer="puppet", action_units={"AU12": 0.2}, weight=0.5)
    assert column(rig, "AU12", [0], low, high) == [0.6]


def test_an_emotion_is_its_recipe(rig: Rig) -> None:
    joy = Keyframe(layer="emotion", emotion=("happiness", 0.5))
    terms = {term.key: term.intensity for term in rig.resolve_emotion("happiness").terms}
    for key, intensity in terms.items():
        assert column(rig, key, [0], joy) == [round(0.5 * intensity, 6)]


def test_one_side_of_a_unit_that_is_held_on_both_parts_them(rig: Rig) -> None:
    timeline = Timeline(
        (
            Keyframe(time=0.0, action_units={"AU12": 0.8}),
            Keyframe(time=1.0, action_units={"L12": 0.2}),
            Keyframe(time=2.0, action_units={"au12": 0.5}),
        ),
        3.0,
    )
    names, rows = commanded_units(timeline, rig, [0.5, 1.5, 2.5])
    shown = [{n: v for n, v in zip(names, row, strict=True) if v} for row in rows]
    assert shown == [{"AU12": 0.8}, {"L12": 0.2, "R12": 0.8}, {"AU12": 0.5}]
