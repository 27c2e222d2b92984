"""The one error shape, on every kind of refusal, and no 500 whatever is sent."""

from __future__ import annotations

import json
import re
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
        if answer.json()["error"] == "invalid_body":
            assert not FOREIGN.search(answer.json()["message"]), answer.text


JSON = {"Content-Type": "application/json"}
FOREIGN = re.compile(
    r"constrained|function-|literal\[|Input should|valid dictionary|Extra inputs|Field required"
    r"|JSON decode|Value error|after validation|pydantic|NoneType|Traceback",
    re.IGNORECASE,
)
"""Words of the libraries underneath, which say nothing to who sent the body."""


@pytest.mark.parametrize(
    ("path", "body", "said"),
    [
        (
            "POST /api/clips",
            {"timeline": [{"time": 0, "emotion": {"label": "joy", "intensity": 2}}]},
            "timeline.0.emotion.intensity is 2; expected a number of at most 1",
        ),
        (
            "POST /api/clips",
            {"timeline": [{"time": 0, "emotion": 5}]},
            "timeline.0.emotion is 5; expected text or an object, {…}",
        ),
        ("POST /api/clips", {"timeline": [{"emotion": "joy"}]}, "timeline.0.time is missing"),
        (
            "POST /api/sessions/ID/emotions",
            {"lable": "joy"},
            "there is no field 'lable'; did you mean 'label' or 'layer'?",
        ),
        (
            "PUT /api/sessions/ID/controls",
            {"jaw": {"pich": 3}},
            "there is no field 'pich' in jaw; did you mean 'pitch'?",
        ),
        (
            "PUT /api/sessions/ID/controls",
            {"layer": "pupet", "fade": -1},
            "fade is -1; expected a number of at least 0 (and one more thing is wrong)",
        ),
        (
            "PUT /api/sessions/ID/controls",
            {"action_units": {"AU12": "F"}},
            "action_units.AU12 is 'F'; expected a number or one of 'A', 'B', 'C', 'D', 'E'",
        ),
        (
            "PUT /api/sessions/ID/controls",
            {"facs": "6C 12D"},
            "units are joined by '+': '6C 12D' may mean '6C+12D'",
        ),
        ("POST /api/sessions", {"rig": "amaraa"}, "no rig 'amaraa'; did you mean 'amara'"),
        ("GET /api/rigs/amaraa", None, "no rig 'amaraa'; did you mean 'amara'"),
        ("GET /api/sesions", None, "nothing at that address; did you mean '/api/sessions'"),
        ("GET /api/sessions/ID/analysis?wait=ages", None, "wait is 'ages'; expected a number"),
    ],
)
def test_an_error_says_what_was_given_expected_and_to_be_done(
    client: TestClient, shared_session: str, path: str, body: object, said: str
) -> None:
    method, address = path.replace("ID", shared_session).split()
    answer = client.request(method, address, json=body)
    assert answer.status_code in (404, 422)
    assert said in answer.json()["message"]
    assert_shape(answer)


@pytest.mark.parametrize(
    ("content", "headers", "said"),
    [
        ('{"label": "joy"}', {}, "without a content type; send JSON with the header 'Content-Type"),
        ('{"label": "joy"}', {"Content-Type": "text/plain"}, "as 'text/plain'; send JSON with"),
        ('{"label": "joy",}', JSON, "the body is not JSON: "),
        ("", JSON, "the body is empty; send JSON with the header 'Content-Type: application/json'"),
        ("[1]", JSON, "the body is [1]; expected an object, {…}"),
    ],
)
def test_a_body_that_is_no_json_is_told_so(
    client: TestClient, shared_session: str, content: str, headers: dict[str, str], said: str
) -> None:
    path = f"/api/sessions/{shared_session}/emotions"
    answer = client.post(path, content=content, headers=headers)
    assert answer.status_code == 422
    assert said in answer.json()["message"]
    assert not FOREIGN.search(answer.text)


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
