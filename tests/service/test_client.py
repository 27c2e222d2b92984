"""The client, against a running service."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import settings_in, until
from typer.testing import CliRunner

from engine import builtin_rig, resolve_label
from service.app import create_app
from service.cli import app as command_line
from service.client import Client, Face, ServiceError
from service.server import running

DOCS = Path(__file__).parents[2] / "docs"
KEY = "secret"


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service with a key."""
    settings = settings_in(
        tmp_path_factory.mktemp("client"), api_keys=(KEY,), max_viewers=1, key_sessions=4
    )
    with running(create_app(settings), settings) as address:
        yield address


@pytest.fixture(scope="module")
def service(url: str) -> Iterator[Client]:
    """A client of it."""
    with Client(url, key=KEY) as client:
        client.wait_until_ready()
        yield client


@pytest.fixture
def face(service: Client) -> Iterator[Face]:
    """A face of it."""
    with service.open_face() as opened:
        yield opened


def test_a_face_is_opened_moved_and_closed(service: Client) -> None:
    idle = {"seed": 3, "gaze": 0.0, "head": 0.0}
    with service.open_face("standard", idle=idle, integrator="rk2") as face:
        assert face.state()["idle"] == {**idle, "blinks": 1.0, "micro": 0.3}
        assert face.viewer_url.startswith(f"{service.url}/?session=")
        told = face.set_controls(facs="6C+12D", fade=0.1)
        assert told["warnings"] == []
        assert face.state()["merged"]["facs"] == "6C+12D"
        assert face.state()["model"]["integrator"] == "rk2"
        face.set_controls(replace=True, action_units={"AU4": 0.4})
        assert face.state()["merged"]["action_units"] == {"AU4": 0.4}
    with pytest.raises(ServiceError) as gone:
        face.state()
    assert (gone.value.status, gone.value.error) == (404, "unknown_session")


def test_an_emotion_is_played_by_word_and_by_scores(face: Face) -> None:
    assert face.set_emotion("joyful", intensity=0.5)["recipe"] == resolve_label("joyful").facs
    scored = face.set_emotion(scores=[{"label": "anger", "score": 0.7}])
    assert scored["found"] == "scores"


def test_frames_are_arrays_from_the_command_on_until_the_face_is_still(face: Face) -> None:
    tick = face.set_controls(facs="12E", fade=0.1)["tick"]
    frames = list(face.frames(until_still=True, since=tick))
    assert frames[-1].asleep
    times = [(frame.tick, frame.asleep) for frame in frames]
    assert times == sorted({*times})
    assert frames[0].tick >= tick
    last = frames[-1].displacements
    assert last.shape == (len(builtin_rig("standard").head.points), 3)
    assert 0.004 < np.abs(last).max() < 0.03


def test_a_face_and_a_clip_are_saved(service: Client, face: Face, tmp_path: Path) -> None:
    face.save(tmp_path / "face.glb")
    shares: list[float] = []
    clip = {"timeline": [{"time": 0.0, "emotion": "joy"}], "duration": 0.5, "fps": 10}
    report = service.save_clip(clip, tmp_path / "clip.glb", show=shares.append)
    assert report["frames"] == 6
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    for name in ("face.glb", "clip.glb"):
        assert (tmp_path / name).read_bytes()[:4] == b"glTF"


def test_an_expression_is_had_without_a_face(service: Client) -> None:
    data = service.expression("6B+12C", form="glb", level="low", textures=0)
    assert data[:4] == b"glTF"
    assert data != service.expression("6B+12D", form="glb", level="low", textures=0)
    with pytest.raises(ServiceError) as wrong:
        service.expression("smile")
    assert (wrong.value.status, wrong.value.error) == (422, "invalid_notation")


