"""Idle life over HTTP and the socket: off by default, told, changed, kept; the same in a clip."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

from engine import Frame, Idle, Model, Simulator, Timeline, builtin_rig, ticks
from service.app import create_app
from service.bodies import NewClip
from service.clip_requests import Bounds, played_by
from service.commanded import commanded_units
from service.commands import clip_timeline
from service.embedded import EmbeddedRunner
from service.idle import lived, with_life
from service.recording import recorded_clip
from service.runner import Played
from service.tail import Command, Tail

RIG = builtin_rig("standard")
SEED = 3
"""Whose first blink comes within two seconds, at twice the usual number."""
USUAL = {"blinks": 1.0, "gaze": 1.0, "head": 1.0, "micro": 0.3}


def opened(client: TestClient, **body: object) -> dict[str, Any]:
    """Open a session and return the answer."""
    answer = client.post("/api/sessions", json=body)
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


def state(client: TestClient, session: str) -> dict[str, Any]:
    """Return what a face holds."""
    return dict(client.get(f"/api/sessions/{session}").json())


def held_by_life(client: TestClient, session: str) -> list[str]:
    """Return the owners in the lowest layer."""
    layer = state(client, session)["layers"].get("idle", {"writers": []})
    return [writer["owner"] for writer in layer["writers"]]


def test_a_session_is_still_by_default(client: TestClient, session: str) -> None:
    assert state(client, session)["idle"] is None
    assert client.get(f"/api/sessions/{session}/idle").json() == {"idle": None}
    assert client.delete(f"/api/sessions/{session}/idle").json()["idle"] is None
    until(lambda: state(client, session)["asleep"])
    assert state(client, session)["layers"] == {}
    for off in (False, None):
        other = opened(client, idle=off)
        assert other["idle"] is None
        client.delete(f"/api/sessions/{other['id']}")


def test_a_session_lives_from_its_opening_until_it_is_told_not_to(client: TestClient) -> None:
    told = opened(client, idle=True)
    session, seed = told["id"], told["idle"]["seed"]
    assert told["idle"] == {"seed": seed, **USUAL}
    until(lambda: held_by_life(client, session) == ["idle"])
    path = f"/api/sessions/{session}/idle"
    changed = client.put(path, json={"blinks": 2.0, "micro": 0.0}).json()
    assert changed["idle"] == {"seed": seed, **USUAL, "blinks": 2.0, "micro": 0.0}
    assert client.put(path, json={"seed": 7}).json()["idle"] == {"seed": 7, **USUAL}
    assert client.get(path).json() == {"idle": {"seed": 7, **USUAL}}
    assert state(client, session)["idle"]["seed"] == 7
    ended = client.delete(path).json()
    assert ended["idle"] is None
    assert ended["tick"] >= changed["tick"]
    until(lambda: state(client, session)["asleep"])
    assert state(client, session)["layers"] == {}
    assert parts_of(client).store.session(session).life is None  # type: ignore[union-attr]
    client.delete(f"/api/sessions/{session}")


def test_a_life_waits_while_nobody_looks(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = opened(client, idle={"seed": 3})["id"]
    live = parts_of(client).sessions._live[session]
    until(lambda: len(live.lived) > 2)
    with monkeypatch.context() as patch:
        patch.setattr("service.sessions._UNWATCHED_SECONDS", 0.2)
        until(lambda: live.paused and live.frame.asleep)
    assert live.idle is not None
    played = len(live.lived)
    assert state(client, session)["idle"]["seed"] == 3
    assert not live.paused
    until(lambda: len(live.lived) > played)
    until(lambda: held_by_life(client, session) == ["idle"])
    client.delete(f"/api/sessions/{session}")


def test_two_sessions_do_not_blink_together(client: TestClient) -> None:
    told = [opened(client, idle={"blinks": 0.5}) for _ in range(2)]
    assert told[0]["idle"]["seed"] != told[1]["idle"]["seed"]
    for each in told:
        assert client.delete(f"/api/sessions/{each['id']}").status_code == 204


def test_a_person_s_command_is_above_it(client: TestClient) -> None:
    session = opened(client, idle={"seed": 3})["id"]
    until(lambda: "head.yaw" in state(client, session)["merged"]["writers"])
    body = {"head": {"yaw": 12.0}, "action_units": {"AU45": 0.5}}
    client.patch(f"/api/sessions/{session}/controls", json=body)
    merged = state(client, session)["merged"]
    assert merged["head"]["yaw"] == 12.0
    assert merged["action_units"]["AU45"] == 0.5
    assert merged["owners"]["head.yaw"] == [
        {"layer": "idle", "owner": "idle"},
        {"layer": "puppet", "owner": "anyone"},
    ]
    client.delete(f"/api/sessions/{session}")


def test_the_socket_switches_it_and_tells_of_it(client: TestClient, session: str) -> None:
    stream = f"{LOCAL.replace('http', 'ws')}/api/sessions/{session}/stream"

    def next_state(socket: Any) -> dict[str, Any]:
        while True:
            message = socket.receive()
            if message.get("text"):
                event: dict[str, Any] = json.loads(message["text"])
                if event["type"] in ("hello", "state"):
                    return event.get("state", event)

    with client.websocket_connect(stream, subprotocols=["risorius.v1"]) as socket:
        assert next_state(socket)["idle"] is None
        socket.send_json({"type": "idle", "seed": 5, "gaze": 0.5})
        told = next_state(socket)
        while told["idle"] is None:
            told = next_state(socket)
        assert told["idle"] == {"seed": 5, **USUAL, "gaze": 0.5}
        socket.send_json({"type": "idle", "on": False})
        while told["idle"] is not None:
            told = next_state(socket)


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ({"blinks": 3.0}, "blinks"),
        ({"head": -1.0}, "head"),
        ({"seed": 0.5}, "seed"),
        ({"blink": 1.0}, "blink"),
    ],
)
def test_a_life_that_cannot_be_is_refused(
    client: TestClient, session: str, body: dict[str, object], named: str
) -> None:
    for answer in (
        client.put(f"/api/sessions/{session}/idle", json=body),
        client.post("/api/sessions", json={"idle": body}),
        client.post("/api/clips", json={"timeline": [{"time": 0}], "idle": body}),
    ):
        assert answer.status_code == 422
        assert named in answer.json()["message"]


def test_a_life_wants_a_session(client: TestClient) -> None:
    path = "/api/sessions/nobody/idle"
    answers = (client.get(path), client.put(path, json={}), client.delete(path))
    assert [answer.status_code for answer in answers] == [404, 404, 404]


def test_a_live_edit_does_not_end_it(client: TestClient) -> None:
    session = opened(client, idle={"seed": 3})["id"]
    edit = f"/api/sessions/{session}/muscles/risorius.L"
    assert client.patch(edit, json={"strength": 0.9}).status_code == 200
    assert state(client, session)["idle"]["seed"] == 3
    runner: Any = parts_of(client).runner
    assert session in runner._group(session).lives
    client.delete(f"/api/sessions/{session}")


def test_a_life_goes_on_after_a_restart(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        session = opened(client, idle={"seed": 11, "gaze": 0.0})["id"]
        quiet = opened(client, idle=True)["id"]
        client.delete(f"/api/sessions/{quiet}/idle")
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        assert state(client, session)["idle"] == {"seed": 11, **USUAL, "gaze": 0.0}
        until(lambda: held_by_life(client, session) == ["idle"])
        assert state(client, quiet)["idle"] is None


def test_a_clip_lives_too_and_the_same_one_the_same_life() -> None:
    def played(**said: object) -> Timeline:
        body = {"timeline": [{"time": 0.5, "facs": "12C"}], "duration": 20.0, **said}
        clip = NewClip.model_validate(body)
        timeline, warnings = clip_timeline(clip, RIG)
        assert warnings == []
        return with_life(timeline, clip, RIG)

    timeline = played(idle=True)
    assert timeline.duration == 20.0
    by_itself = [each for each in timeline.keyframes if each.owner == "idle"]
    assert {"AU45": 1.0} in [each.action_units for each in by_itself]
    assert max(each.time for each in by_itself) < 20.0
    assert timeline == played(idle=True) == played(idle={"seed": 0})
    assert timeline != played(idle={"seed": 1})
    for still in (played(), played(idle=False)):
        assert [each.owner for each in still.keyframes] == ["anyone"]


def test_a_clip_that_lives_commands_it() -> None:
    clip = NewClip.model_validate({"timeline": [], "duration": 5.0, "idle": {"seed": SEED}})
    timeline = played_by(clip, RIG, Bounds(seconds=5.0, keyframes=1)).timeline
    names, rows = commanded_units(timeline, RIG, [tick / 60.0 for tick in range(300)])
    assert rows[:, names.index("AU45")].max() > 0.5


def test_what_a_life_did_is_recorded_as_it_was() -> None:
    did = [each for each, _ in zip(lived(Idle(seed=4, micro=2.0), RIG), range(60), strict=False)]
    tail = Tail(RIG)
    for each in did:
        tail.add(Command(ticks(each.time), each, idle=True))
    now = tail.commands[-1].tick + 1
    clip = recorded_clip(tail, RIG, Model.for_rig(RIG), now=now, last=600.0, fps=60)
    assert list(clip_timeline(clip, RIG)[0].keyframes) == did


def test_a_live_face_lives_as_a_finished_one_does() -> None:
    idle = Idle(seed=SEED, blinks=2.0)
    model, last = Model.for_rig(RIG, integrator="verlet"), 110

    async def live() -> tuple[int, list[Played], dict[int, Frame]]:
        runner = EmbeddedRunner()
        runner.start()
        played, frames = [], {}
        try:
            await runner.open("face", RIG, Timeline((), 1.0), model)
            start = await runner.live("face", idle)
            async for tick in runner.ticks():
                played += tick.played
                frames.update({frame.tick: frame for frame in tick.frames.values()})
                if max(frames, default=0) >= start + last:
                    return start, played, frames
        finally:
            await asyncio.to_thread(runner.stop)
        raise AssertionError

    start, played, frames = asyncio.run(asyncio.wait_for(live(), 60.0))
    told = [each for each, _ in zip(lived(idle, RIG), range(100), strict=False)]
    assert all(each.idle for each in played)
    assert [each.keyframe for each in played] == told[: len(played)]
    assert [each.tick - start for each in played] == [ticks(each.time) for each in told][
        : len(played)
    ]
    simulator, coming = Simulator(RIG, model=model, threads=1), list(told)
    simulator.add("face")
    compared, shut = 0, 0.0
    for tick in range(start + last):
        while start + ticks(coming[0].time) <= tick:
            simulator.apply("face", coming.pop(0))
        simulator.step()
        if tick + 1 in frames:
            compared += 1
            ours = simulator.frame("face")
            shut = max(shut, float(np.abs(ours.displacements).max()))
            np.testing.assert_array_equal(frames[tick + 1].displacements, ours.displacements)
            assert frames[tick + 1].pose == ours.pose
    assert compared > last / 4
    assert shut > 5.0
