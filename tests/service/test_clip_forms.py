"""Forms of a clip's file, as clients and the command line ask for them."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from test_cli import refused, run

from engine import performance_of

SMILE = {
    "timeline": [{"time": 0.0, "action_units": {"AU12": 0.8, "AU26": 0.6}, "fade": 0.1}],
    "duration": 0.4,
    "level": "low",
    "textures": False,
}


def document(data: bytes) -> dict[str, Any]:
    (size,) = struct.unpack_from("<I", data, 12)
    found: dict[str, Any] = json.loads(data[20 : 20 + size])
    return found


@pytest.mark.parametrize("form", ["basis", "arkit", "exact"])
def test_a_clip_has_the_form_that_is_asked_for(client: TestClient, form: str) -> None:
    answer = client.post("/api/clips", params={"wait": 60}, json={**SMILE, "form": form})
    assert answer.status_code == 200, answer.text
    extras = document(answer.content)["asset"]["extras"]
    report = client.get(answer.headers["Location"]).json()["report"]
    assert extras["form"] == report["form"] == form
    told = "residual_mm" if form == "arkit" else "max_error_mm"
    assert extras[told] == report[told]
    for name in ("simulation_seconds", "fit_seconds", "write_seconds"):
        assert report[name] >= 0.0


def test_a_clip_of_which_nothing_is_said(client: TestClient) -> None:
    asked = {"timeline": SMILE["timeline"], "duration": 0.2, "textures": False}
    data = client.post("/api/clips", params={"wait": 60}, json=asked).content
    found = document(data)
    assert found["extensionsRequired"] == ["KHR_mesh_quantization"]
    extras = found["asset"]["extras"]
    assert (extras["form"], extras["tolerance_mm"]) == ("basis", 0.1)
    played = performance_of(data)
    assert played.level == "medium"
    assert played.model.integrator == "verlet"
    assert played.file == {
        "form": "basis",
        "tolerance": 0.1,
        "quantize": True,
        "sparse": True,
        "textures": False,
    }


def test_numbers_are_stored_as_asked(client: TestClient) -> None:
    asked = {**SMILE, "quantize": False, "sparse": False, "tolerance": 0.5}
    found = document(client.post("/api/clips", params={"wait": 60}, json=asked).content)
    assert "extensionsUsed" not in found
    assert not any("sparse" in accessor for accessor in found["accessors"])
    assert found["asset"]["extras"]["tolerance_mm"] == 0.5


@pytest.mark.parametrize(
    ("field", "value"),
    [("form", "usdz"), ("tolerance", 0), ("tolerance", 11), ("quantize", 1), ("level", "huge")],
)
def test_what_there_is_not_is_refused(client: TestClient, field: str, value: object) -> None:
    answer = client.post("/api/clips", json={**SMILE, field: value})
    assert answer.status_code == 422
    assert field in answer.json()["message"]


def test_the_command_line_asks_for_them_too(tmp_path: Path) -> None:
    source, output = tmp_path / "smile.json", tmp_path / "smile.glb"
    source.write_text(json.dumps(SMILE))
    options = ("--form", "exact", "--tolerance", 0.2, "--no-quantize", "--level", "medium")
    result = run("clip", source, "-o", output, *options)
    assert result.exit_code == 0, result.output
    played = performance_of(output.read_bytes())
    assert played.level == "medium"
    assert played.file == {
        "form": "exact",
        "tolerance": 0.2,
        "quantize": False,
        "sparse": True,
        "textures": False,
    }
    again = tmp_path / "again.glb"
    assert run("clip", output, "-o", again).exit_code == 0
    assert again.read_bytes() == output.read_bytes()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--form", "usdz"), "--form is 'usdz'; expected one of basis, arkit, exact."),
        (("--level", "huge"), "--level is 'huge'; expected one of low, medium, high."),
        (("--tolerance", 0), "tolerance"),
    ],
)
def test_the_command_line_refuses_what_there_is_not(
    tmp_path: Path, options: tuple[Any, ...], said: str
) -> None:
    source = tmp_path / "smile.json"
    source.write_text(json.dumps(SMILE))
    result = run("clip", source, "-o", tmp_path / "smile.glb", *options)
    assert said in refused(result)


def test_a_clip_that_is_rendered_again_keeps_its_form(tmp_path: Path) -> None:
    result = run("clip", tmp_path / "a.glb", "-o", tmp_path / "b.glb", "--form", "arkit")
    assert "leave --form out" in refused(result)
