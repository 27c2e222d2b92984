"""Layers and leases over HTTP: owners that share a layer, and what a session says of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import LOCAL, settings_in, until
from starlette.testclient import TestClient

from service.app import create_app


def write(client: TestClient, session: str, **body: object) -> dict[str, Any]:
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 200, answer.text
    return dict(answer.json())


def put(client: TestClient, session: str, **body: object) -> None:
    assert client.put(f"/api/sessions/{session}/controls", json=body).status_code == 200


def state(client: TestClient, session: str) -> dict[str, Any]:
    return dict(client.get(f"/api/sessions/{session}").json())


def units(client: TestClient, session: str, layer: str = "puppet") -> dict[str, float]:
    return dict(state(client, session)["layers"].get(layer, {}).get("action_units", {}))


def test_a_write_without_an_owner_is_anyones(client: TestClient, session: str) -> None:
    write(client, session, action_units={"AU12": 0.5})
    (writer,) = state(client, session)["layers"]["puppet"]["writers"]
    assert writer["owner"] == "anyone"
    assert writer["action_units"] == {"AU12": 0.5}
    assert writer["expires_in"] is None
    assert isinstance(writer["since"], int)


def test_owners_of_one_layer_hold_sets_of_their_own(client: TestClient, session: str) -> None:
    write(client, session, owner="a", action_units={"AU12": 0.8, "AU1": 0.3})
    write(client, session, owner="b", action_units={"AU12": 0.2}, weight=1.0, ttl=60)
    told = state(client, session)
    assert told["layers"]["puppet"]["action_units"] == {"AU12": 0.2, "AU1": 0.3}
    first, second = told["layers"]["puppet"]["writers"]
    assert (first["owner"], first["action_units"]) == ("a", {"AU12": 0.8, "AU1": 0.3})
    assert second["owner"] == "b"
    assert 50.0 < second["expires_in"] <= 60.0
    assert told["merged"]["writers"]["AU12"] == ["puppet"]
    assert told["merged"]["owners"]["AU12"] == [
        {"layer": "puppet", "owner": "a"},
        {"layer": "puppet", "owner": "b"},
    ]


def test_put_releases_its_owners_or_all(client: TestClient, session: str) -> None:
    write(client, session, owner="a", action_units={"AU12": 0.8})
    write(client, session, owner="b", action_units={"AU1": 0.3})
    put(client, session, owner="b")
    assert units(client, session) == {"AU12": 0.8}
    write(client, session, owner="b", action_units={"AU1": 0.3})
    put(client, session, action_units={"AU4": 0.5})
    assert units(client, session) == {"AU4": 0.5}


def test_a_lease_ends_by_itself(client: TestClient, session: str) -> None:
    write(client, session, owner="a", action_units={"AU12": 0.8})
    write(client, session, owner="b", action_units={"AU12": 0.2}, ttl=0.3, fade_out=0.1)
    assert units(client, session) == {"AU12": 0.2}
    until(lambda: units(client, session) == {"AU12": 0.8})
    owners = state(client, session)["merged"]["owners"]
    assert owners["AU12"] == [{"layer": "puppet", "owner": "a"}]


def test_a_command_that_waits_beneath_is_told_so(client: TestClient, session: str) -> None:
    write(client, session, owner="a", action_units={"AU12": 0.8})
    write(client, session, owner="b", action_units={"AU12": 0.2})
    answer = write(client, session, owner="a", action_units={"AU12": 0.9, "AU1": 0.1})
    (warning,) = answer["warnings"]
    assert warning.startswith("AU12: 'b' writes it in 'puppet' too")
    assert units(client, session) == {"AU12": 0.2, "AU1": 0.1}


def test_emotions_have_owners_and_leases_too(client: TestClient, session: str) -> None:
    path = f"/api/sessions/{session}/emotions"
    for owner, label in (("a", "sadness"), ("b", "happiness")):
        body = {"label": label, "owner": owner, "ttl": 60, "weight": 0.9}
        assert client.post(path, json=body).status_code == 200
    layer = state(client, session)["layers"]["emotion"]
    assert layer["emotion"]["label"] == "happiness"
    assert [writer["owner"] for writer in layer["writers"]] == ["a", "b"]
    put(client, session, layer="emotion", owner="b")
    assert state(client, session)["layers"]["emotion"]["emotion"]["label"] == "sadness"


def test_fade_in_is_another_name_of_fade(client: TestClient, session: str) -> None:
    write(client, session, action_units={"AU12": 1.0}, fade_in=30.0)
    muscles = state(client, session)["merged"]["muscles"]
    assert muscles.get("zygomatic_major.L", 0.0) < 0.1
    both = {"action_units": {"AU12": 1.0}, "fade_in": 1.0, "fade": 1.0}
    answer = client.patch(f"/api/sessions/{session}/controls", json=both)
    assert answer.status_code == 422
    assert "'fade_in'" in answer.json()["message"]


@pytest.mark.parametrize("owner", ["", "two words", "x" * 65, "ü", 7])
def test_an_owner_has_a_plain_name(client: TestClient, session: str, owner: object) -> None:
    answer = client.patch(f"/api/sessions/{session}/controls", json={"owner": owner})
    assert answer.status_code == 422
    assert "owner" in answer.json()["message"]


def test_a_layer_takes_so_many_writers(client: TestClient, session: str) -> None:
    for number in range(64):
        write(client, session, owner=f"w{number}", action_units={"AU12": 0.1})
    body = {"owner": "one-more", "action_units": {"AU12": 0.1}}
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 422
    assert "64 writers" in answer.json()["message"]


def test_the_socket_takes_owners(client: TestClient, session: str) -> None:
    path = f"ws://localhost/api/sessions/{session}/stream"
    with client.websocket_connect(path, subprotocols=["risorius.v1"]) as socket:
        socket.send_json({"type": "controls", "owner": "s", "action_units": {"AU12": 1}, "ttl": 9})
        socket.send_json({"type": "emotion", "owner": "s", "label": "joy"})
        layers: dict[str, Any] = {}
        while set(layers) != {"emotion", "puppet"}:
            message = socket.receive()
            event = json.loads(message["text"]) if message.get("text") else {}
            layers = event.get("layers", {})
    assert {layer["writers"][0]["owner"] for layer in layers.values()} == {"s"}


def test_a_clip_takes_owners_and_leases(client: TestClient) -> None:
    timeline = [
        {"time": 0.0, "owner": "a", "action_units": {"AU12": 0.8}},
        {"time": 0.1, "owner": "b", "action_units": {"AU12": 0.2}, "ttl": 0.2, "fade_out": 0.1},
    ]
    body = {"timeline": timeline, "duration": 0.6, "fps": 10, "textures": False}
    answer = client.post("/api/clips", params={"wait": 60}, json=body)
    assert answer.status_code == 200, answer.text
    table = client.get(f"{answer.headers['Location']}.csv").text.splitlines()
    column = table[0].split(",").index("AU12")
    values = [float(line.split(",")[column]) for line in table[1:]]
    assert values == pytest.approx([0.8, 0.2, 0.2, 0.2, 0.8, 0.8, 0.8], abs=1e-3)


def test_a_lease_goes_on_after_a_restart(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        write(client, session, owner="a", action_units={"AU12": 0.8})
        write(client, session, owner="b", action_units={"AU12": 0.2}, ttl=1000)
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        first, second = state(client, session)["layers"]["puppet"]["writers"]
        assert (first["owner"], first["expires_in"]) == ("a", None)
        assert second["owner"] == "b"
        assert 900.0 < second["expires_in"] <= 1000.0
        put(client, session, owner="b")
        assert units(client, session) == {"AU12": 0.8}
