"""ARKit's names drive the face: every spelling, sums, and eyes each by itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    InvalidTrack,
    InvalidValue,
    Keyframe,
    Rig,
    Timeline,
    UnknownName,
    arkit_blend,
    arkit_table,
    builtin_rig,
)
from engine.arkit import find_arkit
from engine.channels import LIMITS
from engine.measure import CORNER, settle

NAMES = list(arkit_table().shapes)
WEIGHTS = st.dictionaries(st.sampled_from(NAMES), st.floats(0.0, 1.0))


def spellings(name: str) -> list[str]:
    """Return the ways in which tools write a name."""
    stem, side = name, ""
    for word in ("Left", "Right"):
        if name.endswith(word):
            stem, side = name.removesuffix(word), word
    pascal = name[0].upper() + name[1:]
    return [name, pascal, name.lower(), *([f"{stem}_{side[0]}"] if side else [])]


@pytest.mark.parametrize("name", NAMES)
def test_every_spelling_is_the_same_shape(name: str) -> None:
    assert len(NAMES) == 52
    assert {find_arkit(each).name for each in spellings(name)} == {name}


@pytest.mark.parametrize("name", NAMES)
def test_every_name_moves_the_standard_rig(standard_rig: Rig, name: str) -> None:
    blend = arkit_blend({name: 1.0})
    keyframe = Keyframe(action_units=blend.units, jaw=blend.axes.get("jaw", {}))
    assert standard_rig.check(keyframe) == []
    moved = np.abs(standard_rig.contraction(blend.units)).max() > 0.0
    assert moved or any(value for axes in blend.axes.values() for value in axes.values())
    assert arkit_table().shapes[name].source


@given(WEIGHTS)
def test_any_face_of_a_tracker_can_be_played(weights: dict[str, float]) -> None:
    blend = arkit_blend(weights)
    rig = builtin_rig("standard")
    rig.check(Keyframe(action_units=blend.units, gaze=blend.axes.get("gaze", {})))
    for group, axes in blend.axes.items():
        for axis, value in axes.items():
            low, high = LIMITS[group, axis]
            assert low <= value <= high


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_what_feeds_one_unit_is_added(upper: float, shrug: float) -> None:
    blend = arkit_blend({"mouthUpperUpLeft": upper, "mouthShrugUpper": shrug})
    share = arkit_table().shapes["mouthShrugUpper"].units["AU10"]
    assert blend.units["L10"] == pytest.approx(min(1.0, upper + share * shrug))
    assert blend.units.get("R10", blend.units.get("AU10", 0.0)) == pytest.approx(share * shrug)


def test_the_eyes_go_by_themselves() -> None:
    left = arkit_blend({"eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0}).axes["gaze"]
    assert left["yaw"] > 20.0
    assert left["vergence"] == pytest.approx(0.0)
    crossed = arkit_blend({"eyeLookInLeft": 0.5, "eyeLookInRight": 0.5}).axes["gaze"]
    assert crossed["yaw"] == pytest.approx(0.0)
    assert crossed["vergence"] > 20.0
    assert arkit_blend({"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0}).axes["gaze"]["pitch"] > 20.0


def test_sides_of_what_has_none_are_understood() -> None:
    assert arkit_blend({"browInnerUp_L": 0.5}).units == {"L1": 0.5}
    assert arkit_blend({"_neutral": 0.9}).units == {}


def test_an_unknown_name_is_told_the_nearest() -> None:
    with pytest.raises(UnknownName) as refused:
        arkit_blend({"mouthSmilLeft": 0.5})
    assert "mouthSmileLeft" in refused.value.nearest


@pytest.mark.parametrize("weight", [-0.01, 1.01, float("nan"), float("inf")])
def test_a_weight_is_from_nought_to_one(weight: float) -> None:
    with pytest.raises(InvalidValue, match=r"arkit\.jawOpen"):
        arkit_blend({"jawOpen": weight})


def test_one_shape_is_named_once() -> None:
    with pytest.raises(InvalidValue, match="are the same"):
        arkit_blend({"eyeBlink_L": 0.5, "EyeBlinkLeft": 0.5})


def test_timelines_take_arkit_and_what_is_named_itself_counts() -> None:
    entry = {
        "time": 0.0,
        "arkit": {"jawOpen": 0.4, "mouthSmile_L": 0.5},
        "action_units": {"12": 0.9},
    }
    keyframe = Timeline.from_json({"timeline": [entry]}).keyframes[0]
    assert keyframe.action_units == {"AU27": 0.4, "12": 0.9}
    assert keyframe.layer == "puppet"
    with pytest.raises(InvalidTrack, match=r"keyframe 0: arkit: .*jawOpen"):
        Timeline.from_json({"timeline": [{"time": 0.0, "arkit": {"jawOpn": 0.4}}]})


def test_a_mouth_goes_to_its_side_where_other_units_stand_in(standard_rig: Rig) -> None:
    named = [arkit_blend({name: 1.0}).units for name in ("mouthLeft", "mouthRight")]
    left, right = settle(standard_rig, [Keyframe(action_units=units) for units in named])
    assert float(left.u("M1_0")[0]) > 3.0
    assert float(right.u("M1_0")[0]) < -3.0
    assert float(left.u(CORNER)[0]) > 3.0