def test_a_face_speaks_and_is_silent(face: Face) -> None:
    face.set_emotion("joy", owner="agent")
    spoken = face.speak([{"viseme": "aa", "duration": 20.0}], owner="voice", intensity=0.5)
    assert spoken["sound_in"] > 0.0
    until(lambda: "speech" in face.state()["layers"])
    face.be_silent(owner="voice")
    until(lambda: [*face.state()["layers"]] == ["emotion"])
    with pytest.raises(ServiceError, match="viseme"):
        face.speak([{"viseme": "zz", "time": 0.0}])


def test_commands_follow_each_other_over_a_socket(face: Face) -> None:
    with face.commands() as commands:
        for share in range(1, 11):
            commands.set_controls(arkit={"mouthSmileLeft": share / 10}, owner="phone", ttl=60.0)
        commands.set_emotion("fear", owner="agent")
        early = commands.set_controls(arkit={"mouthLeft": 0.5}, owner="phone", replace=True)
        (warning,) = early or commands.heard(seconds=1.0)
        assert warning.startswith("mouthLeft")
        layers = face.state()["layers"]
        assert layers["emotion"]["emotion"]["label"] == "fear"
        assert layers["puppet"]["action_units"]["L12"] == pytest.approx(0.15)
        assert layers["puppet"]["writers"][0]["expires_in"] is None
        commands.set_controls(arkit={"mouthSmle": 0.5})
        with pytest.raises(ServiceError, match="mouthSmile") as refused:
            commands.heard(seconds=5.0)
        assert refused.value.error == "unknown_arkit_shape"
    with pytest.raises(ServiceError, match="ended"):
        commands.set_controls(arkit={"jawOpen": 0.5})


def test_what_a_face_did_last_is_saved(face: Face, tmp_path: Path) -> None:
    with pytest.raises(ServiceError, match="nothing was ever set"):
        face.save_last(tmp_path / "last.glb")
    face.set_controls(facs="12E", fade=0.1, ttl=10.0)
    until(lambda: face.state()["tick"] > 15)
    face.save_last(tmp_path / "last.glb", 0.2, fps=10)
    assert (tmp_path / "last.glb").read_bytes()[:4] == b"glTF"


def test_what_the_service_refuses_is_raised_in_its_words(face: Face) -> None:
    with pytest.raises(ServiceError, match="did you mean surprise") as refused:
        face.set_emotion("suprise")
    assert refused.value.error == "unknown_emotion"
    assert refused.value.known[0] == "surprise"


def test_a_stream_that_is_refused_says_why(service: Client, face: Face) -> None:
    with pytest.raises(ServiceError) as refused:
        next(service.face("nobody").frames())
    assert refused.value.error == "unknown_session"
    first = face.frames()
    next(first)
    with pytest.raises(ServiceError) as full:
        next(face.frames())
    assert full.value.error == "too_many_viewers"
    first.close()  # type: ignore[attr-defined]


def test_a_wrong_key_and_a_wrong_address_are_told_apart(url: str) -> None:
    with Client(url, key="wrong") as client, pytest.raises(ServiceError) as refused:
        client.open_face()
    assert (refused.value.status, refused.value.error) == (401, "unauthorized")
    with Client("http://127.0.0.1:9") as client, pytest.raises(ServiceError) as silent:
        client.open_face()
    assert (silent.value.status, silent.value.error) == (0, "unreachable")


def test_what_is_put_off_is_sent_again(tmp_path: Path) -> None:
    settings = settings_in(tmp_path, requests_per_second=2)
    with running(create_app(settings), settings) as address, Client(address) as client:
        for _ in range(8):
            client.call("GET", "/api/health")


def test_what_is_put_off_for_long_is_given_back_at_once(service: Client) -> None:
    faces = [service.open_face() for _ in range(4)]
    with pytest.raises(ServiceError) as refused:
        service.open_face()
    assert (refused.value.status, refused.value.error) == (429, "quota_exceeded")
    for face in faces:
        face.close()
    counted = service.call("GET", "/metrics").text
    assert 'risorius_requests_total{method="POST",status="429"} 1.0' in counted


