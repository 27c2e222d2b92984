"""Insight over HTTP and from the command line: analyses, the inverse, and what is refused."""

from __future__ import annotations

import asyncio
import json
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import until
from starlette.testclient import TestClient
from typer.testing import CliRunner

import service.insight
from engine import Cancelled
from service.cli import app
from service.errors import Busy
from service.insight import Insight


def asleep(client: TestClient, session: str) -> bool:
    return bool(client.get(f"/api/sessions/{session}").json()["asleep"])


def measured(client: TestClient, session: str) -> dict[str, Any]:
    """Return the analysis of a face once its rig's units are known."""
    answers: list[dict[str, Any]] = []

    def done() -> bool:
        answer = client.get(f"/api/sessions/{session}/analysis?wait=60")
        assert answer.status_code == 200, answer.text
        answers.append(answer.json())
        return "measuring" not in answers[-1]

    until(done, seconds=600)
    return answers[-1]


def test_a_live_face_says_that_15_fights_12(client: TestClient, session: str) -> None:
    controls = {"facs": "12E+15E", "fade": 0.1}
    assert client.put(f"/api/sessions/{session}/controls", json=controls).status_code == 200
    until(lambda: asleep(client, session))
    body = measured(client, session)
    units = {u["unit"]: u for u in body["measured"]["action_units"]}
    assert units["AU12"]["requested"] == units["AU15"]["requested"] == 1.0
    assert units["AU15"]["measured"] < 0.75
    assert body["measured"]["fights"][0]["units"] == ["AU15", "AU12"]
    muscles = {m["name"]: m for m in body["muscles"]}
    assert muscles["zygomatic_major.L"]["force_mN"] > 100.0
    assert muscles["zygomatic_major.L"]["contraction_mm"] > 1.0
    assert len(muscles["levator_palpebrae.L"]["turn_degrees"]) == 2
    assert body["layers"]["epidermis"]["tension"]["max"] > 0.05
    energies = sum(region["energy"] for region in body["regions"].values())
    assert energies == pytest.approx(body["energy"]["total"], rel=1e-3)


def test_an_analysis_without_measured_units_is_quick_and_shorter(
    client: TestClient, session: str
) -> None:
    body = client.get(f"/api/sessions/{session}/analysis?measured=0").json()
    assert "measured" not in body
    assert body["energy"]["total"] == pytest.approx(0.0, abs=0.01)


