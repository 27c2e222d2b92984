"""Keys: who is let in, what each sees, how much it may take, and what its tickets open."""

from __future__ import annotations

import ast
import hashlib
import inspect
import json
import logging
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from conftest import LOCAL, api_routes, parts_of, settings_in, until
from fastapi.routing import APIWebSocketRoute
from sqlalchemy import event
from starlette.testclient import TestClient, WebSocketDenialResponse, WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

import service.components
from service import stream
from service.agents.tools import TOOLS
from service.app import create_app
from service.clips import Clips
from service.guard import KEY_SUBPROTOCOL
from service.keys import KeyRefused, add_key, is_loopback, remove_key
from service.rigs import Rigs
from service.server import server_of
from service.sessions import Sessions
from service.settings import Settings
from service.store import Store

CLIP = {"timeline": [{"time": 0.0, "facs": "12C"}], "duration": 1.0, "fps": 10}
SMALL = {"sessions": 1, "viewers": 1, "clip_seconds": 1.5, "upload_bytes": 2000}
OPEN = {"/api/health", "/api/ready"}


@dataclass
class Keyed:
    """A running service with keys, and what two of them made."""

    client: TestClient
    settings: Settings
    keys: dict[str, str]
    session: str = ""
    clip: str = ""

    def headers(self, name: str) -> dict[str, str]:
        return {"X-API-Key": self.keys[name]}

    def call(self, name: str, method: str, path: str, body: object = None) -> Any:
        return self.client.request(method, path, json=body, headers=self.headers(name))

    def open(self, name: str) -> str:
        answer = self.call(name, "POST", "/api/sessions", {})
        assert answer.status_code == 201, answer.text
        return str(answer.json()["id"])

    def ticket(self, name: str, session: str, **asked: object) -> str:
        answer = self.call(name, "POST", f"/api/sessions/{session}/tickets", asked)
        assert answer.status_code == 201, answer.text
        return str(answer.json()["ticket"])

    def stream(self, session: str, headers: Any = None, query: str = "") -> WebSocketTestSession:
        path = f"ws://localhost/api/sessions/{session}/stream{query}"
        return self.client.websocket_connect(path, headers={**(headers or {})})

    @contextmanager
    def key(self, name: str, **quota: float) -> Iterator[None]:
        """A key for a while, which the running service is given a moment to take notice of."""
        store = Store(self.settings.database)
        self.keys[name] = add_key(store, name, quota)
        self.noticed(name, 200)
        yield
        remove_key(store, name)
        store.close()
        self.noticed(name, 401)

    def noticed(self, name: str, status: int) -> None:
        until(lambda: self.call(name, "GET", "/api/people").status_code == status)


@pytest.fixture(scope="module")
def keyed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Keyed]:
    """A service with the keys of ada and bob, a session and a clip of ada's."""
    settings = settings_in(tmp_path_factory.mktemp("keys"), api_keys=("from the environment",))
    store = Store(settings.database)
    keys = {name: add_key(store, name) for name in ("ada", "bob")}
    store.close()
    with (
        pytest.MonkeyPatch.context() as patch,
        TestClient(create_app(settings), base_url=LOCAL) as client,
    ):
        patch.setattr(service.components, "_KEYS_READ_SECONDS", 0.05)
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        made = Keyed(client, settings, {**keys, "env": "from the environment"})
        made.session = made.open("ada")
        made.clip = made.call("ada", "POST", "/api/clips", CLIP).json()["id"]
        yield made


def denied(socket: WebSocketTestSession) -> int:
    with pytest.raises(WebSocketDenialResponse) as refused:
        socket.__enter__()
    return int(refused.value.status_code)


def first(socket: WebSocketTestSession, kind: str) -> dict[str, Any]:
    """Read until an event of that type comes."""
    for _ in range(600):
        message = socket.receive()
        if message["type"] == "websocket.close":
            raise WebSocketDisconnect(message["code"], message["reason"])
        if message.get("text") is not None:
            told: dict[str, Any] = json.loads(message["text"])
            if told["type"] == kind:
                return told
    raise AssertionError(f"no {kind} came")


# Who is let in.


