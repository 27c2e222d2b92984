"""A live session is a timeline: played again it gives the same bits, also after a restart."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

from engine import Keyframe, Model, Rig, Simulator, Timeline, record
from service.app import create_app
from service.runner import Move
from service.sessions import Session
from service.store import Store
from service.tail import Command


def live(client: TestClient, session: str) -> Session:
    parts = parts_of(client)
    return client.portal.call(parts.sessions.get, session)  # type: ignore[union-attr]


def asleep(client: TestClient, session: str) -> bool:
    state = client.get(f"/api/sessions/{session}").json()
    return bool(state["asleep"]) and "emotion" not in state["layers"]


def drive(client: TestClient, session: str) -> None:
    """Command a face at odd moments, over every kind of route."""
    path = f"/api/sessions/{session}"
    words = [{"viseme": name, "duration": 0.07} for name in ("PP", "aa", "FF", "ou", "kk")]
    client.post(f"{path}/speech", json={"visemes": words})
    client.patch(f"{path}/controls", json={"action_units": {"AU12": 1}, "fade": 0.2})
    time.sleep(0.13)
    client.post(f"{path}/emotions", json={"label": "joy", "fade_in": 0.1, "hold": 0.4})
    time.sleep(0.21)
    client.put(f"{path}/controls", json={"facs": "1C+L4B", "head": {"yaw": 10}})
    time.sleep(0.08)
    client.patch(f"{path}/controls", json={"jaw": {"pitch": 9}, "layer": "speech", "fade": 0.05})


def without_since(layers: dict[str, Any]) -> dict[str, Any]:
    """Return what layers hold without since when: a restart begins to count anew."""
    for layer in layers.values():
        for writer in layer["writers"]:
            del writer["since"]
    return layers


def replayed(rig: Rig, commands: list[Command], until_tick: int, model: Model) -> np.ndarray:
    """Return the displacements a fresh simulator reaches by the same commands."""
    simulator, tick = Simulator(rig, model=model), 0
    simulator.add("a")
    for command in [*commands, None]:
        for _ in range(tick, command.tick if command else until_tick):
            simulator.step()
        tick = command.tick if command else until_tick
        if command is None:
            break
        if isinstance(command.command, Move):
            other = Simulator(command.command.rig, model=model)
            other.add("a", state=simulator.remove("a"))
            simulator = other
        else:
            simulator.apply("a", command.command)
    return simulator.frame("a").displacements


def test_a_session_played_again_gives_the_same_bits(client: TestClient, session: str) -> None:
    drive(client, session)
    until(lambda: asleep(client, session))
    face = live(client, session)
    commands = list(face.commands)
    again = replayed(face.rig, commands, face.frame.tick, face.model)
    np.testing.assert_array_equal(again, face.frame.displacements)


def test_a_session_recorded_as_a_clip_gives_the_same_bits(client: TestClient, session: str) -> None:
    drive(client, session)
    until(lambda: asleep(client, session))
    face = live(client, session)
    keyframes = tuple(
        replace(command.command, time=command.tick / 60)
        for command in face.commands
        if isinstance(command.command, Keyframe)
    )
    timeline = Timeline(keyframes, face.frame.tick / 60)
    clip = record(face.rig, timeline, fps=60, model=face.model)
    np.testing.assert_array_equal(
        clip.displacements[-1], face.frame.displacements.astype(np.float32)
    )


def test_a_live_edit_is_on_the_timeline(client: TestClient, session: str) -> None:
    rig = live(client, session).rig
    drive(client, session)
    path = f"/api/sessions/{session}/muscles/zygomatic_major.L"
    assert client.patch(path, json={"strength": 1.3}).status_code == 200
    client.patch(f"/api/sessions/{session}/controls", json={"action_units": {"AU12": 0.7}})
    until(lambda: asleep(client, session))
    face = live(client, session)
    assert any(isinstance(command.command, Move) for command in face.commands)
    again = replayed(rig, list(face.commands), face.frame.tick, face.model)
    np.testing.assert_array_equal(again, face.frame.displacements)


def test_a_restarted_service_has_its_sessions_and_clips(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        path = f"/api/sessions/{session}"
        client.patch(f"{path}/controls", json={"action_units": {"AU12": 0.8, "L4": 0.4}})
        client.patch(f"{path}/controls", json={"action_units": {"L4": 0}, "jaw": {"pitch": 5}})
        client.post(f"{path}/emotions", json={"label": "joy", "intensity": 0.5})
        rig = client.patch(f"{path}/tissue", json={}).json()["rig"]
        edit = client.patch(f"{path}/muscles/zygomatic_major.L", json={"strength": 1.2})
        before = client.get(path).json()
        long = {"timeline": [{"time": 0}], "duration": 100}
        clip = client.post("/api/clips", json=long).headers["Location"]
        done = client.post(
            "/api/clips", params={"wait": 0}, json={"timeline": [{"time": 0}], "duration": 0.1}
        ).headers["Location"]
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        assert session in {line["id"] for line in client.get("/api/sessions").json()["sessions"]}
        after = client.get(path).json()
        assert without_since(after["layers"]) == without_since(before["layers"])
        assert after["rig"] == edit.json()["rig"] != rig
        assert client.get(clip).json()["status"] in ("queued", "running")
        assert client.delete(clip).status_code == 204
        until(lambda: client.get(done).json()["status"] == "done")


def test_a_clip_that_cannot_be_read_any_more_fails_alone(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    store = Store(settings.database)
    store.add_clip("old", rig="standard", fps=30, request={"timeline": [], "gone": 1})
    store.add_clip("new", rig="standard", fps=30, request={"timeline": [], "duration": 0.1})
    store.close()
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        until(lambda: client.get("/api/clips/new").json()["status"] == "done")
        old = client.get("/api/clips/old").json()
    assert old["status"] == "failed"
    assert "gone" in old["message"]


@pytest.mark.parametrize("gone", ["a", "session"])
def test_a_closed_session_does_not_come_back(tmp_path: Path, gone: str) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        client.delete(f"/api/sessions/{session}")
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        name = session if gone == "session" else gone
        assert client.get(f"/api/sessions/{name}").status_code == 404
