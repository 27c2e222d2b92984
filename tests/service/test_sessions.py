"""Sessions over HTTP: opened, commanded, read, closed."""

from __future__ import annotations

import asyncio
import re

import pytest
from conftest import parts_of, until
from starlette.testclient import TestClient


def control(client: TestClient, session: str, **body: object) -> dict[str, object]:
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def merged(client: TestClient, session: str) -> dict[str, dict[str, float]]:
    return client.get(f"/api/sessions/{session}").json()["merged"]


def layers(client: TestClient, session: str) -> dict[str, dict[str, object]]:
    return client.get(f"/api/sessions/{session}").json()["layers"]


def test_a_session_is_opened_listed_and_closed(client: TestClient) -> None:
    answer = client.post("/api/sessions", json={"rig": "standard"})
    assert answer.status_code == 201
    opened = answer.json()
    assert re.fullmatch(r"[a-z0-9_-]{1,64}", opened["id"])
    assert opened["stream"] == f"/api/sessions/{opened['id']}/stream"
    assert answer.headers["Location"] == f"/api/sessions/{opened['id']}"
    assert opened["id"] in {line["id"] for line in client.get("/api/sessions").json()["sessions"]}
    assert client.delete(f"/api/sessions/{opened['id']}").status_code == 204
    gone = client.get(f"/api/sessions/{opened['id']}")
    assert gone.status_code == 404
    assert gone.json()["error"] == "unknown_session"


def test_a_session_runs_the_model_it_asks_for(client: TestClient) -> None:
    body = {"rig": "standard", "model": {"integrator": "symplectic_euler"}}
    answer = client.post("/api/sessions", json=body)
    assert answer.status_code == 201
    session = answer.json()["id"]
    own = client.get("/api/rigs/standard").json()["model"]
    assert answer.json()["model"] == {**own, "integrator": "symplectic_euler"}
    home = parts_of(client).runner._home[session]
    assert home.simulator.model.integrator == "symplectic_euler"
    control(client, session, action_units={"AU12": 1.0})
    client.delete(f"/api/sessions/{session}")


def test_patch_moves_what_is_named_and_put_replaces(client: TestClient, session: str) -> None:
    control(client, session, action_units={"AU12": 0.8, "L4": "B"})
    control(client, session, action_units={"AU1": "C"}, jaw={"pitch": 10})
    assert layers(client, session)["puppet"]["action_units"] == {"AU12": 0.8, "L4": 0.4, "AU1": 0.6}
    answer = client.put(f"/api/sessions/{session}/controls", json={"action_units": {"R12": 0.5}})
    assert answer.status_code == 200
    assert layers(client, session)["puppet"]["action_units"] == {"R12": 0.5}


def test_letters_can_be_read_by_their_bands(client: TestClient, session: str) -> None:
    control(client, session, facs="1C+L12D+26", scale="banded", action_units={"AU4": "B"})
    held = layers(client, session)["puppet"]["action_units"]
    assert held == {"AU1": 0.55, "L12": 0.9, "AU26": 0.55, "AU4": 0.2}


def test_every_part_of_the_face_can_be_commanded(client: TestClient, session: str) -> None:
    control(
        client,
        session,
        muscles={"zygomatic_major.L": 0.6},
        jaw={"pitch": 12, "yaw": 2},
        gaze={"yaw": 10, "pitch": -5, "vergence": 6},
        head={"yaw": 5, "pitch": 5, "roll": 5, "thrust": 8},
        tongue={"thrust": 7},
        layer="speech",
        weight=1.0,
    )
    until(lambda: merged(client, session)["head"]["roll"] == pytest.approx(5, abs=0.01))
    state = merged(client, session)
    assert state["muscles"]["zygomatic_major.L"] == pytest.approx(0.6)
    assert state["jaw"]["pitch"] == pytest.approx(12)
    assert state["gaze"] == {
        "yaw": pytest.approx(10),
        "pitch": pytest.approx(-5),
        "vergence": pytest.approx(6, abs=0.01),
    }
    assert state["head"]["thrust"] == pytest.approx(8, abs=0.1)
    assert state["tongue"] == {"thrust": pytest.approx(7, abs=0.01)}


def test_a_command_with_a_time_to_live_lapses(client: TestClient, session: str) -> None:
    control(client, session, action_units={"AU12": 1.0}, ttl=0.3)
    assert "puppet" in layers(client, session)
    until(lambda: "puppet" not in layers(client, session), seconds=20)


def test_the_tick_is_that_of_the_next_step(client: TestClient, session: str) -> None:
    first = control(client, session, action_units={"AU12": 1.0})
    second = control(client, session, action_units={"AU12": 0.5})
    assert second["tick"] >= first["tick"] >= 0
    assert second["warnings"] == []


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ({"facs": "12C+12D"}, "AU12 is named twice in facs"),
        ({"facs": "12C", "action_units": {"AU12": 0.8}}, "AU12 is named in facs and in action_un"),
        ({"action_units": {"AU12": 0.8, "12": 0.2}}, "AU12 is named twice in action_units"),
        ({"action_units": {"AU12": 0.8, "L12": 0.2}}, "AU12 and L12 are both named"),
        ({"facs": "26C", "jaw": {"pitch": 5}}, "jaw.pitch is named itself, so AU26"),
        (
            {"facs": "L12C", "muscles": {"zygomatic_major.L": 0.2}},
            "zygomatic_major.L is named itself, so L12",
        ),
    ],
)
def test_clashing_units_are_named(
    client: TestClient, session: str, body: dict[str, object], said: str
) -> None:
    warnings = control(client, session, **body)["warnings"]
    assert [warning for warning in warnings if warning.startswith(said)], warnings
    clip = {"timeline": [{"time": 0.0, **body}], "duration": 0.1}
    row = client.post("/api/clips", json=clip).json()
    until(lambda: client.get(f"/api/clips/{row['id']}").json()["status"] == "done")
    report = client.get(f"/api/clips/{row['id']}").json()["report"]
    assert [line for line in report["warnings"] if said in line]