@pytest.mark.parametrize(
    "path",
    [*{path: None for _, path in api_routes()}, "/docs", "/openapi.json", "/mcp", "/mcp/"],
)
def test_nothing_but_health_answers_without_a_key(keyed: Keyed, path: str) -> None:
    for headers in ({}, {"X-API-Key": keyed.keys["ada"] + "0"}, {"Authorization": "Bearer rsr_"}):
        answer = keyed.client.get(path, headers=headers)
        assert answer.status_code == (200 if path in OPEN else 401), answer.text


def test_a_key_goes_in_either_header_and_as_a_subprotocol(keyed: Keyed) -> None:
    for name in ("ada", "env"):
        for headers in (keyed.headers(name), {"Authorization": f"Bearer {keyed.keys[name]}"}):
            assert keyed.client.get("/api/sessions", headers=headers).status_code == 200
    path = f"ws://localhost/api/sessions/{keyed.session}/stream"
    offered = ["risorius.v1", KEY_SUBPROTOCOL + keyed.keys["ada"]]
    with keyed.client.websocket_connect(path, subprotocols=offered) as socket:
        assert socket.accepted_subprotocol == "risorius.v1"
    assert denied(keyed.stream(keyed.session)) == 401


def test_another_secret_under_a_known_id_is_no_key(keyed: Keyed) -> None:
    begins = keyed.keys["ada"].rsplit("_", 1)[0]
    forged = f"{begins}_{'0' * 64}"
    answer = keyed.client.get("/api/sessions", headers={"X-API-Key": forged})
    assert answer.status_code == 401


def test_guesses_are_slowed_down(tmp_path: Path) -> None:
    settings = settings_in(tmp_path, api_keys=("k",), requests_per_second=2)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        answers = [client.get("/api/sessions", headers={"X-API-Key": "g"}) for _ in range(8)]
    assert answers[0].status_code == 401
    assert answers[-1].status_code == 429


def test_only_hashes_are_kept(keyed: Keyed) -> None:
    folder = keyed.settings.data_dir
    kept = b"".join(path.read_bytes() for path in folder.glob("risorius.sqlite3*"))
    for name in ("ada", "bob"):
        key = keyed.keys[name]
        assert key.rsplit("_", 1)[1].encode() not in kept
        assert hashlib.sha256(key.encode()).hexdigest().encode() in kept


def test_no_request_waits_for_the_database_to_know_its_key(keyed: Keyed) -> None:
    parts = parts_of(keyed.client)
    asked: list[str] = []

    def note(_c: Any, _u: Any, statement: str, *_: Any) -> None:
        # Keys are read, and the ticks of sessions kept, beside the requests and not for one.
        if "api_keys" not in statement and not statement.startswith("UPDATE sessions SET tick="):
            asked.append(statement)

    event.listen(parts.store.engine, "before_cursor_execute", note)
    try:
        for _ in range(10):
            assert keyed.call("ada", "GET", "/api/people").status_code == 200
            assert keyed.call("ada", "GET", f"/api/sessions/{keyed.session}").status_code == 200
    finally:
        event.remove(parts.store.engine, "before_cursor_execute", note)
    assert asked == []


def test_a_key_counts_and_ends_while_the_service_runs(keyed: Keyed) -> None:
    with keyed.key("eve"):
        session = keyed.open("eve")
        ticket = keyed.ticket("eve", session, role="read")
        socket = keyed.stream(session, query=f"?ticket={ticket}")
        with socket:
            first(socket, "hello")
            store = Store(keyed.settings.database)
            remove_key(store, "eve")
            with pytest.raises(WebSocketDisconnect) as ended:
                first(socket, "never")
            assert (ended.value.code, ended.value.reason) == (1008, "the key was taken away")
        keyed.noticed("eve", 401)
        again = keyed.client.get(f"/api/sessions/{session}?ticket={ticket}")
        assert again.status_code == 401
        old = keyed.keys["eve"]
        keyed.keys["eve"] = add_key(store, "eve")
        store.close()
        keyed.noticed("eve", 200)
        assert keyed.keys["eve"] != old
        assert keyed.call("eve", "GET", f"/api/sessions/{session}").status_code == 200
        assert keyed.call("eve", "DELETE", f"/api/sessions/{session}").status_code == 204


