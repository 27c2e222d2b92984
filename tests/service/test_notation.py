"""FACS over HTTP: read, written, checked by rules, and read back from a face."""

from __future__ import annotations

import json

import pytest
from conftest import until
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from starlette.testclient import TestClient

from engine import facs_codes, parse_facs
from service.facs import written

UNITS = st.dictionaries(
    st.sampled_from([f"{side}{n}" for n in (1, 4, 12, 22, 28, 43, 51) for side in ("", "L", "R")]),
    st.floats(0.0, 1.0),
    max_size=6,
)


def read(client: TestClient, **body: object) -> dict[str, object]:
    answer = client.post("/api/facs", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def rules(client: TestClient, facs: str) -> list[tuple[str, list[str]]]:
    """Return rule and units of each warning about a FACS string."""
    return [(found["rule"], found["units"]) for found in read(client, facs=facs)["warnings"]]


def control(client: TestClient, session: str, **body: object) -> dict[str, object]:
    answer = client.patch(f"/api/sessions/{session}/controls", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def held(client: TestClient, session: str) -> dict[str, float]:
    return client.get(f"/api/sessions/{session}").json()["layers"]["puppet"]["action_units"]


def test_a_string_is_read_for_a_rig_and_written_canonically(client: TestClient) -> None:
    found = read(client, facs=" 26 + r12d+au1c+L4b + 2:0.37")
    assert found["canonical"] == "1C+2:0.37+L4B+R12D+26C"
    assert found["letters"] == "1C+2B+L4B+R12D+26C"
    assert found["scale"] == "linear"
    assert found["rig"] == client.get("/api/rigs/standard").json()["id"]
    assert found["warnings"] == []
    assert found["units"][1:4] == [
        {
            "name": name,
            "side": side,
            "intensity": intensity,
            "letter": letter,
            "title": title,
            "on_rig": True,
        }
        for name, side, intensity, letter, title in (
            ("AU2", "", 0.37, None, "Outer brow raiser"),
            ("AU4", "L", 0.4, "B", "Brow lowerer"),
            ("AU12", "R", 0.8, "D", "Lip corner puller"),
        )
    ]


def test_the_banded_scale_is_read_written_and_named(client: TestClient) -> None:
    found = read(client, facs="12A+15D+4", scale="banded")
    assert found["scale"] == "banded"
    assert found["canonical"] == "4C+12A+15D"
    assert [unit["intensity"] for unit in found["units"]] == [0.55, 0.1, 0.9]
    units = {"AU12": 0.1, "AU15": "d"}
    assert read(client, action_units=units, scale="banded")["canonical"] == "12A+15D"
    assert read(client, action_units=units)["canonical"] == "12:0.1+15D"


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(units=UNITS, scale=st.sampled_from(["linear", "banded"]))
def test_units_that_are_written_read_back_the_same(client, units, scale) -> None:
    first = read(client, action_units=units, scale=scale)
    again = read(client, facs=first["canonical"], scale=scale)
    assert (again["canonical"], again["units"]) == (first["canonical"], first["units"])
    read_back = {unit["side"] + unit["name"][2:]: unit["intensity"] for unit in again["units"]}
    assert read_back == units


def test_what_a_face_plays_is_written_to_a_thousandth() -> None:
    """Intensities of mixtures are sums and products; their noise is nobody's command."""
    units = {"AU20": 0.29000000000000004, "AU12": 0.6000000000000001, "R4": 1 / 3, "AU1": 1e-4}
    assert written(units) == "R4:0.333+12C+20:0.29"
    assert written({"AU1": 1e-4}) == "0"


def test_the_neutral_face_is_code_0(client: TestClient) -> None:
    assert read(client, facs="0") == {**read(client, action_units={}), "canonical": "0"}
    assert read(client, facs="0")["letters"] == "0"
    assert read(client, facs="0")["units"] == []


@pytest.mark.parametrize(
    ("facs", "rule", "units"),
    [
        ("51B+52C", "head_turns_one_way", ["AU51", "AU52"]),
        ("19D", "tongue_through_lips", ["AU19"]),
        ("12C+21B", "absent", ["AU21"]),
        ("M59", "absent", ["M59"]),
        ("T18B", "both_lips", ["T18"]),
        ("T12B", "no_lip", ["T12"]),
        ("L51B", "no_side", ["L51"]),
        ("46C", "one_sided", ["AU46"]),
        ("L46C+R46C", "one_side_only", ["L46", "R46"]),
        ("12C+12D", "named_once", ["AU12"]),
        ("12C+L12D", "side_over_both", ["AU12", "L12"]),
    ],
)
def test_each_rule_is_named_with_its_units(
    client: TestClient, session: str, facs: str, rule: str, units: list[str]
) -> None:
    assert rules(client, facs) == [(rule, units)]
    (said,) = [found["message"] for found in read(client, facs=facs)["warnings"]]
    assert control(client, session, facs=facs)["warnings"] == [f"{said} (rule {rule})"]


def test_what_is_absent_is_named_with_what_comes_nearest(client: TestClient, session: str) -> None:
    (warning,) = control(client, session, facs="12C+21B")["warnings"]
    assert "AU21 (Neck tightener) is absent" in warning
    assert "AU20 (Lip stretcher)" in warning
    assert held(client, session) == {"AU12": 0.6}
    (warning,) = control(client, session, action_units={"AU4": 0.2, "70": 0.5})["warnings"]
    assert "AU70 (Brows and forehead not visible) is absent" in warning
    assert "nearest" not in warning
    units = {unit["name"]: unit["on_rig"] for unit in read(client, facs="12C+21B")["units"]}
    assert units == {"AU12": True, "AU21": False}


def test_one_lip_is_held_and_read_back(client: TestClient, session: str) -> None:
    assert rules(client, "T28B") == []
    assert rules(client, "28C+T28B") == [("side_over_both", ["AU28", "T28"])]
    control(client, session, facs="28C")
    control(client, session, facs="T28B")
    assert held(client, session) == {"T28": 0.4, "B28": 0.6}
    assert client.get(f"/api/sessions/{session}").json()["merged"]["facs"] == "T28B+B28C"
    control(client, session, facs="B28B")
    assert held(client, session) == {"AU28": 0.4}
    answer = client.get("/api/rigs/standard/expressions/T28E.glb?textures=0")
    assert answer.status_code == 200
    answer = client.get("/api/rigs/standard/expressions/T23E.glb?textures=0")
    assert answer.status_code == 422


def test_what_one_lip_cannot_do_both_do(client: TestClient, session: str) -> None:
    control(client, session, facs="T23B+B23D")
    assert held(client, session) == {"AU23": 0.8}


@pytest.mark.parametrize("facs", ["99", "12C+3B", "M12", "L47", "12C+1.5", "", "0+12"])
def test_codes_that_facs_does_not_have_are_refused(
    client: TestClient, session: str, facs: str
) -> None:
    for answer in (
        client.post("/api/facs", json={"facs": facs}),
        client.patch(f"/api/sessions/{session}/controls", json={"facs": facs}),
        client.get(f"/api/rigs/standard/expressions/{facs or 'x'}.glb"),
    ):
        assert answer.status_code == 422
        assert set(answer.json()) <= {"error", "message", "known"}
    answer = client.post("/api/facs", json={"facs": "12C+3B"}).json()
    assert answer["error"] == "unknown_action_unit"
    assert answer["message"].startswith("FACS has no code 3")
    assert "AU4" in answer["known"]


def test_a_question_without_units_is_refused(client: TestClient) -> None:
    answer = client.post("/api/facs", json={"scale": "banded"})
    assert answer.status_code == 422
    assert "action_units" in answer.json()["message"]
    assert client.post("/api/facs", json={"facs": "1", "scale": "log"}).status_code == 422
    assert client.post("/api/facs", json={"facs": "1", "rig": "nobody"}).status_code == 404


def test_a_rig_answers_for_its_own_units(client: TestClient) -> None:
    own = {"AU21": {"muscles": {"platysma": 1.0}, "title": "Neck"}, "smirk": {"risorius.L": 1.0}}
    rig = client.post("/api/rigs", json={"action_units": own}).json()["id"]
    found = read(client, facs="21C", action_units={"smirk": 0.5}, rig=rig)
    assert found["warnings"] == []
    assert [(unit["title"], unit["on_rig"]) for unit in found["units"]] == [("Neck", True)]


def test_a_clash_with_what_the_layer_holds_is_named(client: TestClient, session: str) -> None:
    assert control(client, session, facs="51C")["warnings"] == []
    (warning,) = control(client, session, facs="52C")["warnings"]
    assert warning.endswith("(rule head_turns_one_way)")
    assert control(client, session, facs="1C")["warnings"] == []
    assert control(client, session, action_units={"AU51": 0})["warnings"] == []


def test_the_scale_of_a_command_is_in_its_answer(client: TestClient, session: str) -> None:
    assert control(client, session, facs="12A")["scale"] == "linear"
    answer = control(client, session, action_units={"AU12": "a"}, scale="banded")
    assert answer["scale"] == "banded"
    assert held(client, session) == {"AU12": 0.1}


def test_a_clip_says_on_which_scales_it_was_read(client: TestClient) -> None:
    timeline = [
        {"time": 0.0, "facs": "12A", "scale": "banded"},
        {"time": 0.1, "facs": "12A+21B"},
    ]
    clip = client.post("/api/clips", json={"timeline": timeline, "duration": 0.2}).json()["id"]
    until(lambda: client.get(f"/api/clips/{clip}").json()["status"] == "done")
    report = client.get(f"/api/clips/{clip}").json()["report"]
    assert report["scales"] == ["banded", "linear"]
    (warning,) = report["warnings"]
    assert warning.startswith("keyframe 1: AU21")
    assert warning.endswith("(rule absent)")


def test_the_stream_names_rules_and_reads_scales(client: TestClient, session: str) -> None:
    with client.websocket_connect(f"ws://localhost/api/sessions/{session}/stream") as socket:
        socket.send_json({"type": "controls", "facs": "12A+21B", "scale": "banded"})
        events = iter(socket.receive, None)
        texts = (json.loads(event["text"]) for event in events if event.get("text"))
        warning = next(event for event in texts if event["type"] == "warning")
        assert warning["message"].endswith("(rule absent)")
        states = (event["merged"] for event in texts if event["type"] == "state")
        assert next(merged["scale"] for merged in states if merged["facs"] == "12:0.1") == "linear"
    assert held(client, session) == {"AU12": 0.1}


def test_a_face_reads_back_as_facs(client: TestClient, session: str) -> None:
    assert client.get(f"/api/sessions/{session}").json()["merged"]["facs"] == "0"
    control(client, session, facs="26+R12D+L12B+51:0.123")
    control(client, session, facs="4D", layer="mood")
    for scale, facs in (
        ("linear", "4D+L12B+R12D+26C+51:0.123"),
        ("banded", "4:0.8+L12:0.4+R12:0.8+26:0.6+51:0.123"),
    ):
        path = f"/api/sessions/{session}?scale={scale}"
        merged = client.get(path).json()["merged"]
        assert (merged["facs"], merged["scale"]) == (facs, scale)
        terms = parse_facs(facs, scale)
        assert {term.key: term.intensity for term in terms} == merged["action_units"]
    assert client.get(f"/api/sessions/{session}?scale=log").status_code == 422


def test_an_expression_is_read_on_the_scale_it_names(client: TestClient) -> None:
    path = "/api/rigs/standard/expressions"
    tags = [
        client.get(f"{path}/{name}").headers["ETag"]
        for name in (
            "12C.glb?textures=0",
            "12:0.6.glb?textures=0",
            "12C.glb?scale=banded&textures=0",
        )
    ]
    assert tags[0] == tags[1] != tags[2]


def test_a_recipe_of_ones_own_is_read_on_the_scale_it_names(
    client: TestClient, session: str
) -> None:
    emotions = {"glee": {"recipe": "12D+6C", "scale": "banded"}}
    rig = client.post("/api/rigs", json={"emotions": emotions})
    assert rig.status_code in (200, 201), rig.text
    opened = client.post("/api/sessions", json={"rig": rig.json()["id"]}).json()["id"]
    answer = client.post(f"/api/sessions/{opened}/emotions", json={"label": "glee"}).json()
    assert answer["action_units"] == {"AU6": 0.55, "AU12": 0.9}
    assert client.delete(f"/api/sessions/{opened}").status_code == 204
    emotions = {"glee": {"recipe": "12D", "scale": "log"}}
    assert client.post("/api/rigs", json={"emotions": emotions}).status_code == 422


def test_every_code_of_facs_is_played_or_named(client: TestClient) -> None:
    units = client.get("/api/rigs/standard").json()["action_units"]
    on_rig = {unit["name"] for unit in units}
    for name in facs_codes():
        found = read(client, facs=name)
        absent = [warning for warning in found["warnings"] if warning["rule"] == "absent"]
        assert (name in on_rig) == (absent == []), name