def test_units_that_do_not_clash_are_not_warned_of(client: TestClient, session: str) -> None:
    body = {"facs": "1C+L12D+R12B+26", "jaw": {"yaw": 2}, "muscles": {"risorius.L": 0.2}}
    assert control(client, session, **body)["warnings"] == []


@pytest.mark.parametrize(
    "body",
    [
        {"action_units": {"AU12": 1.5}},
        {"action_units": {"AU12": -0.1}},
        {"action_units": {"AU12": "F"}},
        {"action_units": {"AU99": 0.5}},
        {"action_units": {"Ω": 0.5}},
        {"facs": "12+nonsense"},
        {"facs": ""},
        {"muscles": {"biceps.L": 1}},
        {"jaw": {"pitch": 170}},
        {"gaze": {"roll": 1}},
        {"layer": "clouds"},
        {"weight": 2},
        {"ttl": 0},
        {"fade": -1},
        {"surprise": 1},
        [],
        None,
    ],
)
def test_a_command_that_cannot_be_obeyed_is_refused(
    client: TestClient, session: str, body: object
) -> None:
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 422
    assert set(answer.json()) <= {"error", "message", "known"}
    assert layers(client, session) == {}


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "9" * 5000])
def test_no_number_beyond_reason_is_accepted(client: TestClient, session: str, number: str) -> None:
    answer = client.patch(
        f"/api/sessions/{session}/controls",
        content=f'{{"action_units": {{"AU12": {number}}}}}',
        headers={"Content-Type": "application/json"},
    )
    assert answer.status_code in (400, 422)
    assert set(answer.json()) <= {"error", "message", "known"}


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"\xff\xfe", b'{"facs": "\\ud800"}', b"[" * 100_000, b'{"\\ud800": 1}'],
)
def test_bytes_that_are_not_a_body_are_refused(
    client: TestClient, session: str, content: bytes
) -> None:
    answer = client.patch(
        f"/api/sessions/{session}/controls",
        content=content,
        headers={"Content-Type": "application/json"},
    )
    assert answer.status_code in (400, 422)
    assert set(answer.json()) <= {"error", "message", "known"}


def test_an_emotion_is_played_with_its_recipe_and_source(client: TestClient, session: str) -> None:
    answer = client.post(
        f"/api/sessions/{session}/emotions", json={"label": "joy", "intensity": 0.8, "fade_in": 0.1}
    )
    assert answer.status_code == 200
    assert re.fullmatch(r"[LR\dA-E+]+", answer.json()["recipe"])
    assert answer.json()["source"]
    assert layers(client, session)["emotion"]["emotion"]["intensity"] == 0.8


def test_scored_labels_are_blended(client: TestClient, session: str) -> None:
    scores = [{"label": "joy", "score": 0.8}, {"label": "surprise", "score": 0.2}]
    answer = client.post(f"/api/sessions/{session}/emotions", json={"scores": scores})
    assert answer.status_code == 200
    units = answer.json()["action_units"]
    assert units["AU12"] > units["AU2"] > 0


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"label": "joy", "scores": [{"label": "joy", "score": 1}]},
        {"label": "zzz"},
        {"scores": []},
        {"scores": [{"label": "joy", "score": 0}]},
        {"label": "joy", "hold": -1},
    ],
)
def test_an_emotion_that_cannot_be_played_is_refused(
    client: TestClient, session: str, body: dict[str, object]
) -> None:
    answer = client.post(f"/api/sessions/{session}/emotions", json=body)
    assert answer.status_code == 422
    if body.get("label") == "zzz":
        assert answer.json()["error"] == "unknown_emotion"
        assert "happiness" in answer.json()["known"]


def test_a_face_can_be_taken_away_as_glb(client: TestClient, session: str) -> None:
    control(client, session, action_units={"AU12": 1.0})
    answer = client.get(f"/api/sessions/{session}.glb")
    assert answer.status_code == 200
    assert answer.headers["Content-Type"] == "model/gltf-binary"
    assert answer.content[:4] == b"glTF"


@pytest.mark.parametrize("path", ["", ".glb", "/controls", "/emotions", "/tissue"])
def test_an_unknown_session_is_not_found(client: TestClient, path: str) -> None:
    method = {"": "GET", ".glb": "GET", "/emotions": "POST"}.get(path, "PATCH")
    body = {"label": "joy"} if path == "/emotions" else {}
    answer = client.request(method, f"/api/sessions/nobody{path}", json=body)
    assert answer.status_code == 404
    assert answer.json()["error"] == "unknown_session"


def test_a_busy_database_does_not_end_the_beat(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    def busy(*_: object, **__: object) -> None:
        raise OSError("the database is locked")

    sessions = parts_of(client).sessions
    monkeypatch.setattr(sessions._store, "remove_idle_sessions", busy)
    asyncio.run(sessions._forget_sleepers())
    assert not any(task.done() for task in sessions._tasks)
