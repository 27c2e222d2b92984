"""What a live face did last, over HTTP: an animation of its last seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import parts_of, settings_in, until
from glb_reader import Glb
from starlette.testclient import TestClient

from service.app import create_app

CHEAP = {"level": "low", "textures": 0, "fps": 20}


def moved(client: TestClient, session: str, *, ticks: int = 50) -> str:
    """Make a face smile at once, wait, and return its address."""
    path = f"/api/sessions/{session}"
    body = {"action_units": {"AU12": 1.0}, "ttl": 30.0, "fade": 0.3}
    assert client.patch(f"{path}/controls", json=body).status_code == 200
    until(lambda: client.get(path).json()["tick"] >= ticks)
    return path


def animated(data: bytes) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return times [s], and how far from rest the skin's farthest vertex is at each [mm]."""
    glb = Glb(data)
    node = glb.node("skin")
    (primitive,) = glb.mesh("skin")["primitives"]
    (animation,) = glb.json["animations"]
    (sampler,) = (
        animation["samplers"][channel["sampler"]]
        for channel in animation["channels"]
        if channel["target"] == {"node": node, "path": "weights"}
    )
    times = glb.array(sampler["input"])
    weights = glb.array(sampler["output"]).reshape(len(times), -1)
    shapes = np.array([glb.array(target["POSITION"]) for target in primitive["targets"]], float)
    shown = np.einsum("fk,kvi->fvi", weights, shapes) * glb.json["nodes"][node].get("scale", 1.0)
    return times, 1000.0 * np.linalg.norm(shown, axis=2).max(axis=1)


def test_the_last_seconds_are_an_animation(client: TestClient, session: str) -> None:
    path = moved(client, session)
    answer = client.get(f"{path}/recording.glb", params={**CHEAP, "last": 60})
    assert answer.status_code == 200, answer.text
    assert answer.headers["Content-Type"] == "model/gltf-binary"
    assert answer.headers["Cache-Control"] == "no-store"
    times, moved_by = animated(answer.content)
    assert times[-1] >= 50 / 60 - 1 / CHEAP["fps"]
    # The tolerance within which a clip is what was simulated, at rest then.
    assert moved_by[0] <= 0.1
    assert moved_by[-1] > 5.0
    short = client.get(f"{path}/recording.glb", params={**CHEAP, "last": 0.25})
    times, moved_by = animated(short.content)
    assert times[-1] == pytest.approx(0.25)
    assert moved_by[0] > 1.0
    assert client.get("/api/clips").json()["clips"] == []


def test_one_that_takes_long_is_a_clip_to_come_back_for(client: TestClient, session: str) -> None:
    path = moved(client, session, ticks=1)
    answer = client.get(f"{path}/recording.glb", params={**CHEAP, "wait": 0})
    assert answer.status_code == 202
    clip = answer.headers["Location"]
    assert answer.json()["status"] in ("queued", "running")
    assert client.get(clip, params={"wait": 60}).json()["status"] == "done"
    assert client.get(f"{clip}.glb").content[:4] == b"glTF"
    assert client.delete(clip).status_code == 204


def test_a_face_that_was_told_nothing_has_no_recording(client: TestClient, session: str) -> None:
    answer = client.get(f"/api/sessions/{session}/recording.glb")
    assert (answer.status_code, answer.json()["error"]) == (409, "nothing_recorded")
    missing = client.get("/api/sessions/nobody/recording.glb")
    assert (missing.status_code, missing.json()["error"]) == (404, "unknown_session")


@pytest.mark.parametrize(
    "asked", ["last=0", "last=nan", "last=1e9", "last=x", "fps=0", "fps=61", "wait=61", "level=top"]
)
def test_what_cannot_be_recorded_is_refused(client: TestClient, session: str, asked: str) -> None:
    answer = client.get(f"/api/sessions/{session}/recording.glb?{asked}")
    assert answer.status_code == 422
    assert set(answer.json()) <= {"error", "message", "known"}


def test_a_recording_is_no_longer_than_a_clip_may_be(tmp_path: Any) -> None:
    settings = settings_in(tmp_path, max_clip_seconds=2.5)
    with TestClient(create_app(settings), base_url="http://localhost") as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        path = moved(client, client.post("/api/sessions", json={}).json()["id"], ticks=90)
        answer = client.get(f"{path}/recording.glb", params={**CHEAP, "last": 1.0})
        assert answer.status_code == 422
        assert "played before it begins" in answer.json()["message"]
        parts = parts_of(client)
        assert parts.clips.rows() == []


def test_a_recording_that_fails_says_so(
    client: TestClient, session: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = moved(client, session, ticks=1)

    async def fails(*_: object, **__: object) -> None:
        raise RuntimeError("no disk")

    monkeypatch.setattr(parts_of(client).clips._work, "_render", fails)
    answer = client.get(f"{path}/recording.glb", params=CHEAP)
    assert (answer.status_code, answer.json()["error"]) == (409, "clip_failed")
    assert "log" in answer.json()["message"]
