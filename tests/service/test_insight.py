"""Insight over HTTP: a live face looked into, and what is refused."""

from __future__ import annotations

import asyncio
import json
import threading
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import until
from starlette.testclient import TestClient
from typer.testing import CliRunner

import service.insight
from service.cli import app
from service.errors import Busy
from service.insight import Insight


def asleep(client: TestClient, session: str) -> bool:
    return bool(client.get(f"/api/sessions/{session}").json()["asleep"])


def test_a_live_face_says_that_15_fights_12(client: TestClient, session: str) -> None:
    controls = {"facs": "12E+15E", "fade": 0.1}
    assert client.put(f"/api/sessions/{session}/controls", json=controls).status_code == 200
    until(lambda: asleep(client, session))
    answer = client.get(f"/api/sessions/{session}/analysis")
    assert answer.status_code == 200, answer.text
    body = answer.json()
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
        assert str(await first) == "done"
        assert str(await insight.analyze(look, measured=False)) == "done"
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
