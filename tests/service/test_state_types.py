"""The viewer's types of a session and of its state have every field that the service sends."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

SOURCES = Path(__file__).parents[2] / "static" / "src"


def fields(name: str) -> set[str]:
    """Return the fields of an interface of the viewer, those that it takes over included."""
    text = "".join((SOURCES / file).read_text("utf-8") for file in ("protocol.ts", "api.ts"))
    found = re.search(rf"export interface {name}(?: extends (\w+))? \{{\n(.*?)\n\}}", text, re.S)
    assert found is not None, name
    own = set(re.findall(r"^  (\w+)\??:", found[2], re.M))
    return own | (fields(found[1]) if found[1] else set())


def keys(things: Iterable[dict[str, Any]]) -> set[str]:
    """Return every key that any of these has."""
    return {key for thing in things for key in thing}


@pytest.fixture(scope="module")
def told(client: TestClient) -> dict[str, Any]:
    """A session in which something of every kind is held."""
    path = f"/api/sessions/{client.post('/api/sessions', json={}).json()['id']}"
    scores = [{"label": "joy", "score": 0.5}, {"label": "surprise", "score": 0.4}]
    client.post(f"{path}/emotions", json={"scores": scores, "owner": "agent", "ttl": 60.0})
    pose = {"jaw": {"pitch": 3.0}, "gaze": {"yaw": 4.0}, "tongue": {"thrust": 2.0}}
    body = {**pose, "head": {"roll": 5.0}, "facs": "1C", "muscles": {"risorius.L": 0.3}}
    assert client.patch(f"{path}/controls", json=body).status_code == 200
    found: dict[str, Any] = client.get(path).json()
    client.delete(path)
    return found


def test_a_session_is_typed(told: dict[str, Any]) -> None:
    assert set(told) <= fields("SessionInfo")


def test_what_layers_and_their_writers_hold_is_typed(told: dict[str, Any]) -> None:
    layers = list(told["layers"].values())
    writers = [writer for layer in layers for writer in layer["writers"]]
    assert keys(layers) == fields("HeldLayer")
    assert keys(writers) == fields("Writer")


def test_what_plays_is_typed(told: dict[str, Any]) -> None:
    assert set(told["layers"]["emotion"]["emotion"]) == fields("Played")


def test_what_layers_make_together_is_typed(told: dict[str, Any]) -> None:
    assert fields("Merged") - set(told["merged"]) == {"weight", "emotion"}
    assert set(told["merged"]) <= fields("Merged")
