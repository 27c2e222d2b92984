"""The tools of chat agents, through the protocol's own client, against a running service."""

from __future__ import annotations

import json
import time
import urllib.request
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from typing import Any

import anyio
import httpx2
import jsonschema
import pytest
from conftest import settings_in
from mcp import Client
from mcp.client.streamable_http import streamable_http_client
from mcp_types import CallToolResult, Implementation, ResourceLink, TextContent

from engine import builtin_rig, lexicon, people, resolve_label
from service.agents.caller import owner_named
from service.agents.tools import TOOLS
from service.app import create_app
from service.server import running

pytestmark = pytest.mark.anyio
NAMES = [
    "list_expressions",
    "open_face",
    "set_emotion",
    "set_action_units",
    "get_state",
    "export_clip",
]


@pytest.fixture(scope="module")
def anyio_backend() -> str:
    return "asyncio"


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service with a key, started for these tests."""
    settings = settings_in(tmp_path_factory.mktemp("agents"), api_keys=("secret",))
    with running(create_app(settings), settings) as address:
        yield address


@asynccontextmanager
async def agent(
    url: str, *, name: str | None = "Test Agent", mode: str = "auto"
) -> AsyncIterator[Client]:
    """Connect as a client would, with the key."""
    async with httpx2.AsyncClient(headers={"X-API-Key": "secret"}, timeout=120) as http:
        transport = streamable_http_client(f"{url}/mcp/", http_client=http)
        info = Implementation(name=name, version="1") if name else None
        async with Client(transport, client_info=info, mode=mode) as client:
            yield client


async def call(client: Client, tool: str, **arguments: Any) -> dict[str, Any]:
    """Call a tool and return its typed result, which its schema describes."""
    answer = await client.call_tool(tool, arguments)
    assert not answer.is_error, answer.content
    schema = next(t.answers for t in TOOLS if t.name == tool).model_json_schema()
    jsonschema.validate(answer.structured_content, schema)
    text = answer.content[0]
    assert isinstance(text, TextContent)
    assert json.loads(text.text) == answer.structured_content
    result: dict[str, Any] = answer.structured_content
    return result


def error_of(answer: CallToolResult) -> dict[str, Any]:
    """Return the error of a call that was refused."""
    assert answer.is_error
    assert isinstance(answer.content[0], TextContent)
    error: dict[str, Any] = json.loads(answer.content[0].text)
    return error


def asked(url: str) -> dict[str, Any]:
    request = urllib.request.Request(url, headers={"X-API-Key": "secret"})
    with urllib.request.urlopen(request, timeout=30) as answer:
        found: dict[str, Any] = json.load(answer)
        return found


async def test_the_tools_are_described_for_a_model(url: str) -> None:
    async with agent(url) as client:
        assert client.instructions is not None
        assert "viewer_url" in client.instructions
        tools = {tool.name: tool for tool in (await client.list_tools()).tools}
    assert [*tools] == NAMES
    for tool in tools.values():
        assert tool.description is not None
        assert tool.output_schema is not None
        jsonschema.Draft202012Validator.check_schema(tool.input_schema)
        jsonschema.Draft202012Validator.check_schema(tool.output_schema)
        for name, field in tool.input_schema["properties"].items():
            assert "description" in field, f"{tool.name}.{name}"
    labels = tools["set_emotion"].input_schema["properties"]["label"]
    assert labels["anyOf"][0]["enum"] == [*lexicon().recipes]
    rigs = tools["open_face"].input_schema["properties"]["rig"]["anyOf"][0]["enum"]
    assert {*people(), "standard", "paper"} == {*rigs}
    units = tools["set_action_units"].input_schema["properties"]["action_units"]
    named = next(form for form in units["anyOf"] if form["type"] == "object")["propertyNames"]
    assert named["anyOf"][0]["enum"] == [*builtin_rig("standard").action_units]
    reading = {name for name, tool in tools.items() if tool.annotations.read_only_hint}
    assert reading == {"list_expressions", "get_state"}


async def test_a_face_lives_if_an_agent_says_so(url: str) -> None:
    lives = {}
    async with agent(url) as client, httpx2.AsyncClient(headers={"X-API-Key": "secret"}) as http:
        for alive in (True, False):
            face = (await call(client, "open_face", alive=alive))["session_id"]
            lives[alive] = (await http.get(f"{url}/api/sessions/{face}")).json()["idle"]
            await http.delete(f"{url}/api/sessions/{face}")
    assert lives[True]["blinks"] == 1.0
    assert lives[False] is None


async def test_an_agent_opens_a_face_and_makes_it_feel(url: str) -> None:
    async with agent(url) as client:
        face = await call(client, "open_face")
        assert face["viewer_url"].startswith(f"{url}/?session={face['session_id']}&ticket=")
        assert face["rig"] == "standard"
        face_id = face["session_id"]
        played = await call(
            client, "set_emotion", session_id=face_id, label="joyful", intensity=0.5, fade_out=None
        )
        assert played["recipe"] == resolve_label("joyful").facs
        assert played["source"]
        assert played["owner"] == "Test-Agent"
        state = await call(client, "get_state", session_id=face_id)
        assert state["action_units"] == pytest.approx(played["action_units"])
        (layer,) = state["layers"]
        assert layer["layer"] == "emotion"
        assert [writer["owner"] for writer in layer["writers"]] == ["Test-Agent"]
    held = asked(f"{url}/api/sessions/{face_id}")
    assert held["merged"]["facs"] == state["facs"]


async def test_the_latest_call_is_the_whole_face(url: str) -> None:
    async with agent(url) as client:
        face = (await call(client, "open_face"))["session_id"]
        await call(client, "set_action_units", session_id=face, facs="4D+L46E+51C")
        while not (pose := (await call(client, "get_state", session_id=face))["pose"]):
            await anyio.sleep(0.02)
        assert set(pose) == {"head"}  # What is not commanded is left out.
        assert set(pose["head"]) == {"yaw"}
        await call(client, "set_emotion", session_id=face, label="happiness")
        state = await call(client, "get_state", session_id=face)
        assert state["action_units"] == pytest.approx(resolve_label("happiness").units)
        units = await call(
            client, "set_action_units", session_id=face, facs="R46", keep=True, fade_in=0.1
        )
        assert set(units["action_units"]) == {*resolve_label("happiness").units, "R46"}
        units = await call(client, "set_action_units", session_id=face, action_units={"AU4": "B"})
        assert units["action_units"] == {"AU4": 0.4}
        assert units["facs"] == "4B"
        await call(client, "set_action_units", session_id=face, facs="0")
        assert (await call(client, "get_state", session_id=face))["facs"] == "0"


async def test_what_clashes_is_said(url: str) -> None:
    async with agent(url) as client:
        face = (await call(client, "open_face"))["session_id"]
        units = await call(client, "set_action_units", session_id=face, facs="51C+52B+40")
        assert {"head_turns_one_way", "absent"} == {
            warning.rsplit("(rule ", 1)[1].rstrip(")") for warning in units["warnings"]
        }


async def test_a_mixture_with_a_hold_passes_by_itself(url: str) -> None:
    async with agent(url) as client:
        face = (await call(client, "open_face"))["session_id"]
        scores = [{"label": "joy", "score": 0.6}, {"label": "surprise", "score": 0.4}]
        played = await call(
            client, "set_emotion", session_id=face, scores=scores, hold=0.1, fade_out=0.1
        )
        assert played["found"] == "scores"
        (layer,) = (await call(client, "get_state", session_id=face))["layers"]
        assert layer["writers"][0]["expires_in"] > 0
        assert layer["writers"][0]["emotion"] == "0.6 happiness + 0.4 surprise"
        deadline = time.monotonic() + 30
        while (await call(client, "get_state", session_id=face))["layers"]:
            assert time.monotonic() < deadline


@pytest.mark.parametrize(
    ("tool", "arguments", "error", "known"),
    [
        ("set_emotion", {"label": "suprise"}, "unknown_emotion", "surprise"),
        ("set_emotion", {"label": "joy", "intensity": 2}, "invalid_arguments", None),
        ("set_emotion", {"label": "joy", "strength": 1}, "invalid_arguments", "intensity"),
        ("set_emotion", {}, "invalid_body", None),
        ("set_emotion", {"label": "joy", "vocabulary": "big7"}, "unknown_vocabulary", None),
        ("set_action_units", {"facs": "6C+"}, "invalid_notation", None),
        ("set_action_units", {"facs": "99C"}, "unknown_action_unit", "AU12"),
        ("set_action_units", {}, "invalid_body", None),
        ("get_state", {"session_id": "nobody"}, "unknown_session", None),
        ("open_face", {"rig": "nobody"}, "unknown_rig", None),
        ("open_face", {"alive": "yes"}, "invalid_arguments", None),
        ("list_expressions", {"vocabulary": "big7"}, "unknown_vocabulary", None),
        ("export_clip", {}, "invalid_body", None),
        ("export_clip", {"timeline": [{"time": 0.0}]}, "invalid_body", None),
        ("export_clip", {"clip_id": "nobody"}, "unknown_clip", None),
    ],
)
async def test_what_is_refused_says_why_and_what_is_known(
    url: str, tool: str, arguments: dict[str, Any], error: str, known: str | None
) -> None:
    async with agent(url) as client:
        if tool.startswith("set_"):
            arguments = {"session_id": (await call(client, "open_face"))["session_id"], **arguments}
        refused = error_of(await client.call_tool(tool, arguments))
    assert refused["error"] == error
    assert refused["message"]
    if known is not None:
        assert known in refused["known"]


async def test_expressions_are_listed_by_part_and_by_vocabulary(url: str) -> None:
    async with agent(url) as client:
        everything = await call(client, "list_expressions")
        labels = await call(client, "list_expressions", parts=["emotions"], vocabulary="goemotions")
    assert [line["label"] for line in everything["emotions"]] == [*lexicon().recipes]
    assert len(everything["action_units"]) == len(builtin_rig("standard").action_units)
    assert all(line["shows"] for line in everything["action_units"])
    assert {line["rig"] for line in everything["people"]} == {"standard", *people()}
    assert "amusement" in {line["label"] for line in labels["emotions"]}
    assert labels["action_units"] == labels["people"] == []


async def test_a_timeline_is_rendered_and_linked(url: str) -> None:
    async with agent(url) as client:
        timeline = [{"time": 0.0, "emotion": "joy"}, {"time": 0.5, "facs": "4D"}]
        answer = await client.call_tool(
            "export_clip", {"timeline": timeline, "duration": 1.0, "fps": 10, "wait": 60.0}
        )
        clip: dict[str, Any] = answer.structured_content
        while clip["status"] != "done":
            assert "clip_id" in clip["next_step"]
            answer = await client.call_tool("export_clip", {"clip_id": clip["clip_id"]})
            clip = answer.structured_content
    (link,) = [block for block in answer.content if isinstance(block, ResourceLink)]
    assert str(link.uri) == clip["url"]
    request = urllib.request.Request(clip["url"], headers={"X-API-Key": "secret"})
    with urllib.request.urlopen(request, timeout=30) as file:
        data = file.read()
    assert data[:4] == b"glTF"
    assert link.size == len(data) == clip["bytes"]
    assert clip["frames"] == 11
    request = urllib.request.Request(clip["csv_url"], headers={"X-API-Key": "secret"})
    with urllib.request.urlopen(request, timeout=30) as file:
        header, *rows = (line.split(",") for line in file.read().decode().splitlines())
    smile, frown = header.index("AU12"), header.index("AU4")
    assert float(rows[4][smile]) > 0.0 == float(rows[4][frown])
    assert float(rows[-1][frown]) > 0.5
    assert float(rows[-1][smile]) < float(rows[4][smile])


async def test_what_a_face_did_last_is_rendered(url: str) -> None:
    async with agent(url) as client:
        face = (await call(client, "open_face"))["session_id"]
        refused = error_of(await client.call_tool("export_clip", {"session_id": face}))
        assert refused["error"] == "nothing_recorded"
        await call(client, "set_emotion", session_id=face, label="joy", fade_in=0.1)
        # A second after the first it sleeps, and its time stands still.
        while (await call(client, "get_state", session_id=face))["tick"] < 40:
            await anyio.sleep(0.02)
        clip = await call(client, "export_clip", session_id=face, last=0.5, fps=30, wait=60.0)
        while clip["status"] != "done":
            clip = await call(client, "export_clip", clip_id=clip["clip_id"])
        assert clip["frames"] == 16
        assert clip["duration"] == pytest.approx(0.5)
        while not (await call(client, "get_state", session_id=face))["asleep"]:
            await anyio.sleep(0.02)
        clip = await call(client, "export_clip", session_id=face, last=4.0, fps=10, wait=60.0)
        while clip["status"] != "done":
            clip = await call(client, "export_clip", clip_id=clip["clip_id"])
        assert clip["duration"] == pytest.approx(4.0)


async def test_a_client_of_the_older_protocol_is_served(url: str) -> None:
    async with agent(url, mode="legacy") as client:
        face = await call(client, "open_face")
        assert face["owner"] == "mcp"


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 401),
        ({"X-API-Key": "secret", "Host": "evil.example"}, 421),
        ({"X-API-Key": "secret", "Origin": "https://evil.example"}, 403),
    ],
)
@pytest.mark.parametrize("path", ["/mcp", "/mcp/"])
async def test_strangers_are_turned_away(
    url: str, path: str, headers: dict[str, str], status: int
) -> None:
    async with httpx2.AsyncClient() as http:
        answer = await http.post(url + path, json={}, headers=headers)
    assert answer.status_code == status
    assert answer.json()["error"]


async def test_large_messages_and_other_methods_are_refused(url: str) -> None:
    key = {"X-API-Key": "secret"}
    async with httpx2.AsyncClient(headers=key) as http:
        large = await http.post(f"{url}/mcp/", content=b" " * 4_000_001)
        got = await http.get(f"{url}/mcp/")
        other = await http.get(f"{url}/mcp/other")
        broken = await http.post(f"{url}/mcp/", json={"nothing": 1})
    assert large.status_code == 413
    assert (got.status_code, got.headers["Allow"]) == (405, "POST")
    assert other.status_code == 404
    assert broken.status_code == 400


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("Claude Desktop", "Claude-Desktop"),
        ("näme/1.0", "n-me-1.0"),
        ("x" * 80, "x" * 64),
        ("", "mcp"),
        (None, "mcp"),
        ("日本", "mcp"),
        ("anyone", "mcp"),
    ],
)
def test_a_client_s_name_is_its_owner(name: str | None, owner: str) -> None:
    assert owner_named(name) == owner
