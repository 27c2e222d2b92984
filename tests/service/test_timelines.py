"""Timelines: the published schema says what is read, and errors say where."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from pydantic import ValidationError
from starlette.testclient import TestClient
from typer.testing import CliRunner

from engine import builtin_rig
from service.bodies import Controls, EmotionCommand, KeyframeBody, NewClip, SpeechCommand
from service.cli import app
from service.commands import clip_timeline
from service.errors import Refused
from service.schemas import timeline_schema
from service.speech import spoken

RIG = builtin_rig("standard")
FULL: dict[str, Any] = {
    "rig": "standard",
    "fps": 24,
    "level": "low",
    "textures": False,
    "duration": 4.0,
    "start": 0.5,
    "model": {"integrator": "verlet"},
    "idle": {"seed": 4, "blinks": 1.0},
    "timeline": [
        {"time": 0.0, "facs": "1C+2C+L12D+26", "scale": "banded", "fade": None, "weight": 0.8},
        {"time": 0.2, "action_units": {"AU12": 0.8, "L4": "B"}, "layer": "mood", "owner": "a"},
        {"time": 0.4, "muscles": {"zygomatic_major.L": 0.6}, "hold": 0.5, "fade_out": 0.1},
        {"time": 0.6, "jaw": {"pitch": 8.0}, "gaze": {"yaw": 4.0}, "head": {"roll": 2.0}},
        {"time": 0.7, "tongue": {"thrust": 0.0}, "ttl": 1.0, "replace": True},
        {"time": 0.8, "arkit": {"mouthSmileLeft": 0.7}},
        {"time": 0.9, "visemes": {"aa": 0.7}},
        {"time": 1.0, "emotion": "joy", "fade_in": 0.2},
        {"time": 1.5, "emotion": {"scores": [{"label": "joy", "score": 0.6}], "hold": 1.0}},
        {"time": 1.8, "speech": {"visemes": [{"viseme": "PP", "time": 0.0}], "owner": "voice"}},
        {"time": 2.0, "emotion": {"valence": 0.5, "arousal": 0.2}, "expression": True},
    ],
}


def accepted(data: object) -> bool:
    return bool(Draft202012Validator(timeline_schema()).is_valid(data))


def test_the_schema_is_one_and_takes_every_field_that_is_read(client: TestClient) -> None:
    published = client.get("/api/schemas/timeline.json").json()
    Draft202012Validator.check_schema(published)
    assert published == json.loads(CliRunner().invoke(app, ["clip", "--schema"]).stdout)
    used = set().union(*FULL["timeline"])
    assert used == set(KeyframeBody.model_fields) >= set(Controls.model_fields)
    assert set(published["$defs"]["KeyframeBody"]["properties"]) == used
    assert set(published["$defs"]["EmotionCommand"]["properties"]) == {*EmotionCommand.model_fields}
    assert accepted(FULL)
    timeline, _ = clip_timeline(NewClip.model_validate(FULL), builtin_rig("standard"))
    told = [each["time"] for each in FULL["timeline"] if "speech" not in each]
    assert [each.time for each in timeline.keyframes if each.owner != "voice"] == told


WRONG = [
    {"fade": "x"},
    {"hold": -1},
    {"layer": "pupet"},
    {"action_units": {"AU12": 2}},
    {"gaze": {"yaw": 1e9}},
    {"jaw": {"pich": 1}},
    {"owner": "a b"},
    {"emotion": {"label": "joy", "intensity": 3}},
    {"nope": 1},
]


@pytest.mark.parametrize("fields", WRONG, ids=str)
def test_what_is_not_read_the_schema_does_not_take(fields: dict[str, Any]) -> None:
    wrong = {"timeline": [{"time": 0.0}, {"time": 1.0, **fields}]}
    assert not accepted(wrong)
    with pytest.raises(ValidationError):
        NewClip.model_validate(wrong)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"action_units": {"AU99": 1.0}}, "keyframe 1: action_units: FACS has no code 99"),
        ({"facs": "99Q"}, "keyframe 1: facs: cannot read '99Q'"),
        ({"muscles": {"zyg": 1.0}}, "keyframe 1: muscles: there is no muscle named 'zyg'"),
        ({"arkit": {"jawOpn": 1.0}}, "keyframe 1: arkit: there is no ARKit shape"),
        ({"visemes": {"zz": 1.0}}, "keyframe 1: visemes: there is no viseme"),
        ({"emotion": {"scores": [{"label": "joi", "score": 1.0}]}}, "keyframe 1: emotion: there"),
        (
            {"speech": {"visemes": [{"viseme": "zz", "time": 0.0}]}},
            "keyframe 1: speech: there is no viseme",
        ),
        ({"jaw": {"pitch": 100.0}}, "keyframe 1: jaw.pitch is 100; it must lie"),
        ({"fade": 1.0, "fade_in": 1.0}, "keyframe 1: give either 'fade' or 'fade_in'"),
    ],
    ids=str,
)
def test_what_a_rig_refuses_is_told_with_keyframe_and_field(
    fields: dict[str, Any], said: str
) -> None:
    clip = NewClip.model_validate({"timeline": [{"time": 0.0}, {"time": 1.0, **fields}]})
    with pytest.raises(Refused) as refused:
        clip_timeline(clip, builtin_rig("standard"))
    assert str(refused.value).startswith(said)


def test_what_cannot_be_read_is_told_with_keyframe_and_field(client: TestClient) -> None:
    wrong = {"timeline": [{"time": 0.0}, {"time": 1.0, "fade": "x"}]}
    answer = client.post("/api/clips", json=wrong)
    assert answer.status_code == 422
    assert answer.json()["message"] == "timeline.1.fade is 'x'; expected a number"


WORD = [
    {"viseme": "PP", "time": 0.0},
    {"viseme": "aa", "time": 0.1},
    {"viseme": "sil", "time": 0.3},
]


def test_a_speech_of_a_timeline_is_that_of_a_live_face() -> None:
    rig = builtin_rig("standard")
    clip = NewClip.model_validate({"timeline": [{"time": 0.5, "speech": {"visemes": WORD}}]})
    timeline, warnings = clip_timeline(clip, rig)
    live = spoken(SpeechCommand.model_validate({"visemes": WORD}), rig).keyframes
    assert warnings == []
    assert list(timeline.keyframes) == [replace(each, time=0.5 + each.time) for each in live]


def test_a_speech_takes_the_place_of_what_its_owner_has_still_to_say() -> None:
    def times(second: str) -> list[float]:
        said = [
            {"time": 0.2, "speech": {"visemes": WORD, "owner": second}},
            {"time": 0.0, "speech": {"visemes": WORD, "owner": "a"}},
        ]
        timeline, _ = clip_timeline(NewClip.model_validate({"timeline": said}), RIG)
        return [each.time for each in timeline.keyframes if each.owner == "a"]

    alone = times("b")
    first = [time for time in alone if time < 0.2]
    assert 0 < len(first) < len(alone)
    assert times("a") == first + [0.2 + time for time in alone]


def test_speeches_are_bounded_together() -> None:
    long = {"visemes": [{"viseme": "aa", "time": 0.01 * index} for index in range(6000)]}
    with pytest.raises(ValidationError, match="12000 visemes"):
        NewClip.model_validate({"timeline": [{"time": 0.0, "speech": long}] * 2})