def test_a_rig_whose_units_are_not_known_is_answered_at_once(
    client: TestClient, session: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, gate = threading.Event(), threading.Event()

    def slow(_rig: object, _model: object, *, progress: Any, **_: Any) -> None:
        progress(0.25)
        begun.set()
        gate.wait(60.0)
        progress(0.75)
        raise Cancelled("enough of this")

    edit = client.patch(f"/api/sessions/{session}/tissue", json={"fat_pressure": 1.23})
    assert edit.status_code == 200, edit.text
    monkeypatch.setattr(service.insight, "unit_basis", slow)
    try:
        assert client.get(f"/api/sessions/{session}/analysis?wait=0").json()["measured"] is None
        assert begun.wait(60.0)
        answer = client.get(f"/api/sessions/{session}/analysis?wait=0")
    finally:
        gate.set()
    body = answer.json()
    assert answer.status_code == 200, answer.text
    assert answer.headers["Retry-After"]
    assert body["measured"] is None
    assert body["measuring"]["progress"] == 0.25
    assert "ask again" in body["measuring"]["message"]
    assert body["muscles"]
    assert body["energy"]["terms"]


def test_a_unit_that_moves_no_tissue_is_measured_as_null(client: TestClient, session: str) -> None:
    assert client.put(f"/api/sessions/{session}/controls", json={"facs": "61E"}).status_code == 200
    units = measured(client, session)["measured"]["action_units"]
    assert units == [{"unit": "AU61", "side": "", "requested": 1.0, "measured": None}]


def test_a_session_that_is_not_there_cannot_be_looked_into(client: TestClient) -> None:
    answer = client.get(f"/api/sessions/{'0' * 32}/analysis")
    assert answer.status_code == 404
    assert answer.json()["error"] == "unknown_session"


def test_more_than_the_queue_holds_is_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    gate = threading.Event()

    def slow(*_: Any, **__: Any) -> str:
        gate.wait(5.0)
        return "done"

    monkeypatch.setattr(service.insight, "analyze", slow)
    look: Any = SimpleNamespace(
        snapshot=SimpleNamespace(assembly=None), report={"merged": {"action_units": {}}}
    )

    async def ask() -> None:
        insight = Insight(queue_limit=1)
        first = asyncio.create_task(insight.analyze(look, measured=False))
        await asyncio.sleep(0.05)
        with pytest.raises(Busy, match="under way"):
            await insight.analyze(look, measured=False)
        gate.set()
        assert str((await first).analysis) == "done"
        assert str((await insight.analyze(look, measured=False)).analysis) == "done"
        insight.close()

    asyncio.run(ask())


def test_the_command_line_prints_a_table_or_json() -> None:
    table = CliRunner().invoke(app, ["analyze", "--facs", "12E+15E"])
    assert table.exit_code == 0, table.output
    assert "AU15 fights AU12" in table.output
    assert "| zygomatic_major.L |" in table.output
    data = CliRunner().invoke(app, ["analyze", "--facs", "12C", "--json"])
    assert json.loads(data.stdout)["measured"]["residual"] < 0.1


@pytest.mark.parametrize(
    "arguments", [["--facs", "12Q"], ["--facs", "99"], ["--facs", "12", "--rig", "x"]]
)
def test_the_command_line_refuses_in_one_sentence(arguments: tuple[str, ...]) -> None:
    result = CliRunner().invoke(app, ["analyze", *arguments])
    assert result.exit_code == 2
    assert "cannot be analysed" in " ".join(result.output.split())


def inverse(client: TestClient, body: dict[str, Any]) -> Any:
    """Return the answer to targets once the standard rig's response is known."""
    answers: list[Any] = []

    def done() -> bool:
        answers.append(client.post("/api/rigs/standard/inverse", json=body))
        return answers[-1].status_code != 503

    until(done, seconds=600)
    return answers[-1]


def test_the_inverse_answers_what_a_session_can_play(client: TestClient, session: str) -> None:
    targets = {"M1_5.L": [3.0, 6.0, -3.0], "48": [None, 6.0, None]}
    answer = inverse(client, {"targets": targets})
    assert answer.status_code == 200, answer.text
    body = answer.json()
    assert body["rms_mm"] < 1.0
    assert body["landmarks"][1]["target"] == [None, 6.0, None]
    controls = {"muscles": body["activations"], "jaw": body["jaw"]}
    assert client.put(f"/api/sessions/{session}/controls", json=controls).status_code == 200


def test_the_first_inverse_of_a_rig_says_how_far_it_is(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate, begun = threading.Event(), threading.Event()

    def slow(_rig: object, *, progress: Any, **_: Any) -> None:
        progress(0.25)
        begun.set()
        gate.wait(60.0)
        raise Cancelled("enough of this")

    made = client.post("/api/rigs", json={"tissue": {"fat_pressure": 1.17}})
    address = f"/api/rigs/{made.json()['id']}/inverse?wait=0"
    body = {"targets": {"M1_5.L": [3.0, 6.0, -3.0]}}
    with monkeypatch.context() as patched:
        patched.setattr(service.insight, "response_of", slow)
        try:
            first = client.post(address, json=body, headers={"Idempotency-Key": "inverse"})
            assert begun.wait(60.0)
            second = client.post(address, json=body)
            wrong = client.post(address, json={"targets": {"M1_55.L": [0, 0, 0]}})
        finally:
            gate.set()
    assert first.status_code == second.status_code == 503
    assert second.json()["error"] == "rig_being_measured"
    assert "25% of it is done; ask again" in second.json()["message"]
    assert second.headers["Retry-After"]
    assert wrong.status_code == 422

    until(lambda: client.post(address, json=body).status_code == 200, seconds=600)
    again = client.post(address, json=body, headers={"Idempotency-Key": "inverse"})
    assert again.status_code == 200, again.text


def test_the_inverse_may_search_units(client: TestClient) -> None:
    body = {"targets": {"48": [-4.0, 8.0, -4.0]}, "action_units": ["R12", "AU6"], "jaw": False}
    answer = inverse(client, body)
    assert answer.status_code == 200, answer.text
    assert answer.json()["action_units"]["R12"] > 0.5


@pytest.mark.parametrize(
    ("body", "error"),
    [
        ({"targets": {"M1_55.L": [0, 0, 0]}}, "unknown_landmark"),
        ({"targets": {}}, "invalid_body"),
        ({}, "invalid_body"),
        ({"targets": {"prn": [0, 0]}}, "invalid_body"),
        ({"targets": {"prn": ["far", 0, 0]}}, "invalid_body"),
        ({"targets": {"prn": [0, 900, 0]}}, "invalid_value"),
        ({"targets": {"prn": [0, 1, 0]}, "muscles": ["biceps"]}, "unknown_muscle"),
        ({"targets": {"prn": [0, 1, 0]}, "action_units": ["AU99"]}, "unknown_action_unit"),
        ({"targets": {"prn": [0, 1, 0]}, "weights": {"ls": 1}}, "unknown_target"),
        ({"targets": {"prn": [0, 1, 0]}, "iterations": 1000}, "invalid_body"),
        ({"targets": {"prn": [0, 1, 0]}, "speed": 1}, "invalid_body"),
    ],
)
def test_an_inverse_that_cannot_be_searched_is_refused(
    client: TestClient, body: dict[str, object], error: str
) -> None:
    answer = client.post("/api/rigs/standard/inverse", json=body)
    assert answer.status_code == 422, answer.text
    assert answer.json()["error"] == error
    if error == "unknown_landmark":
        assert "did you mean" in answer.json()["message"]
        assert "M1_5.L" in answer.json()["known"]


def test_the_inverse_of_a_rig_that_is_not_there(client: TestClient) -> None:
    answer = client.post("/api/rigs/nobody/inverse", json={"targets": {"prn": [0, 1, 0]}})
    assert answer.status_code == 404


def test_the_command_line_inverts_a_file(tmp_path: Path) -> None:
    path = tmp_path / "targets.json"
    path.write_text('{"targets": {"M1_5.L": [3.0, 6.0, -3.0]}, "muscles": ["zygomatic_major"]}')
    table = CliRunner().invoke(app, ["inverse", str(path)])
    assert table.exit_code == 0, table.output
    assert "| zygomatic_major.L |" in table.output
    data = json.loads(CliRunner().invoke(app, ["inverse", str(path), "--json"]).stdout)
    assert data["landmarks"][0]["name"] == "M1_5.L"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"targets": {"M1_55.L": [0, 0, 0]}}', "did you mean"),
        ('{"targets": {}}', "holds no targets"),
        ("[", "not a JSON file"),
        (None, "cannot be read"),
    ],
)
def test_a_file_without_targets_is_refused(tmp_path: Path, text: str | None, said: str) -> None:
    path = tmp_path / "targets.json"
    if text is not None:
        path.write_text(text)
    result = CliRunner().invoke(app, ["inverse", str(path)])
    assert result.exit_code == 2
    assert said in " ".join(result.output.split())
