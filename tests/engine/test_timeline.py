"""Timelines read and written, and the messages of those that cannot be."""

from __future__ import annotations

import pytest

from engine import InvalidTrack, Keyframe, Timeline

GOOD = {
    "timeline": [
        {"time": 1.0, "emotion": {"label": "joy", "intensity": 0.8}, "fade": 0.2, "hold": 1.5},
        {"time": 0.0, "action_units": {"AU12": 0.5, "L4": "B"}, "jaw": {"pitch": 3}},
        {"time": 2.0, "facs": "1C+2C", "layer": "speech", "replace": True},
        {"time": 3.0, "facs": "12C", "expression": True, "plays": {"label": "joy", "parts": []}},
    ],
    "duration": 4,
}


def test_keyframes_come_out_in_order_of_time():
    timeline = Timeline.from_json(GOOD)
    assert [k.time for k in timeline.keyframes] == [0.0, 1.0, 2.0, 3.0]
    assert timeline.keyframes[0].action_units == {"AU12": 0.5, "L4": 0.4}
    assert timeline.keyframes[1].layer == "emotion"
    assert timeline.keyframes[1].emotion == ("joy", 0.8)
    assert timeline.keyframes[2].action_units == {"AU1": 0.6, "AU2": 0.6}
    assert timeline.keyframes[3].plays == {"label": "joy", "parts": []}
    assert timeline.duration == 4.0


def test_letters_are_read_on_the_scale_that_a_keyframe_names():
    entry = {"scale": "banded", "facs": "12A+15:0.37", "action_units": {"AU4": "d"}}
    (keyframe,) = Timeline.from_json({"timeline": [entry]}).keyframes
    assert keyframe.action_units == {"AU12": 0.1, "AU15": 0.37, "AU4": 0.9}


def test_what_is_written_reads_back_the_same():
    timeline = Timeline.from_json(GOOD)
    assert Timeline.from_json(timeline.to_json()) == timeline


def test_without_a_duration_it_lasts_a_second_longer_than_it_plays():
    entries = {"timeline": [{"time": 2.0, "fade": 0.5, "hold": 1.0, "action_units": {"AU1": 1}}]}
    assert Timeline.from_json(entries).duration == pytest.approx(2.0 + 0.5 + 1.0 + 0.4 + 1.0)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "timeline"),
        ({"timeline": []}, "one or more"),
        ({"timeline": [3]}, "keyframe 0"),
        ({"timeline": [{"tme": 1}]}, "'tme' is not known"),
        ({"timeline": [{"time": "now"}]}, "time is 'now'"),
        ({"timeline": [{"time": -1.0}]}, "time is -1.0"),
        ({"timeline": [{"time": float("nan")}]}, "finite"),
        ({"timeline": [{"layer": "top"}]}, "layer is 'top'"),
        ({"timeline": [{"action_units": {"AU1": True}}]}, "AU1 is True"),
        ({"timeline": [{"emotion": 5}]}, "emotion is 5"),
        ({"timeline": [{"plays": 5}]}, "plays is 5"),
        ({"timeline": [{"time": 10**400}]}, "keyframe 0: time"),
        ({"timeline": [{"time": 0}, {"facs": "12Z"}]}, "keyframe 1: facs"),
        ({"timeline": [{"scale": "log"}]}, "keyframe 0: .*'log'"),
        ({"timeline": [{"time": 0}], "duration": "long"}, "duration"),
        ({"timeline": [{"time": 0}], "duration": 10**400}, "duration"),
        ({"timeline": [{"time": 0}], "duration": -2}, "must lie between"),
    ],
)
def test_bad_timelines_say_what_is_wrong(data, message):
    with pytest.raises(InvalidTrack, match=message):
        Timeline.from_json(data)


def test_a_timeline_is_frozen_data():
    assert Timeline((Keyframe(time=1.0), Keyframe(time=0.5)), 2.0).keyframes[0].time == 0.5
