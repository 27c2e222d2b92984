"""Emotions over HTTP: by label, scores and coordinates; what they answer, and how they repeat."""

from __future__ import annotations

from typing import Any

import pytest
from starlette.testclient import TestClient

from engine import builtin_rig, lexicon, resolve_label
from service.bodies import EmotionCommand, NewClip
from service.commands import clip_timeline
from service.emotions import Turns, play_emotion
from service.errors import Refused

RECIPES = lexicon().recipes


def play(client: TestClient, session: str, **body: Any) -> dict[str, Any]:
    answer = client.post(f"/api/sessions/{session}/emotions", json=body)
    assert answer.status_code == 200, answer.text
    played: dict[str, Any] = answer.json()
    return played


def test_a_label_is_answered_with_where_its_face_comes_from(
    client: TestClient, session: str
) -> None:
    played = play(client, session, label="nervously", vocabulary="goemotions", seed=0)
    assert played["label"] == "nervousness"
    assert played["vocabulary"] == "goemotions"
    assert played["found"] == "inflection"
    assert played["recipe"] == RECIPES["nervousness"].variants[0].facs
    assert played["source"] == "ours"
    assert [part["recipe"] for part in played["parts"]] == ["nervousness"]
    assert played["warnings"] == []


def test_an_emoji_is_a_label(client: TestClient, session: str) -> None:
    assert play(client, session, label="😡")["parts"][0]["recipe"] == "rage"


def test_intensities_are_told_without_noise(client: TestClient, session: str) -> None:
    for intensity in (0.1, 0.3, 0.7):
        played = play(client, session, label="anger", seed=0, intensity=intensity)
        assert all(len(repr(value)) <= 8 for value in played["action_units"].values())


def test_a_label_played_again_looks_different(client: TestClient, session: str) -> None:
    faces = [play(client, session, label="anger")["recipe"] for _ in range(3)]
    assert faces[0] == RECIPES["anger"].variants[0].facs
    assert faces[0] != faces[1] != faces[2]


def test_a_seed_chooses_the_variant_and_takes_no_turn(client: TestClient, session: str) -> None:
    fixed = {play(client, session, label="joy", seed=1)["recipe"] for _ in range(2)}
    assert fixed == {RECIPES["happiness"].variants[RECIPES["happiness"].turn(1)].facs}
    assert play(client, session, label="joy")["parts"][0]["variant"] == 0


def test_a_variant_is_held_as_plain_units(client: TestClient, session: str) -> None:
    played = play(client, session, label="joy", seed=1, intensity=0.5, fade_in=0.0)
    held = client.get(f"/api/sessions/{session}").json()["layers"]["emotion"]
    assert held["action_units"] == pytest.approx(played["action_units"])
    assert held["emotion"]["parts"] == [
        {"recipe": "happiness", "weight": 1.0, "variant": RECIPES["happiness"].turn(1)}
    ]


@pytest.mark.parametrize(
    "body",
    [
        {"label": "joy"},
        {"label": "joyful", "seed": 1, "vocabulary": "goemotions"},
        {"scores": [{"label": "joy", "score": 0.6}, {"label": "surprise", "score": 0.3}]},
        {"valence": 0.4, "arousal": 0.6},
        {"label": "neutral"},
    ],
)
def test_a_session_names_what_plays_as_it_was_answered(
    client: TestClient, session: str, body: dict[str, Any]
) -> None:
    played = play(client, session, **body, intensity=0.5, owner="agent")
    client.patch(
        f"/api/sessions/{session}/controls",
        json={"layer": "emotion", "owner": "agent", "action_units": {"AU1": 0.2}},
    )
    (writer,) = client.get(f"/api/sessions/{session}").json()["layers"]["emotion"]["writers"]
    told = writer["emotion"]
    assert told["intensity"] == 0.5
    for name in ("label", "vocabulary", "found", "recipe"):
        assert told[name] == played[name]
    shares = [{name: part[name] for name in told["parts"][0]} for part in played["parts"]]
    assert told["parts"] == shares
    client.put(f"/api/sessions/{session}/controls", json={"layer": "emotion", "facs": "1C"})
    assert "emotion" not in client.get(f"/api/sessions/{session}").json()["layers"]["emotion"]


def test_coordinates_play_the_face_between(client: TestClient, session: str) -> None:
    played = play(client, session, valence=0.81, arousal=0.51, dominance=0.46)
    assert played["recipe"] == RECIPES["happiness"].variants[0].facs
    assert played["found"] == "coordinates"
    assert play(client, session, valence=0.0, arousal=0.0)["action_units"] == {}


