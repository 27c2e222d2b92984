"""ARKit's shapes, visemes and speech over HTTP and the socket."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from conftest import LOCAL, until
from starlette.testclient import TestClient

from engine import (
    LEAD,
    Frame,
    Model,
    Simulator,
    Timeline,
    builtin_rig,
    cues_of,
    speech_keyframes,
    ticks,
)
from service.components import Components
from service.embedded import EmbeddedRunner
from service.runner import Played

WORDS = [{"viseme": name, "duration": 0.1} for name in ("PP", "aa", "FF", "O", "sil")]
LONG = [{"viseme": "aa", "time": 0.0}, {"viseme": "PP", "time": 60.0}]


def control(client: TestClient, session: str, **body: object) -> dict[str, Any]:
    """Apply controls and return the answer."""
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def state(client: TestClient, session: str) -> dict[str, Any]:
    """Return what a face holds."""
    found: dict[str, Any] = client.get(f"/api/sessions/{session}").json()
    return found


def speak(client: TestClient, session: str, **body: object) -> dict[str, Any]:
    """Have a face speak and return the answer."""
    answer = client.post(f"/api/sessions/{session}/speech", json=body)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


@pytest.mark.parametrize(("name", "count"), [("arkit", 52), ("visemes", 15)])
def test_a_map_says_what_each_name_plays(client: TestClient, name: str, count: int) -> None:
    table = client.get(f"/api/maps/{name}").json()
    assert table["name"] == name
    assert table["version"]
    assert len(table["shapes"]) == count
    units = client.get("/api/rigs/standard").json()["action_units"]
    numbers = {unit["name"].removeprefix("AU") for unit in units}
    for shape in table["shapes"].values():
        assert shape["source"]
        assert {key.lstrip("AULRTB") for key in shape["units"]} <= numbers


def test_arkit_drives_a_face(client: TestClient, session: str) -> None:
    arkit = {"jawOpen": 0.4, "mouthSmile_L": 0.5, "EyeBlinkRight": 1.0, "eyeLookUpLeft": 1.0}
    assert control(client, session, arkit=arkit)["warnings"] == []
    merged = state(client, session)["merged"]
    assert merged["action_units"] == {"AU27": 0.4, "L12": 0.5, "R45": 1.0}
    assert merged["jaw"]["pitch"] > 5.0
    assert merged["gaze"]["pitch"] > 10.0
    assert list(state(client, session)["layers"]) == ["puppet"]
    control(client, session, arkit=dict.fromkeys(arkit, 0.0))
    assert state(client, session)["layers"] == {}


def test_arkit_goes_over_the_socket(client: TestClient, session: str) -> None:
    stream = f"{LOCAL.replace('http', 'ws')}/api/sessions/{session}/stream"
    with client.websocket_connect(stream, subprotocols=["risorius.v1"]) as socket:
        socket.send_json({"type": "controls", "arkit": {"browDown_L": 0.5}})
        until(lambda: state(client, session)["merged"]["action_units"] == {"L4": 0.5})
        socket.send_json({"type": "controls", "visemes": {"aa": 0.5}})
        until(lambda: "speech" in state(client, session)["layers"])


def test_what_the_rig_cannot_do_is_named(client: TestClient, session: str) -> None:
    warnings = control(client, session, arkit={"mouthLeft": 0.5, "jawOpen": 0.1})["warnings"]
    assert len(warnings) == 1
    assert warnings[0].startswith("mouthLeft: FACS has no unit")
    numb = {"action_units": {"AU22": {"muscles": {"risorius": 0.0}}}}
    rig = client.post("/api/rigs", json=numb).json()["id"]
    other = client.post("/api/sessions", json={"rig": rig}).json()["id"]
    warnings = control(client, other, arkit={"mouthFunnel": 0.5})["warnings"]
    assert any(line.startswith("mouthFunnel: AU22 moves nothing") for line in warnings)
    assert speak(client, other, visemes=[{"viseme": "CH", "time": 0.0}])["warnings"]
    client.delete(f"/api/sessions/{other}")


def test_what_is_named_itself_counts(client: TestClient, session: str) -> None:
    answer = control(client, session, arkit={"mouthSmileLeft": 0.5}, action_units={"AU12": 0.9})
    assert answer["warnings"][0].startswith("AU12 is named itself, so mouthSmileLeft")
    assert state(client, session)["merged"]["action_units"] == {"AU12": 0.9}


@pytest.mark.parametrize(
    ("body", "error", "said"),
    [
        ({"arkit": {"jawOpn": 0.4}}, "unknown_arkit_shape", "jawOpen"),
        ({"arkit": {"jawOpen": 1.4}}, "invalid_value", "arkit.jawOpen"),
        ({"visemes": {"ab": 0.4}}, "unknown_viseme", "ab"),
        ({"visemes": {"aa": -0.4}}, "invalid_value", "visemes.aa"),
    ],
)
def test_a_shape_that_is_not_there_is_refused(
    client: TestClient, session: str, body: dict[str, object], error: str, said: str
) -> None:
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 422
    assert answer.json()["error"] == error
    assert said in answer.json()["message"]


def test_visemes_say_the_whole_mouth_in_the_layer_of_speech(
    client: TestClient, session: str
) -> None:
    assert control(client, session, visemes={"aa": 0.7, "ou": 0.2})["warnings"] == []
    held = state(client, session)["layers"]
    assert list(held) == ["speech"]
    assert held["speech"]["action_units"]["AU25"] == pytest.approx(0.35)
    control(client, session, visemes={"PP": 1.0})
    assert "AU18" not in state(client, session)["layers"]["speech"]["action_units"]
    control(client, session, visemes={"sil": 1.0})
    assert state(client, session)["layers"] == {}
    control(client, session, visemes={"aa": 0.7}, layer="puppet")
    assert list(state(client, session)["layers"]) == ["puppet"]


def test_shapes_move_a_clip(client: TestClient) -> None:
    timeline = [{"time": 0.0, "arkit": {"browInnerUp": 0.6}}, {"time": 0.1, "visemes": {"aa": 1}}]
    body = {"timeline": timeline, "duration": 0.3, "fps": 10, "textures": False, "level": "low"}
    answer = client.post("/api/clips", json=body, params={"wait": 60})
    assert answer.status_code == 200, answer.text
    clips = client.get("/api/clips").json()["clips"]
    rows = client.get(f"/api/clips/{clips[-1]['id']}.csv").text.splitlines()
    assert "AU1" in rows[0]


def test_a_speech_is_played_and_lets_go(client: TestClient, session: str) -> None:
    control(client, session, layer="emotion", action_units={"AU6": 0.8, "AU12": 0.8})
    answer = speak(client, session, visemes=WORDS)
    assert answer["sound_in"] == pytest.approx(LEAD)
    assert answer["seconds"] == pytest.approx(0.5 + LEAD)
    assert answer["owner"] == "speech"
    assert answer["warnings"] == []
    until(lambda: "speech" in state(client, session)["layers"])
    until(lambda: "speech" not in state(client, session)["layers"])
    assert state(client, session)["merged"]["action_units"] == {"AU6": 0.8, "AU12": 0.8}


def test_the_next_speech_takes_the_place_of_the_last(client: TestClient, session: str) -> None:
    speak(client, session, visemes=LONG, owner="voice")
    until(lambda: "speech" in state(client, session)["layers"])
    speak(client, session, visemes=WORDS, owner="voice")
    until(lambda: state(client, session)["layers"] == {})


def test_a_speech_can_be_ended(client: TestClient, session: str) -> None:
    speak(client, session, visemes=LONG)
    until(lambda: "speech" in state(client, session)["layers"])
    other = client.delete(f"/api/sessions/{session}/speech", params={"owner": "other"})
    assert other.status_code == 200
    assert "speech" in state(client, session)["layers"]
    answer = client.delete(f"/api/sessions/{session}/speech", params={"fade": 0.05})
    assert answer.status_code == 200
    assert answer.json()["tick"] > 0
    until(lambda: state(client, session)["layers"] == {})


def test_a_lease_ends_a_speech(client: TestClient, session: str) -> None:
    assert speak(client, session, visemes=LONG, ttl=0.3)["seconds"] == pytest.approx(0.3)
    until(lambda: "speech" in state(client, session)["layers"])
    until(lambda: state(client, session)["layers"] == {})


def test_a_live_edit_does_not_interrupt(client: TestClient, session: str) -> None:
    parts: Components = client.app.state.parts  # type: ignore[attr-defined]
    speak(client, session, visemes=LONG)
    until(lambda: "speech" in state(client, session)["layers"])
    edit = f"/api/sessions/{session}/muscles/risorius.L"
    assert client.patch(edit, json={"strength": 0.9}).status_code == 200
    assert "speech" in state(client, session)["layers"]
    assert parts.runner._group(session).schedule.coming(session) == 2
    client.delete(f"/api/sessions/{session}/speech")
    until(lambda: state(client, session)["layers"] == {})


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"visemes": []},
        {"visemes": [{"viseme": "aa"}]},
        {"visemes": [{"viseme": "zz", "time": 0}]},
        {"visemes": [{"viseme": "aa", "time": 1}, {"viseme": "aa", "time": 0}]},
        {"visemes": [{"viseme": "aa", "time": 0}, {"viseme": "aa", "duration": 1}]},
        {"visemes": [{"viseme": "aa", "time": 0, "weight": 2}]},
        {"visemes": WORDS, "owner": "no spaces"},
        {"visemes": WORDS, "layer": "mood"},
    ],
)
def test_a_speech_that_cannot_be_played_is_refused(
    client: TestClient, session: str, body: dict[str, object]
) -> None:
    answer = client.post(f"/api/sessions/{session}/speech", json=body)
    assert answer.status_code == 422
    assert set(answer.json()) <= {"error", "message", "known"}


def test_speech_wants_a_session(client: TestClient) -> None:
    assert client.post("/api/sessions/nobody/speech", json={"visemes": WORDS}).status_code == 404
    assert client.delete("/api/sessions/nobody/speech").status_code == 404


@pytest.fixture
def runner() -> Iterator[EmbeddedRunner]:
    """A runner whose threads run."""
    runner = EmbeddedRunner()
    runner.start()
    yield runner
    runner.stop()


def test_a_live_speech_has_the_same_bits_as_a_finished_one(runner: EmbeddedRunner) -> None:
    rig = builtin_rig("standard")
    model = Model.for_rig(rig, integrator="verlet")
    keyframes = speech_keyframes(*cues_of(WORDS))
    last = ticks(keyframes[-1].time) + 5

    async def live() -> tuple[int, list[Played], dict[int, Frame]]:
        played, frames = [], {}
        await runner.open("face", rig, Timeline((), 1.0), model)
        start = await runner.perform("face", keyframes)
        async for tick in runner.ticks():
            played += tick.played
            frames.update({frame.tick: frame for frame in tick.frames.values()})
            if max(frames, default=0) >= start + last:
                return start, played, frames
        raise AssertionError

    start, played, frames = asyncio.run(asyncio.wait_for(live(), 60.0))
    assert [each.tick - start for each in played] == [ticks(each.time) for each in keyframes]
    simulator, coming = Simulator(rig, model=model, threads=1), list(keyframes)
    simulator.add("face")
    compared = 0
    for tick in range(start + last):
        while coming and start + ticks(coming[0].time) <= tick:
            simulator.apply("face", coming.pop(0))
        simulator.step()
        if tick + 1 in frames:
            compared += 1
            ours = simulator.frame("face").displacements
            np.testing.assert_array_equal(frames[tick + 1].displacements, ours)
    assert compared > last / 4
