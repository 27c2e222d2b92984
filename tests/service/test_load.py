"""Admission by measurement: what faces cost, and who is refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

from service.app import create_app
from service.errors import AtCapacity
from service.load import TICK_SECONDS, Load

NEVER_STILL = {"facs": "12E+26E+1E", "fade": 600.0}


def loaded(*, threads: int = 1, face_share: float, share: float = 0.85) -> Load:
    """Return a load that has seen one face take that share of a tick for long."""
    load = Load(threads=threads, share=share)
    for _ in range(1000):
        load.note(face_share * TICK_SECONDS, 1)
    return load


def test_faces_are_let_in_until_one_more_would_be_too_much() -> None:
    load = loaded(face_share=0.2)
    for awake in range(4):
        load.admit(awake)
    with pytest.raises(AtCapacity, match="4 faces are awake, which takes 80% of a tick; one more"):
        load.admit(4)


def test_faces_that_are_stepped_side_by_side_share_a_tick() -> None:
    load = loaded(threads=3, face_share=0.5)
    load.admit(2)
    with pytest.raises(AtCapacity, match="would make it 100%"):
        load.admit(3)


def test_the_cost_follows_what_is_measured() -> None:
    load = loaded(face_share=0.5)
    with pytest.raises(AtCapacity):
        load.admit(1)
    for _ in range(5000):
        load.note(4 * 0.1 * TICK_SECONDS, 4)
    load.admit(4)
    assert load.share_of(4) == pytest.approx(0.4, rel=0.01)


def test_nothing_is_refused_before_anything_was_measured() -> None:
    Load(threads=1, share=0.85).admit(100)


def test_a_machine_too_slow_for_one_face_moves_one() -> None:
    load = loaded(face_share=3.0)
    load.admit(0)
    with pytest.raises(AtCapacity, match="1 face is awake"):
        load.admit(1)


def test_a_tick_that_took_seconds_is_soon_forgotten() -> None:
    load = Load(threads=1, share=0.85)
    load.note(5.0, 1)
    for _ in range(600):
        load.note(0.1 * TICK_SECONDS, 1)
    load.admit(4)


def test_faces_that_are_stepped_in_a_batch_cost_little_more_than_one() -> None:
    load = loaded(face_share=0.6)
    with pytest.raises(AtCapacity):
        load.admit(1)
    for _ in range(100):
        load.note(0.61 * TICK_SECONDS, 2)
    load.admit(2)
    load.admit(10)
    assert load.share_of(11) == pytest.approx(0.7, rel=0.02)


def test_what_was_too_slow_once_is_tried_again_after_a_minute() -> None:
    load = loaded(face_share=0.1)
    for _ in range(100):
        load.note(1.5 * TICK_SECONDS, 2)
    for _ in range(3000):
        load.note(0.1 * TICK_SECONDS, 1)
    with pytest.raises(AtCapacity):
        load.admit(1)
    for _ in range(1000):
        load.note(0.1 * TICK_SECONDS, 1)
    load.admit(1)


def test_ticks_without_faces_say_nothing_of_their_cost() -> None:
    load = loaded(face_share=0.3)
    for _ in range(1000):
        load.note(1e-6, 0)
    assert load.share_of(2) == pytest.approx(0.6, rel=0.01)


@pytest.fixture
def full(tmp_path: Path) -> Iterator[TestClient]:
    """A service that one moving face fills."""
    app = create_app(settings_in(tmp_path, capacity_share=1e-6))
    with TestClient(app, base_url=LOCAL) as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        yield client


def open_session(client: TestClient) -> str:
    """Open a session as soon as there is room."""
    answer = client.post("/api/sessions", json={})

    def opened() -> bool:
        nonlocal answer
        if answer.status_code == 429:
            answer = client.post("/api/sessions", json={})
        return answer.status_code == 201

    until(opened)
    return str(answer.json()["id"])


def move(client: TestClient, session: str) -> int:
    answer = client.put(f"/api/sessions/{session}/controls", json=NEVER_STILL)
    return answer.status_code


def test_a_full_service_refuses_new_sessions_and_wakes_old_ones(full: TestClient) -> None:
    first, second = open_session(full), open_session(full)
    assert move(full, first) == 200
    until(lambda: full.get("/api/health").json()["pace"]["load"] > 0)
    refused = full.post("/api/sessions", json={})
    assert refused.status_code == 429
    assert int(refused.headers["Retry-After"]) > 0
    assert refused.json()["error"] == "at_capacity"
    assert " awake, which takes " in refused.json()["message"]
    # A burst of waking faces is not refused, only counted.
    assert move(full, second) == 200
    until(lambda: full.get("/api/health").json()["pace"]["awake"] == 2)
    assert len(full.get("/api/sessions").json()["sessions"]) == 2
    before = full.get("/api/health").json()["pace"]["ticks"]
    until(lambda: full.get("/api/health").json()["pace"]["ticks"] > before + 10)
    for session in (first, second):
        assert full.delete(f"/api/sessions/{session}").status_code == 204
    assert full.post("/api/sessions", json={}).status_code == 201


def test_a_stored_session_is_woken_at_capacity(tmp_path: Path) -> None:
    settings = settings_in(tmp_path, capacity_share=1e-6)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        stored, moving = open_session(client), open_session(client)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        assert move(client, moving) == 200
        until(lambda: client.get("/api/health").json()["pace"]["load"] > 0)
        assert client.post("/api/sessions", json={}).status_code == 429
        assert client.get(f"/api/sessions/{stored}").status_code == 200


def test_sleeping_faces_do_not_count(full: TestClient) -> None:
    sessions = [open_session(full) for _ in range(3)]
    until(lambda: full.get("/api/health").json()["pace"]["awake"] == 0)
    assert full.post("/api/sessions", json={}).status_code == 201
    assert len(sessions) == 3


def test_the_measured_cost_decides(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    load = parts_of(client).runner.load
    monkeypatch.setattr(load, "share", 0.85)
    monkeypatch.setattr(load, "note", lambda *_: None)
    moving = open_session(client)
    assert move(client, moving) == 200
    monkeypatch.setattr(load, "_seconds", lambda awake: 10 * awake * TICK_SECONDS)
    assert client.post("/api/sessions", json={}).status_code == 429
    monkeypatch.setattr(load, "_seconds", lambda awake: 0.001 * awake * TICK_SECONDS)
    answer = client.post("/api/sessions", json={})
    assert answer.status_code == 201
    for session in (moving, answer.json()["id"]):
        client.delete(f"/api/sessions/{session}")


def test_the_refusal_is_described(client: TestClient) -> None:
    described = client.get("/openapi.json").json()["paths"]["/api/sessions"]["post"]["responses"]
    assert "at_capacity" in described["429"]["description"]
    assert "Retry-After" in described["429"]["headers"]
    assert described["429"]["content"]["application/json"]["schema"]["required"]
