"""Clips over HTTP: queued, waited for, taken away, cancelled."""

from __future__ import annotations

import csv
import io

import pytest
from conftest import until
from starlette.testclient import TestClient

SMILE = {
    "rig": "standard",
    "fps": 30,
    "timeline": [
        {"time": 0.0, "action_units": {"AU12": 0.8}, "fade": 0.1},
        {"time": 0.3, "facs": "1C", "fade": 0.1},
        {"time": 0.4, "emotion": "joy"},
    ],
    "duration": 0.5,
}


def test_a_short_clip_is_waited_for(client: TestClient) -> None:
    answer = client.post("/api/clips", params={"wait": 60}, json=SMILE)
    assert answer.status_code == 200, answer.text
    assert answer.headers["Content-Type"] == "model/gltf-binary"
    assert answer.content[:4] == b"glTF"
    clip = client.get(answer.headers["Location"]).json()
    assert clip["status"] == "done"
    assert clip["progress"] == 1.0
    assert clip["report"]["frames"] == 16


@pytest.mark.parametrize("asked", ["query", "body"])
def test_a_clip_leaves_the_maps_out(client: TestClient, asked: str) -> None:
    params = {"wait": 60, "textures": 0} if asked == "query" else {"wait": 60}
    body = SMILE if asked == "query" else {**SMILE, "textures": False}
    bare = client.post("/api/clips", params=params, json=body)
    full = client.post("/api/clips", params={"wait": 60}, json=SMILE)
    assert b'"albedo"' not in bare.content
    assert b'"albedo"' in full.content


@pytest.mark.parametrize("asked", ["gain=2", "fps=24", "tolerance=null", "sparse=0&wait=1"])
def test_a_timeline_does_not_lose_what_the_address_asks_for(client: TestClient, asked: str) -> None:
    answer = client.post(f"/api/clips?{asked}", json=SMILE)
    assert answer.status_code == 422
    assert answer.json()["error"] == "invalid_query"
    assert f"{asked.partition('=')[0]!r} in the address" in answer.json()["message"]


def test_a_clip_is_queued_and_done(client: TestClient) -> None:
    answer = client.post("/api/clips", json=SMILE)
    assert answer.status_code == 202
    location = answer.headers["Location"]
    early = client.get(f"{location}.glb")
    assert early.status_code in (200, 409)
    until(lambda: client.get(location).json()["status"] == "done")
    assert client.get(f"{location}.glb").content[:4] == b"glTF"
    rows = list(csv.reader(io.StringIO(client.get(f"{location}.csv").text)))
    assert len(rows) == 1 + 16
    at = rows[0].index("zygomatic_major.L")
    assert float(rows[1][at]) == 0.0
    assert float(rows[-1][at]) > 0.3
    corner = rows[0].index("y_54")
    assert float(rows[-1][corner]) > float(rows[1][corner]) + 1.0
    assert answer.json()["id"] in {line["id"] for line in client.get("/api/clips").json()["clips"]}
    assert client.delete(location).status_code == 204
    assert client.get(location).status_code == 404
    assert client.get(f"{location}.glb").status_code == 404


def test_a_clip_on_its_way_is_cancelled(client: TestClient) -> None:
    long = {**SMILE, "duration": 100.0}
    location = client.post("/api/clips", json=long).headers["Location"]
    waiting = client.post("/api/clips", json=long).headers["Location"]
    assert client.delete(location).status_code == 204
    assert client.delete(waiting).status_code == 204
    for place in (location, waiting):
        assert client.get(place).json()["status"] == "cancelled"
        refused = client.get(f"{place}.glb")
        assert refused.status_code == 409
        assert refused.json()["error"] == "clip_not_done"


@pytest.mark.parametrize(
    ("kind", "content", "said"),
    [
        ("text/plain", "frame,AU12_r\n1,0.5\n", "text/csv"),
        ("application/json", "", "the body is empty"),
        ("", "", "the body is empty"),
    ],
)
def test_what_is_no_clip_by_its_type_is_told_what_is(
    client: TestClient, kind: str, content: str, said: str
) -> None:
    answer = client.post("/api/clips", content=content, headers={"Content-Type": kind})
    assert (answer.status_code, answer.json()["error"]) == (422, "invalid_body")
    assert said in answer.json()["message"]


@pytest.mark.parametrize(
    "changes",
    [
        {"rig": "nobody"},
        {"fps": 0},
        {"fps": 61},
        {"fps": "many"},
        {"timeline": [{"time": -1}]},
        {"timeline": [{"action_units": {"AU12": 1}}]},
        {"timeline": [{"time": 0, "action_units": {"AU99": 1}}]},
        {"timeline": [{"time": 0, "visemes": {"zz": 1}}]},
        {"timeline": [{"time": 0, "emotion": "zzz"}]},
        {"timeline": [{"time": 0, "emotion": {}}]},
        {"duration": 0},
        {"duration": 1e6},
        {"timeline": [{"time": 0, "emotion": "joy", "ttl": 5000}]},
        {"duration": None, "timeline": [{"time": 80_000}]},
        {"more": 1},
    ],
)
def test_a_clip_that_cannot_be_rendered_is_refused(
    client: TestClient, changes: dict[str, object]
) -> None:
    answer = client.post("/api/clips", json={**SMILE, **changes})
    assert answer.status_code in (404, 422), answer.text
    assert set(answer.json()) <= {"error", "message", "known"}


@pytest.mark.parametrize("wait", ["-1", "61", "nan", "inf", "soon"])
def test_waiting_is_bounded(client: TestClient, wait: str) -> None:
    answer = client.post("/api/clips", params={"wait": wait}, json=SMILE)
    assert answer.status_code == 422


def test_a_scored_emotion_can_be_a_keyframe(client: TestClient) -> None:
    scores = [{"label": "joy", "score": 0.5}, {"label": "fear", "score": 0.5}]
    timeline = [{"time": 0.0, "emotion": {"scores": scores, "fade_in": 0.1}}]
    body = {**SMILE, "timeline": timeline, "duration": 0.2}
    assert client.post("/api/clips", params={"wait": 60}, json=body).status_code == 200


@pytest.mark.parametrize("path", ["", ".glb", ".csv"])
def test_an_unknown_clip_is_not_found(client: TestClient, path: str) -> None:
    answer = client.get(f"/api/clips/nobody{path}")
    assert answer.status_code == 404
    assert answer.json()["error"] == "unknown_clip"