def test_a_classifier_s_list_plays_one_face(client: TestClient, session: str) -> None:
    scores = [{"label": name, "score": 0.5} for name in ("joy", "neutral")]
    played = play(client, session, scores=scores, vocabulary="goemotions")
    full = resolve_label("joy").units
    assert played["action_units"] == pytest.approx({k: 0.5 * v for k, v in full.items()})


@pytest.mark.parametrize(
    ("body", "error"),
    [
        ({"label": "suprise"}, "unknown_emotion"),
        ({"label": "boredom", "vocabulary": "big6"}, "unknown_emotion"),
        ({"label": "joy", "vocabulary": "big7"}, "unknown_vocabulary"),
        ({"scores": [{"label": "suprise", "score": 1}]}, "unknown_emotion"),
        ({"valence": 0.5}, "invalid_body"),
        ({"dominance": 0.5}, "invalid_body"),
        ({"valence": 0.5, "arousal": 0.5, "label": "joy"}, "invalid_body"),
        ({"valence": 0.5, "arousal": 0.5, "vocabulary": "vrm"}, "invalid_body"),
        ({"valence": 1.5, "arousal": 0.5}, "invalid_body"),
        ({"label": "joy", "seed": -1}, "invalid_body"),
        ({"label": "joy", "seed": 1.5}, "invalid_body"),
    ],
)
def test_what_names_no_face_is_refused(
    client: TestClient, session: str, body: dict[str, Any], error: str
) -> None:
    answer = client.post(f"/api/sessions/{session}/emotions", json=body)
    assert answer.status_code == 422
    assert answer.json()["error"] == error
    if body.get("label") == "suprise":
        assert answer.json()["known"][0] == "surprise"
        assert "did you mean surprise" in answer.json()["message"]


def test_the_list_of_emotions_is_what_is_played(client: TestClient, session: str) -> None:
    listed = client.get("/api/emotions").json()
    assert {v["name"] for v in listed["vocabularies"]} == {*lexicon().vocabularies}
    for vocabulary in listed["vocabularies"]:
        assert vocabulary["source"]
        row = vocabulary["labels"][-1]
        played = play(client, session, label=row["label"], vocabulary=vocabulary["name"], seed=0)
        assert (played["recipe"], played["source"]) == (row["recipe"], row["source"])
    assert [recipe["name"] for recipe in listed["recipes"]] == [*RECIPES]
    assert all(variant["source"] for r in listed["recipes"] for variant in r["variants"])


def test_one_vocabulary_can_be_listed(client: TestClient) -> None:
    (only,) = client.get("/api/emotions?vocabulary=vrm").json()["vocabularies"]
    assert [row["label"] for row in only["labels"]][:3] == ["happy", "angry", "sad"]
    answer = client.get("/api/emotions?vocabulary=vmr")
    assert answer.status_code == 422
    assert answer.json()["error"] == "unknown_vocabulary"
    assert "did you mean vrm" in answer.json()["message"]


def test_emotions_that_a_client_gave_to_its_rig_come_first() -> None:
    rig = builtin_rig("standard").derive(emotions={"joy": {"recipe": "L12C", "synonyms": ["yay"]}})
    for label in ("joy", "Yay"):
        played = play_emotion(EmotionCommand(label=label), rig, Turns())
        assert played.describe()["recipe"] == "L12C"
        assert played.describe()["vocabulary"] == "rig"
        assert played.keyframe.emotion == ("joy", 1.0)
    other = play_emotion(EmotionCommand(label="joy", vocabulary="goemotions"), rig, Turns())
    assert other.describe()["recipe"] == RECIPES["happiness"].variants[0].facs


def test_a_rig_without_the_measured_face_plays_its_units() -> None:
    rig = builtin_rig("standard").derive(emotions={"fear": "1C"})
    played = play_emotion(EmotionCommand(label="fear", vocabulary="big6"), rig, Turns())
    assert played.keyframe.emotion is None
    assert played.keyframe.action_units == resolve_label("fear", vocabulary="big6").units


def test_a_refused_label_takes_no_turn() -> None:
    turns, rig = Turns(), builtin_rig("standard")
    with pytest.raises(Refused):
        play_emotion(EmotionCommand(label="xyzzy"), rig, turns)
    assert not turns


def test_a_clip_repeats_a_label_in_turns_and_the_same_way_each_time() -> None:
    rig = builtin_rig("standard")
    beats = [{"time": float(second), "emotion": "sadness"} for second in range(3)]
    clip = NewClip.model_validate({"timeline": beats, "duration": 4.0})
    timeline, _ = clip_timeline(clip, rig)
    assert timeline == clip_timeline(clip, rig)[0]
    first, second, third = timeline.keyframes
    assert first.emotion == ("sadness", 1.0)
    assert first.action_units != second.action_units != third.action_units