def test_the_first_key_closes_an_open_service_and_taking_it_away_does_not_open_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(service.components, "_KEYS_READ_SECONDS", 0.02)
    settings = settings_in(tmp_path)
    store = Store(settings.database)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        path = f"ws://localhost/api/sessions/{session}/stream"
        with client.websocket_connect(path) as socket:
            first(socket, "hello")
            add_key(store, "ada")
            with pytest.raises(WebSocketDisconnect) as ended:
                first(socket, "never")
            assert (ended.value.code, ended.value.reason) == (1008, "a key is needed now")
        until(lambda: client.get("/api/people").status_code == 401)
        remove_key(store, "ada")
        until(lambda: not parts_of(client).keys._stored)
        assert client.get("/api/people").status_code == 401
    store.close()


def test_a_service_that_others_reach_is_closed_without_keys_too(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, host="0.0.0.0"))
    with TestClient(app, base_url=LOCAL) as client:
        assert client.get("/api/sessions").status_code == 401


@pytest.mark.parametrize(
    ("host", "local"),
    [
        ("127.0.0.1", True),
        ("127.8.8.8", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("::", False),
        ("192.168.1.4", False),
        ("localhost.example", False),
        ("", False),
    ],
)
def test_what_is_reached_from_this_machine_only(host: str, local: bool) -> None:
    assert is_loopback(host) is local


@pytest.mark.parametrize("name", ["", "a b", "-a", "env:1", "a" * 33, "ä"])
def test_a_key_has_a_plain_name_of_its_own(tmp_path: Path, name: str) -> None:
    store = Store(f"sqlite:///{tmp_path / 'keys.sqlite3'}")
    with pytest.raises(KeyRefused, match="names no key"):
        add_key(store, name)
    add_key(store, "ada")
    with pytest.raises(KeyRefused, match="There is a key"):
        add_key(store, "ada")
    with pytest.raises(KeyRefused, match="there is ada"):
        remove_key(store, "eve")
    store.close()


def test_a_database_of_an_earlier_version_takes_owners(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path / 'old.sqlite3'}"
    store = Store(url)
    with store.engine.begin() as connection:
        connection.exec_driver_sql("ALTER TABLE sessions DROP COLUMN made_by")
        connection.exec_driver_sql(
            "INSERT INTO sessions (id, rig, model, held, created, used)"
            " VALUES ('s', 'standard', '{}', '[]', 1, 1)"
        )
    store.close()
    store = Store(url)
    (row,) = store.sessions()
    assert row.made_by == ""
    store.close()


# What each sees.

BODIES: dict[str, object] = {
    "/api/sessions/{session_id}/controls": {"facs": "12C"},
    "/api/sessions/{session_id}/emotions": {"label": "joy"},
    "/api/sessions/{session_id}/speech": {"visemes": [{"viseme": "aa", "time": 0.0}]},
}
"""What a route takes that does not take {}: without it a new one answers 422 below, not 404."""
THINGS = [route for route in api_routes() if "{session_id}" in route[1] or "{clip}" in route[1]]


@pytest.mark.parametrize(("method", "path"), THINGS)
def test_what_another_key_made_is_not_there(keyed: Keyed, method: str, path: str) -> None:
    place = path.format(session_id=keyed.session, clip=keyed.clip, muscle="zygomatic_major.L")
    answer = keyed.call("bob", method, place, BODIES.get(path, {}))
    assert answer.status_code == 404, answer.text
    assert answer.json()["error"] in ("unknown_session", "unknown_clip")
    nobody = path.format(session_id="nobody", clip="nobody", muscle="zygomatic_major.L")
    unknown = keyed.call("bob", method, nobody, BODIES.get(path, {}))
    said = answer.json()["message"].replace(keyed.session, "nobody").replace(keyed.clip, "nobody")
    assert unknown.json() == {**answer.json(), "message": said}


def test_nobody_waits_for_another_key_s_clip(keyed: Keyed) -> None:
    long = keyed.call("ada", "POST", "/api/clips", {**CLIP, "duration": 100.0}).headers["Location"]
    assert keyed.call("bob", "GET", f"{long}?wait=60").status_code == 404
    assert keyed.call("ada", "GET", long).json()["status"] in ("queued", "running")
    assert keyed.call("ada", "DELETE", long).status_code == 204
    assert keyed.call("ada", "DELETE", long).status_code == 204


def test_no_socket_shows_another_key_s_session(keyed: Keyed) -> None:
    app: Any = keyed.client.app
    places = [r.path for r in app.routes if isinstance(r, APIWebSocketRoute)]
    places += [r.path for r in stream.router.routes]
    assert places
    for place in {place.format(session_id=keyed.session) for place in places}:
        address = f"ws://localhost{place}"
        assert denied(keyed.client.websocket_connect(address, headers=keyed.headers("bob"))) == 404


def test_lists_hold_one_s_own(keyed: Keyed) -> None:
    own = keyed.open("bob")
    for name, seen in (("ada", keyed.session), ("bob", own), ("env", None)):
        lines = keyed.call(name, "GET", "/api/sessions").json()["sessions"]
        assert [line["id"] for line in lines if line["id"] in (keyed.session, own)] == (
            [seen] if seen else []
        )
    clips = {n: keyed.call(n, "GET", "/api/clips").json()["clips"] for n in ("ada", "bob")}
    assert (len(clips["ada"]), len(clips["bob"])) == (1, 0)
    keyed.call("bob", "DELETE", f"/api/sessions/{own}")


def test_what_a_key_made_is_its_own_after_a_restart_too(keyed: Keyed) -> None:
    parts = parts_of(keyed.client)
    assert parts.store.session(keyed.session).made_by == "ada"  # type: ignore[union-attr]
    # Asleep in the store, as after a restart; a stranger does not wake it.
    session = parts.sessions._live.pop(keyed.session)
    keyed.client.portal.call(parts.runner.close, keyed.session)  # type: ignore[union-attr]
    path = f"/api/sessions/{keyed.session}"
    assert keyed.call("bob", "GET", path).status_code == 404
    assert keyed.session not in parts.sessions._live
    assert keyed.call("ada", "GET", path).status_code == 200
    assert parts.sessions._live[keyed.session].made_by == session.made_by == "ada"


def test_a_derived_rig_is_listed_to_who_made_it_and_read_by_its_id(keyed: Keyed) -> None:
    body = {"emotions": {"sly": "L12C"}}
    rig = keyed.call("ada", "POST", "/api/rigs", body).json()["id"]

    def listed(name: str) -> bool:
        lines = keyed.call(name, "GET", "/api/rigs").json()["rigs"]
        return rig in {line["id"] for line in lines}

    assert listed("ada")
    assert not listed("bob")
    assert keyed.call("bob", "GET", f"/api/rigs/{rig}").status_code == 200
    for method, path, sent in (
        ("GET", "/api/rigs/nobody", None),
        ("POST", "/api/sessions", {"rig": "nobody"}),
        ("POST", "/api/clips", {**CLIP, "rig": "nobody"}),
    ):
        unknown = keyed.call("bob", method, path, sent)
        assert unknown.status_code == 404
        assert rig not in unknown.json()["known"]
    assert keyed.call("bob", "POST", "/api/rigs", body).status_code == 200
    assert listed("bob")


def test_a_retry_never_gets_another_key_s_answer(keyed: Keyed) -> None:
    answers = [
        keyed.client.post(
            "/api/sessions", json={}, headers={**keyed.headers(name), "Idempotency-Key": "same"}
        ).json()
        for name in ("ada", "bob", "ada")
    ]
    assert answers[0]["id"] == answers[2]["id"] != answers[1]["id"]
    for name, answer in zip(("ada", "bob"), answers, strict=False):
        keyed.call(name, "DELETE", f"/api/sessions/{answer['id']}")


TOLD = {
    "set_emotion": {"label": "joy"},
    "set_action_units": {"facs": "12C"},
}
ASKED = [
    (tool.name, field, error)
    for tool in TOOLS
    for field, error in (("session_id", "unknown_session"), ("clip_id", "unknown_clip"))
    if field in tool.asks.model_fields
]


@pytest.mark.parametrize(("tool", "field", "error"), ASKED)
def test_no_agent_finds_what_another_key_made(
    keyed: Keyed, tool: str, field: str, error: str
) -> None:
    thing = keyed.session if field == "session_id" else keyed.clip
    result = called(keyed, "bob", tool, {field: thing, **TOLD.get(tool, {})})
    assert result["isError"]
    assert json.loads(result["content"][0]["text"])["error"] == error


def called(keyed: Keyed, name: str, tool: str, arguments: dict[str, Any]) -> dict[str, Any]:
    """Call a tool with the key of that name and return the result."""
    call = {"name": tool, "arguments": arguments}
    answer = keyed.client.post(
        "/mcp/",
        json={"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": call},
        headers={**keyed.headers(name), "Accept": "application/json, text/event-stream"},
    )
    assert answer.status_code == 200, answer.text
    result: dict[str, Any] = answer.json()["result"]
    return result


def test_the_page_that_an_agent_hands_out_opens_without_a_key(keyed: Keyed) -> None:
    opened = called(keyed, "ada", "open_face", {})["structuredContent"]
    session, query = opened["session_id"], opened["viewer_url"].partition("&")[2]
    assert query.startswith("ticket=")
    assert denied(keyed.stream(session)) == 401
    with keyed.stream(session, query=f"?{query}") as socket:
        first(socket, "hello")
    looked = called(keyed, "ada", "get_state", {"session_id": session})["structuredContent"]
    assert looked["viewer_url"] == opened["viewer_url"]
    keyed.call("ada", "DELETE", f"/api/sessions/{session}")


def test_counts_are_read_with_any_key_and_name_nobody(keyed: Keyed) -> None:
    assert keyed.client.get("/metrics").status_code == 401
    for reader in ("ada", "bob"):
        text = keyed.call(reader, "GET", "/metrics").text
        assert "risorius_ticks_total" in text
        assert not [name for name in keyed.keys if f'"{name}"' in text]
        assert keyed.session not in text
        assert keyed.clip not in text


# How much it may take.


def test_sessions_of_a_key_are_bounded(keyed: Keyed) -> None:
    with keyed.key("small", **SMALL):
        session = keyed.open("small")
        refused = keyed.call("small", "POST", "/api/sessions", {})
        assert refused.status_code == 429
        assert refused.json()["error"] == "quota_exceeded"
        idle = keyed.settings.session_idle_seconds
        assert idle - 60 < int(refused.headers["Retry-After"]) <= idle + 60
        assert keyed.open("ada")
        keyed.call("small", "DELETE", f"/api/sessions/{session}")
        session = keyed.open("small")
        keyed.call("small", "DELETE", f"/api/sessions/{session}")


def test_viewers_of_a_key_are_bounded_on_all_its_sessions(keyed: Keyed) -> None:
    with keyed.key("small", **{**SMALL, "sessions": 2}):
        one, two = keyed.open("small"), keyed.open("small")
        ticket = keyed.ticket("small", two)
        with keyed.stream(one, keyed.headers("small")) as socket:
            first(socket, "hello")
            assert denied(keyed.stream(two, keyed.headers("small"))) == 429
            assert denied(keyed.stream(two, query=f"?ticket={ticket}")) == 429
            with keyed.stream(keyed.session, keyed.headers("ada")) as other:
                first(other, "hello")
        with keyed.stream(two, query=f"?ticket={ticket}") as socket:
            first(socket, "hello")
        for session in (one, two):
            keyed.call("small", "DELETE", f"/api/sessions/{session}")


def test_clips_and_uploads_of_a_key_are_bounded_by_the_hour(keyed: Keyed) -> None:
    with keyed.key("small", **SMALL):
        long = keyed.call("small", "POST", "/api/clips", {**CLIP, "duration": 2.0})
        assert (long.status_code, long.json()["error"]) == (422, "over_quota")
        made = keyed.call("small", "POST", "/api/clips", CLIP)
        assert made.status_code == 202
        clip = made.json()["id"]
        refused = keyed.call("small", "POST", "/api/clips", CLIP)
        assert (refused.status_code, refused.json()["error"]) == (429, "quota_exceeded")
        assert 3540 <= int(refused.headers["Retry-After"]) <= 3660
        # Taking a clip away gives no seconds back, and a restart forgets none of one that is kept.
        parts = parts_of(keyed.client)
        ring = type(parts.keys)(keyed.settings)
        ring.load(parts.store.keys())
        ring.remember(parts.store.clips(since=0.0))
        assert ring.allowance("small").clips.total == 1.0  # type: ignore[union-attr]
        keyed.call("small", "DELETE", f"/api/clips/{clip}")
        assert keyed.call("small", "POST", "/api/clips", CLIP).status_code == 429

        body = b'{"facs": "12C"' + b" " * 900 + b"}"
        headers = {**keyed.headers("small"), "Content-Type": "application/json"}
        statuses = []
        for content in (body, iter([body]), body):  # By its length, by its bytes.
            sent = keyed.client.post("/api/facs", content=content, headers=headers)
            statuses.append(sent.status_code)
        assert statuses == [200, 429, 429]
        assert sent.json()["error"] == "quota_exceeded"
        assert int(sent.headers["Retry-After"]) > 3500
        assert keyed.call("small", "GET", "/api/people").status_code == 200


# What tickets open.


def test_a_ticket_shows_its_session_and_the_page_that_shows_it(keyed: Keyed) -> None:
    answer = keyed.call(
        "ada", "POST", f"/api/sessions/{keyed.session}/tickets", {"role": "read", "seconds": 60}
    )
    assert answer.status_code == 201
    ticket = answer.json()["ticket"]
    assert answer.json() == {
        "ticket": ticket,
        "role": "read",
        "expires_in": 60,
        "url": f"http://localhost/?session={keyed.session}&ticket={ticket}",
    }
    with keyed.stream(keyed.session, query=f"?ticket={ticket}") as socket:
        hello = first(socket, "hello")
    assert hello["role"] == "read"
    rig = hello["rig"]
    for path in (
        f"/api/sessions/{keyed.session}",
        f"/api/sessions/{keyed.session}.glb?textures=0",
        f"/api/rigs/{rig}",
        "/api/rigs/standard",
        hello["surface"],
        "/api/people",
    ):
        together = "&" if "?" in path else "?"
        assert keyed.client.get(f"{path}{together}ticket={ticket}").status_code == 200, path
        bearer = {"Authorization": f"Bearer {ticket}"}
        assert keyed.client.get(path, headers=bearer).status_code == 200, path
    other = keyed.client.get(f"/api/rigs/paper?ticket={ticket}")
    assert (other.status_code, other.json()["error"]) == (404, "unknown_rig")


def test_a_ticket_opens_nothing_else(keyed: Keyed) -> None:
    other = keyed.open("ada")
    ticket = keyed.ticket("ada", keyed.session, role="control")
    for path in (
        f"/api/sessions/{other}",
        f"/api/sessions/{other}.glb",
        "/api/sessions",
        "/api/rigs",
        "/api/clips",
        f"/api/clips/{keyed.clip}",
        "/metrics",
    ):
        answer = keyed.client.get(f"{path}?ticket={ticket}")
        assert (answer.status_code, answer.json()["error"]) == (403, "other_session"), path
    assert denied(keyed.stream(other, query=f"?ticket={ticket}")) == 403
    for method, path in (
        ("POST", f"/api/sessions/{keyed.session}/tickets"),
        ("DELETE", f"/api/sessions/{keyed.session}"),
        ("POST", "/api/sessions"),
        ("POST", "/api/clips"),
        ("POST", "/mcp/"),
    ):
        answer = keyed.client.request(method, f"{path}?ticket={ticket}", json={})
        assert answer.status_code == 403, path
    keyed.call("ada", "DELETE", f"/api/sessions/{other}")
    assert keyed.client.get(f"/api/sessions/{other}?ticket={ticket}").status_code == 403


def test_who_may_read_cannot_command(keyed: Keyed) -> None:
    reads, moves = (keyed.ticket("ada", keyed.session, role=r) for r in ("read", "control"))
    path = f"/api/sessions/{keyed.session}/controls"
    refused = keyed.client.patch(f"{path}?ticket={reads}", json={"facs": "12C"})
    assert (refused.status_code, refused.json()["error"]) == (403, "read_only")
    command = {"type": "controls", "action_units": {"AU12": 0.5}}
    with keyed.stream(keyed.session, query=f"?ticket={reads}") as socket:
        first(socket, "hello")
        for message in (command, {"type": "emotion", "label": "joy"}):
            socket.send_text(json.dumps(message))
            assert first(socket, "error")["error"] == "read_only"
        # Not even which of a recipe's variants comes next.
        assert not parts_of(keyed.client).sessions._live[keyed.session].turns
        state = keyed.call("ada", "GET", f"/api/sessions/{keyed.session}").json()
        assert state["merged"]["action_units"] == {}
    with keyed.stream(keyed.session, query=f"?ticket={moves}") as socket:
        assert first(socket, "hello")["role"] == "control"
        socket.send_text(json.dumps(command))
        while first(socket, "state")["merged"]["action_units"] != {"AU12": 0.5}:
            pass
    moved = keyed.client.put(f"{path}?ticket={moves}", json={"facs": "0"})
    assert moved.status_code == 200, moved.text


def test_a_socket_ends_with_its_ticket(keyed: Keyed) -> None:
    ticket = keyed.ticket("ada", keyed.session, seconds=1)
    with keyed.stream(keyed.session, query=f"?ticket={ticket}") as socket:
        first(socket, "hello")
        with pytest.raises(WebSocketDisconnect) as ended:
            first(socket, "never")
    assert (ended.value.code, ended.value.reason) == (1008, "the ticket is over")
    answer = keyed.client.get(f"/api/sessions/{keyed.session}?ticket={ticket}")
    assert answer.status_code == 401
    assert "no longer valid" in answer.json()["message"]


def test_a_ticket_bounds_who_needs_no_key_too(client: TestClient, session: str) -> None:
    answer = client.post(f"/api/sessions/{session}/tickets", json={"role": "read"})
    ticket = answer.json()["ticket"]
    assert client.get(f"/api/sessions/{session}?ticket={ticket}").status_code == 200
    assert client.get(f"/api/sessions?ticket={ticket}").status_code == 403
    assert client.get(f"/api/sessions/{session}?ticket=rst_wrong").status_code == 401


@pytest.mark.parametrize("body", [{"role": "write"}, {"seconds": 0}, {"seconds": 86_401}])
def test_a_ticket_that_cannot_be_made_is_refused(keyed: Keyed, body: dict[str, object]) -> None:
    answer = keyed.call("ada", "POST", f"/api/sessions/{keyed.session}/tickets", body)
    assert answer.status_code == 422


def test_no_log_shows_a_ticket(keyed: Keyed, caplog: pytest.LogCaptureFixture) -> None:
    server_of(keyed.client.app, keyed.settings)  # type: ignore[arg-type]
    ticket = keyed.ticket("ada", keyed.session)
    for name in ("uvicorn.error", "uvicorn.access"):
        log = logging.getLogger(name)
        with caplog.at_level(logging.DEBUG, logger=name):
            caplog.handler.addFilter(lambda _record: True)
            log.addHandler(caplog.handler)
            log.info('%s - "WebSocket %s" [accepted]', "1.2.3.4", f"/a?level=low&ticket={ticket}")
            log.removeHandler(caplog.handler)
    said = caplog.text
    assert said.count("[accepted]") >= 2
    assert ticket not in said
    assert "ticket=…" in said


def test_pages_of_other_origins_are_refused_with_a_key_and_with_a_ticket(keyed: Keyed) -> None:
    origin = {"Origin": "https://evil.example"}
    ticket = keyed.ticket("ada", keyed.session)
    assert denied(keyed.stream(keyed.session, {**origin, **keyed.headers("ada")})) == 403
    assert denied(keyed.stream(keyed.session, origin, f"?ticket={ticket}")) == 403
    preflight = {**origin, "Access-Control-Request-Method": "GET"}
    answer = keyed.client.options("/api/sessions", headers=preflight)
    assert answer.status_code == 403
    assert not [name for name in answer.headers if name.startswith("access-control")]
    own = keyed.client.get("/api/people", headers={"Origin": LOCAL, **keyed.headers("ada")})
    assert own.status_code == 200
    assert not [name for name in own.headers if name.startswith("access-control")]


@pytest.mark.parametrize("part", [Sessions, Clips, Rigs])
def test_what_somebody_sees_is_a_view_and_no_second_state(part: type) -> None:
    """A view is a shallow copy: an attribute that is set anew on one is not on the others."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(part))).body
    assert isinstance(tree, ast.ClassDef)
    # Only the service's own, which every view is of, is ever made or started.
    methods = [
        node
        for node in tree.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and node.name not in ("__init__", "start")
    ]
    assert len(methods) > 5
    rebound = [
        f"{method.name}: self.{node.attr}"
        for method in methods
        for node in ast.walk(method)
        if isinstance(node, ast.Attribute)
        and isinstance(node.ctx, ast.Store)
        and isinstance(node.value, ast.Name)
        and node.value.id == "self"
    ]
    assert rebound == []