def test_a_link_shows_a_face_without_a_key(service: Client, face: Face) -> None:
    link = face.link(seconds=60)
    assert link.startswith(face.viewer_url)
    ticket = link.rpartition("=")[2]
    with Client(service.url, key=ticket) as guest:
        shown = guest.face(face.session)
        assert shown.state()["id"] == face.session
        next(shown.frames())
        with pytest.raises(ServiceError) as refused:
            shown.set_emotion("joy")
    assert (refused.value.status, refused.value.error) == (403, "read_only")


def test_the_command_line_renders_a_clip_by_a_service(url: str, tmp_path: Path) -> None:
    source, output = tmp_path / "in.json", tmp_path / "out.glb"
    source.write_text(json.dumps({"timeline": [{"time": 0, "facs": "12D"}], "duration": 0.3}))
    asked = ["clip", str(source), "-o", str(output), "--url", url, "--fps", "10"]
    done = CliRunner().invoke(command_line, [*asked, "--key", KEY])
    assert done.exit_code == 0, done.output
    assert output.read_bytes()[:4] == b"glTF"
    assert "4 frames" in done.output
    refused = CliRunner().invoke(command_line, asked)
    assert refused.exit_code == 2
    assert "key" in refused.output


def test_the_example_of_the_client_runs_as_it_is_shown(url: str, tmp_path: Path) -> None:
    api = (DOCS / "api.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", api, re.S)
    shown = "http://127.0.0.1:8000"
    assert shown in example
    program = tmp_path / "example.py"
    program.write_text(example.replace(f'"{shown}"', f'"{url}", key="{KEY}"'))
    done = subprocess.run(
        [sys.executable, program.name],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "mm" in done.stdout
    for name in ("joy.glb", "clip.glb"):
        assert (tmp_path / name).read_bytes()[:4] == b"glTF"


def test_a_tracker_s_file_is_sent_and_its_clip_saved(
    service: Client, url: str, tmp_path: Path
) -> None:
    source, output = tmp_path / "laugh.csv", tmp_path / "laugh.glb"
    rows = "\n".join(f"{i},{i / 30:.3f},0.98,1,0.2,{i}" for i in range(4))
    source.write_text(f"frame,timestamp,confidence,success,pose_Ry,AU12_r\n{rows}\n")
    shares: list[float] = []
    asked = {"fps": 10, "textures": False, "level": "low", "gain": 0.5, "head": False}
    report = service.save_track(source, output, show=shares.append, **asked)
    assert output.read_bytes()[:4] == b"glTF"
    assert shares[-1] == 1.0
    assert report["track"]["units"]["AU12"]["played"] == pytest.approx(0.3)
    assert report["track"]["angles"] == {}

    output.unlink()
    options = ["-o", str(output), "--url", url, "--key", KEY, "--no-textures", "--fps", "10"]
    asked_too = ["--gain", "0.5", "--no-head", "--neutral", "0-0"]
    command = ["clip", str(source), *options, *asked_too]
    told = CliRunner().invoke(command_line, [*command, "--json"])
    assert told.exit_code == 0, told.output
    assert output.read_bytes()[:4] == b"glTF"
    assert json.loads(told.stdout)["neutral"] is not None
    tables = CliRunner().invoke(command_line, command)
    assert "OpenFace 2" in tables.output

    source.write_text("name,age\nJoe,7\n")
    with pytest.raises(ServiceError, match="expected those of OpenFace 2") as refused:
        service.save_track(source, output)
    assert (refused.value.status, refused.value.error) == (422, "invalid_track")
    output.unlink()
    refused_too = CliRunner().invoke(command_line, command)
    assert refused_too.exit_code == 2
    assert "expected those of OpenFace 2" in " ".join(refused_too.output.split())
    assert sorted(path.name for path in tmp_path.iterdir()) == ["laugh.csv"]
