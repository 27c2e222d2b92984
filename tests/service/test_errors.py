"""The one error shape, on every kind of refusal, and no 500 whatever is sent."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import LOCAL, api_routes, settings_in
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from starlette.testclient import TestClient

from service.app import create_app

ROUTES = api_routes()
WITH_BODY = [
    (method, path)
    for method, path in ROUTES
    if method in {"POST", "PUT", "PATCH"} and path != "/api/clips"
]


def assert_shape(answer: object) -> None:
    body = answer.json()  # type: ignore[attr-defined]
    assert {"error", "message"} <= set(body) <= {"error", "message", "known"}
    assert isinstance(body["error"], str)
    assert body["message"]
    json.dumps(body, allow_nan=False)


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nowhere", 404),
        ("GET", "/api/nowhere", 404),
        ("DELETE", "/api/rigs", 405),
        ("GET", "/api/sessions/a/controls", 405),
        ("POST", "/api/health", 405),
        ("GET", "/api/sessions/nobody", 404),
        ("PUT", "/api/sessions/a/controls", 422),
        ("POST", "/api/sessions", 422),
    ],
)
def test_errors_have_one_shape(client: TestClient, method: str, path: str, status: int) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    assert_shape(answer)
    if status == 405:
        assert "OPTIONS" not in answer.headers["Allow"]


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/api/rigs", "GET, POST"),
        ("/api/sessions/a/controls", "PATCH, PUT"),
        ("/api/clips/a", "DELETE, GET"),
        ("/api/clips/a.glb", "GET"),
    ],
)
def test_a_wrong_method_is_told_every_right_one(
    client: TestClient, path: str, allowed: str
) -> None:
    answer = client.options(path)
    assert answer.status_code == 405
    assert set(allowed.split(", ")) <= set(answer.headers["Allow"].split(", "))


@pytest.mark.parametrize(("method", "path"), ROUTES)
def test_strange_names_in_paths_are_not_failures(
    client: TestClient, method: str, path: str
) -> None:
    if "{" not in path:
        return
    for name in ("%00", "%ff", "%ed%a0%80", "..%2f..%2fetc", "a" * 3000, "%F0%9F%98%80"):
        prefix, _, rest = path.partition("{")
        answer = client.request(method, prefix + name + rest.partition("}")[2], json={})
        assert answer.status_code in (400, 404, 405, 422)
        assert_shape(answer)


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)
KEYS = (
    "action_units facs scale muscles jaw gaze head fade layer weight ttl label intensity scores "
    "rig model base tissue emotions hold stiffness damping AU12 zygomatic_major.L pitch radius "
    "targets M1_5.L weights palsy side grade relaxed tissue_age region_laxity skin_thickness cheek"
).split()
bodies = anything | st.dictionaries(st.sampled_from(KEYS), anything, max_size=4)


@given(route=st.sampled_from(WITH_BODY), body=bodies)
@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_no_body_is_a_failure(
    client: TestClient, shared_session: str, route: tuple[str, str], body: object
) -> None:
    method, path = route
    filled = path.format(session_id=shared_session, muscle="zygomatic_major.L", rig="standard")
    answer = client.request(
        method,
        filled,
        content=json.dumps(body).encode("utf-8", "surrogatepass"),
        headers={"Content-Type": "application/json"},
    )
    assert answer.status_code < 500 or answer.status_code == 503, answer.text
    if answer.status_code >= 400:
        assert_shape(answer)


@pytest.fixture(scope="module")
def shared_session(client: TestClient) -> str:
    """One session for every example."""
    return str(client.post("/api/sessions", json={}).json()["id"])


def test_every_answer_is_documented(client: TestClient) -> None:
    described = client.get("/openapi.json").json()["paths"]
    for method, path in ROUTES:
        answers = described[path][method.lower()]["responses"]
        assert {"404", "422", "413", "421"} <= set(answers), path
        for status in ("404", "422"):
            schema = answers[status]["content"]["application/json"]["schema"]
            assert schema["required"] == ["error", "message"], path


def test_without_a_viewer_the_page_says_how_to_build_it(tmp_path: Path) -> None:
    app = create_app(settings_in(tmp_path, viewer_dir=tmp_path / "none"))
    with TestClient(app, base_url=LOCAL) as client:
        answer = client.get("/")
        assert answer.status_code == 200
        assert "not built" in answer.text
        assert "npm" in answer.text


def test_a_built_viewer_is_served(tmp_path: Path) -> None:
    folder = tmp_path / "viewer"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<title>Risorius</title>")
    (folder / "assets" / "main-123.js").write_text("1")
    app = create_app(settings_in(tmp_path, viewer_dir=folder))
    with TestClient(app, base_url=LOCAL) as client:
        assert "Risorius" in client.get("/").text
        assert client.get("/?session=abc&bare=1").status_code == 200
        assert "immutable" in client.get("/assets/main-123.js").headers["Cache-Control"]
        for path in ("/assets/none.js", "/../settings.py", "/api/nowhere"):
            answer = client.get(path)
            assert answer.status_code == 404
            assert_shape(answer)
        answer = client.request("DELETE", "/api/rigs")
        assert answer.status_code == 405
