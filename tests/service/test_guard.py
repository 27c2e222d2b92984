"""Who is turned away: foreign hosts and origins, missing keys, large bodies, hasty clients."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import LOCAL, api_routes, settings_in
from starlette.testclient import TestClient, WebSocketDenialResponse

from service.app import create_app
from service.guard import KEY_SUBPROTOCOL, RateLimit

PATHS = [*{path.replace("{", "").replace("}", ""): None for _, path in api_routes()}]
PATHS += ["/", "/docs", "/openapi.json", "/nowhere", "/mcp", "/mcp/"]


@pytest.mark.parametrize("path", PATHS)
def test_a_foreign_host_is_answered_nowhere(client: TestClient, path: str) -> None:
    answer = client.get(path, headers={"Host": "evil.example"})
    assert answer.status_code == 421
    assert answer.json()["error"] == "unknown_host"


@pytest.mark.parametrize("path", PATHS)
def test_a_foreign_page_may_call_nothing(client: TestClient, path: str) -> None:
    for origin in ("https://evil.example", "null", "http://localhost:81", "file://"):
        answer = client.get(path, headers={"Origin": origin})
        assert answer.status_code == 403
        assert answer.json()["error"] == "forbidden_origin"


@pytest.mark.parametrize("headers", [{"Host": "evil.example"}, {"Origin": "https://evil.example"}])
def test_a_foreign_page_has_no_socket(
    client: TestClient, session: str, headers: dict[str, str]
) -> None:
    path = f"ws://localhost/api/sessions/{session}/stream"
    with pytest.raises(WebSocketDenialResponse) as denied:
        client.websocket_connect(path, headers=headers).__enter__()
    assert denied.value.status_code in (403, 421)


@pytest.mark.parametrize(
    "host",
    [
        "",
        "[",
        "localhost@evil.example",
        "localhost.evil.example",
        "localhost:1, evil.example",
        "localhost:1:2",
        "localhost/",
    ],
)
def test_a_malformed_host_is_foreign(client: TestClient, host: str) -> None:
    assert client.get("/api/health", headers={"Host": host}).status_code == 421


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1:8000", "[::1]:9000", "LOCALHOST:1"])
def test_this_machine_is_answered(client: TestClient, host: str) -> None:
    own = {"Host": host, "Origin": f"http://{host}"}
    assert client.get("/api/health", headers=own).status_code == 200


def test_a_large_body_is_refused_by_length_and_by_bytes(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, max_body_bytes=2000))
    with TestClient(app, base_url=LOCAL) as client:
        body = b'{"rig": "' + b"x" * 3000 + b'"}'
        for content in (body, iter([body[:1500], body[1500:]])):
            answer = client.post(
                "/api/sessions", content=content, headers={"Content-Type": "application/json"}
            )
            assert answer.status_code == 413
            assert answer.json()["error"] == "body_too_large"


def test_keys_are_asked_for_where_they_are_set(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, api_keys=("first", "second")))
    with TestClient(app, base_url=LOCAL) as client:
        assert client.get("/api/health").status_code == 200
        assert client.get("/").status_code == 200
        for headers in ({}, {"X-API-Key": "third"}, {"Authorization": "Bearer "}):
            answer = client.get("/api/sessions", headers=headers)
            assert answer.status_code == 401
            assert answer.json()["error"] == "unauthorized"
        for headers in ({"X-API-Key": "second"}, {"Authorization": "Bearer first"}):
            assert client.get("/api/sessions", headers=headers).status_code == 200
        path = "ws://localhost/api/sessions/nobody/stream"
        with pytest.raises(WebSocketDenialResponse) as denied:
            client.websocket_connect(path).__enter__()
        assert denied.value.status_code == 401
        offered = ["risorius.v1", f"{KEY_SUBPROTOCOL}first"]
        with pytest.raises(WebSocketDenialResponse) as denied:
            client.websocket_connect(path, subprotocols=offered).__enter__()
        assert denied.value.status_code == 404


def test_pages_that_are_allowed_may_call(tmp_path: Path) -> None:
    page = "https://faces.example"
    app = create_app(settings_in(tmp_path, allowed_origins=(page,), api_keys=("key",)))
    with TestClient(app, base_url=LOCAL) as client:
        asked = {
            "Origin": page,
            "Access-Control-Request-Method": "PUT",
            "Access-Control-Request-Headers": "x-api-key",
        }
        preflight = client.options("/api/sessions/a/controls", headers=asked)
        assert preflight.status_code == 200
        answer = client.get("/api/rigs", headers={"Origin": page, "X-API-Key": "key"})
        assert answer.headers["Access-Control-Allow-Origin"] == page


def test_a_hasty_client_waits(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, requests_per_second=2))
    with TestClient(app, base_url=LOCAL) as client:
        answers = [client.get("/api/health") for _ in range(20)]
        late = next(answer for answer in answers if answer.status_code == 429)
        assert late.headers["Retry-After"] == "1"
        assert late.json()["error"] == "too_many_requests"


def test_the_rate_is_each_client_s_own() -> None:
    rate = RateLimit(1.0)
    assert [rate.allow("a") for _ in range(3)] == [True, True, False]
    assert rate.allow("b")


def test_sessions_are_limited(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, max_sessions=1))
    with TestClient(app, base_url=LOCAL) as client:
        assert client.post("/api/sessions", json={}).status_code == 201
        answer = client.post("/api/sessions", json={})
        assert answer.status_code == 503
        assert answer.json()["error"] == "too_many_sessions"
        assert int(answer.headers["Retry-After"]) > 0


def test_clips_and_rigs_are_limited(tmp_path: Path) -> None:
    limits = {"max_queued_clips": 1, "max_clips": 1, "max_rigs": 1, "max_clip_seconds": 3}
    app = create_app(settings_in(tmp_path, max_keyframes=2, **limits))
    with TestClient(app, base_url=LOCAL) as client:
        clip = {"timeline": [{"time": 0}], "duration": 3}
        assert client.post("/api/clips", json={**clip, "duration": 4}).status_code == 422
        assert client.post("/api/clips", json={"timeline": [{"time": 0}] * 3}).status_code == 422
        assert client.post("/api/clips", json=clip).status_code == 202
        refused = client.post("/api/clips", json=clip)
        assert refused.status_code == 503
        assert refused.json()["error"] in ("queue_full", "too_many_clips")
        assert client.post("/api/rigs", json={"emotions": {"one": "1C"}}).status_code == 201
        assert client.post("/api/rigs", json={"emotions": {"two": "2C"}}).status_code == 503


def test_viewers_are_limited(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, max_viewers=1))
    with TestClient(app, base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        path = f"ws://localhost/api/sessions/{session}/stream"
        with client.websocket_connect(path):
            with pytest.raises(WebSocketDenialResponse) as denied:
                client.websocket_connect(path).__enter__()
            assert denied.value.status_code == 503
