"""The examples run as they are, and do to a face what they say."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import settings_in
from fastapi import FastAPI

from engine import Keyframe, Rig, arkit_blend
from service.app import create_app
from service.client import Client, Face
from service.server import running

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.py"))
SMILE = re.compile(r"(before|speaking|after): (.+); smile (\d\.\d+); (.+)")


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> FastAPI:
    return create_app(settings_in(tmp_path_factory.mktemp("examples")))


@pytest.fixture(scope="module")
def service(app: FastAPI, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """A client of a service that runs."""
    settings = settings_in(tmp_path_factory.mktemp("served"))
    with running(app, settings) as url, Client(url) as client:
        client.wait_until_ready()
        yield client


@pytest.fixture
def face(service: Client) -> Iterator[Face]:
    with service.open_face() as opened:
        yield opened


def run(name: str, *arguments: str) -> str:
    """Run an example as a person would, and return what it prints."""
    program = next(path for path in EXAMPLES if path.name == name)
    done = subprocess.run(
        [sys.executable, str(program), *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def told(app: FastAPI, face: Face) -> tuple[Rig, list[Keyframe]]:
    """Return a face's rig, and what it was told so far."""
    session = app.state.parts.sessions._live[face.session]
    commands = [each.command for each in session.commands]
    return session.rig, [command for command in commands if isinstance(command, Keyframe)]


@pytest.mark.parametrize("program", EXAMPLES, ids=lambda path: path.name)
def test_an_example_is_short_and_named_in_the_documents(program: Path) -> None:
    assert len(program.read_text("utf-8").splitlines()) <= 60
    assert "http://127.0.0.1:8000" in program.read_text("utf-8")
    assert program.name in (ROOT / "docs" / "api.md").read_text("utf-8")


def test_a_smile_outlives_what_the_chat_agent_says(
    app: FastAPI, service: Client, face: Face
) -> None:
    said = run("chat_agent.py", service.url, "--face", face.session, "--seconds", "0.5")
    rows = {when: (float(pull), held) for when, _, pull, held in SMILE.findall(said)}
    assert rows["before"][0] > 0.2
    assert rows["after"][0] == pytest.approx(rows["before"][0], abs=0.05)
    assert rows["before"][1] == rows["after"][1] == "dialogue in emotion"
    assert rows["speaking"][1] == "dialogue in emotion and voice in speech"
    _, commands = told(app, face)
    felt = next(command for command in commands if command.layer == "emotion")
    assert felt.ttl is not None
    assert felt.plays["found"] == "scores"
    visemes = [command for command in commands if command.layer == "speech"]
    assert {command.owner for command in visemes} == {"voice"}
    assert len(visemes) >= 10
    assert face.state()["layers"] == {}


def test_the_puppet_follows_the_phone_and_lets_go(
    app: FastAPI, service: Client, face: Face
) -> None:
    said = run("arkit_puppet.py", service.url, "--face", face.session, "--seconds", "1")
    assert said.count("warning: mouthLeft: FACS has no unit") == 1
    assert "held now: nothing" in said
    _, commands = told(app, face)
    assert len(commands) >= 28  # The last ones may go with the socket.
    assert {(command.owner, command.layer) for command in commands} == {("phone", "puppet")}
    smiles = [command.action_units["L12"] for command in commands]
    assert smiles == sorted(smiles)
    assert smiles[-1] > 0.5
    one = arkit_blend({"eyeBlinkLeft": 1.0}).units
    assert max(command.action_units[key] for command in commands for key in one) > 0.8
    assert any(command.gaze.get("yaw") for command in commands)


def test_the_agent_finds_feels_winks_and_exports(app: FastAPI, service: Client) -> None:
    said = run("mcp_agent.py", service.url, "--seconds", "0.7")
    (session,) = re.findall(r"\?session=(\w+)", said)
    face = service.face(session)
    (writer,) = face.state()["layers"]["emotion"]["writers"]
    assert writer["owner"] == "example-agent"
    assert writer["emotion"]["label"] == "amused"
    assert writer["action_units"]["L46"] == 1.0
    assert "set_action_units" in said
    assert "warning: " in said
    address = re.findall(r"frames of what it did: (\S+)", said)[0]
    frames = int(re.findall(r"(\d+) frames", said)[0])
    assert frames == pytest.approx(0.7 * 15 + 1, abs=1)
    data = service.call("GET", address.removeprefix(service.url)).content
    assert data[:4] == b"glTF"
    face.close()


def test_packed_frames_are_read_by_what_the_page_says(service: Client) -> None:
    said = run("stream_reader.py", service.url)
    rows = re.findall(r"tick (\d+): (\d+) bytes, up to (\d+\.\d+) mm", said)
    ticks = [int(tick) for tick, _, _ in rows]
    assert ticks == sorted(ticks)
    assert float(rows[-1][2]) > 4.0
    assert sorted(int(size) for _, size, _ in rows)[len(rows) // 2] < 1500
