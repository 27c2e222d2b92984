"""What is not documented fails here: routes, settings, commands, and the reader of the stream."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import api_routes, settings_in
from starlette.testclient import TestClient
from typer.testing import CliRunner

from engine import builtin_rig, recipe_attributes
from engine.facs import exclusions, needs
from service.agents.tool import Tool
from service.agents.tools import TOOLS
from service.app import create_app
from service.cli import app as command_line
from service.emotion_measuring import forms
from service.emotion_page import words_markdown
from service.packed import __doc__ as packed_layout
from service.protocol import __doc__ as layout
from service.server import running
from service.settings import Settings

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def api() -> str:
    """The page about the API."""
    return (DOCS / "api.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def stream() -> str:
    """The page about the stream."""
    return (DOCS / "stream.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(("method", "path"), api_routes())
def test_every_route_is_documented(api: str, method: str, path: str) -> None:
    assert f"| `{method} {path}` |" in api


def test_every_documented_route_exists(api: str) -> None:
    documented = set(re.findall(r"^\| `(GET|PUT|POST|PATCH|DELETE) (\S+)` \|", api, re.M))
    assert documented == set(api_routes())


@pytest.mark.parametrize("name", Settings.model_fields)
def test_every_setting_is_documented(api: str, name: str) -> None:
    field = Settings.model_fields[name]
    assert field.description
    meaning = re.escape(field.description)
    found = re.search(rf"^\| `RISORIUS_{name.upper()}` \| (.+) \| {meaning} \|$", api, re.M)
    assert found
    if isinstance(field.default, int | float | str) and field.default != "":
        assert found[1].lower() == str(field.default).lower()


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
def test_every_tool_of_agents_is_documented_with_what_it_takes(api: str, tool: Tool) -> None:
    (row,) = re.findall(rf"^\| `{tool.name}` \| (.+) \| .+ \|$", api, re.M)
    assert {*re.findall(r"`(\w+)`", row)} >= {*tool.asks.model_fields}


def test_every_attribute_of_a_recipe_is_documented_as_it_is(api: str) -> None:
    rows = re.findall(
        r"^\| `(\w+)` \| (.+) \| (sd|years|share|times|name|number) \| (.+) \| (.+) \|$", api, re.M
    )
    table = {name: (values, default) for name, values, _, default, _ in rows}
    meanings = {name: meaning for name, *_, meaning in rows}
    assert table.pop("sample")
    expected = {}
    for name, attribute in recipe_attributes().items():
        values, default = "0 to 4294967295", attribute["default"]
        if "range" in attribute:
            values = "{:g} to {:g}".format(*attribute["range"])
        elif "choices" in attribute:
            values = ", ".join(f"`{choice}`" for choice in attribute["choices"])
        expected[name] = (values, f"`{default}`" if isinstance(default, str) else f"{default:g}")
        for word, number in attribute.get("words", {}).items():
            assert f"`{word}` {number:g}" in meanings[name]
    assert table == expected
    assert list(table) == list(expected)


def test_every_command_of_a_group_is_documented_and_has_help(api: str) -> None:
    for group in command_line.registered_groups:
        assert group.typer_instance is not None
        for command in group.typer_instance.registered_commands:
            name = command.name or command.callback.__name__  # type: ignore[union-attr]
            assert f"| `risorius {group.name} {name}" in api
            answer = CliRunner().invoke(command_line, [str(group.name), name, "--help"])
            assert answer.exit_code == 0
            assert "Usage" in answer.output


def test_every_command_is_documented_and_has_help(api: str) -> None:
    for command in command_line.registered_commands:
        name = command.callback.__name__  # type: ignore[union-attr]
        assert f"| `risorius {name}" in api
        answer = CliRunner().invoke(command_line, [name, "--help"])
        assert answer.exit_code == 0
        assert "Usage" in answer.output


def test_both_descriptions_of_the_frame_agree(stream: str) -> None:
    plain, packed = (
        re.findall(r"^\| ([\w ]+) \| ([^|]+) \|", text or "", re.M)[1:]
        for text in (layout, packed_layout)
    )
    rows = plain + packed
    assert (len(plain), len(packed)) == (13, 4)
    for byte, kind in rows:
        typographic = kind.replace(" x ", " \u00d7 ").strip()
        assert f"| {byte} | {typographic} |" in stream


def test_the_reader_of_the_stream_reads_a_smile(stream: str, tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", stream, re.S)
    assert len(blocks) == 1
    assert len(blocks[0].splitlines()) <= 50
    program = tmp_path / "reader.py"
    program.write_text(blocks[0])
    settings = settings_in(tmp_path)
    with running(create_app(settings), settings) as url:
        done = subprocess.run(
            [sys.executable, str(program), url],
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0] == f"{len(builtin_rig('standard').head.points)} vertices"
    assert float(lines[-1].split()[-2]) > 4.0


def test_the_page_of_action_units_is_what_the_command_prints() -> None:
    printed = CliRunner().invoke(command_line, ["units"])
    assert printed.exit_code == 0
    page = (DOCS / "action-units.md").read_text(encoding="utf-8")
    assert page == printed.stdout, "risorius units > docs/action-units.md"


def test_the_page_of_emotions_has_every_word_and_every_face() -> None:
    page = (DOCS / "emotions.md").read_text(encoding="utf-8")
    words = words_markdown()
    assert page.startswith(words), "risorius emotions > docs/emotions.md"
    measured = re.findall(r"^\| (.+?) \| `(\S+)` \| \d+ of \d+ \|", page[len(words) :], re.M)
    assert measured == [(form.face, form.facs) for form in forms()]


def test_the_page_of_emotions_shows_no_face_that_breaks() -> None:
    page = (DOCS / "emotions.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"of \d+ \| .+ \| ([\d.]+) \| (.+) \| (.+) \| (.+) \| ([\d.]+) \|$", page, re.M
    )
    assert len(rows) == len(list(forms()))
    for least, inverted, folds, through, speed in rows:
        assert (inverted, folds, through) == ("0", "0", "0")
        assert float(least) > 0.0
        assert float(speed) < 5.0


def sent_in(page: str, path: str) -> list[str]:
    """Return the bodies that a page's examples post to `path`."""
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.findall(rf"curl -X POST localhost:8000{path} .*?-d '(.*?)'", text, re.S)


def test_the_examples_about_tissue_make_rigs(client: TestClient) -> None:
    examples = sent_in("tissue.md", "/api/rigs")
    examples += re.findall(r"```json\n(.*?)```", (DOCS / "tissue.md").read_text("utf-8"), re.S)
    assert len(examples) == 4
    for example in examples:
        answer = client.post("/api/rigs", json=json.loads(example))
        assert answer.status_code in (200, 201), (example, answer.text)


def test_the_example_of_the_inverse_is_answered(client: TestClient) -> None:
    (example,) = sent_in("api.md", "/api/rigs/standard/inverse")
    answer = client.post("/api/rigs/standard/inverse", json=json.loads(example))
    for _ in range(9):  # on a busy machine the rig's response takes more than the minute waited for
        if answer.status_code != 503:
            break
        answer = client.post("/api/rigs/standard/inverse", json=json.loads(example))
    assert answer.status_code == 200, answer.text
    api = (DOCS / "api.md").read_text(encoding="utf-8")
    shown = re.search(r'```json\n(\{"rig": "…", "activations".*?)```', api, re.S)
    assert shown is not None
    assert set(json.loads(shown[1])) == set(answer.json())


def test_the_example_of_an_analysis_has_the_fields_of_one(client: TestClient, session: str) -> None:
    api = (DOCS / "api.md").read_text(encoding="utf-8")
    shown = re.search(r'```json\n(\{"rig": "…", "tick".*?)```', api, re.S)
    assert shown is not None
    example = json.loads(shown[1])
    real = client.get(f"/api/sessions/{session}/analysis?measured=0").json()
    assert set(example) == {*real, "measured"}
    assert set(example["muscles"][0]) == set(real["muscles"][0])
    assert set(example["energy"]) == set(real["energy"])
    assert set(example["energy"]["terms"]) <= set(real["energy"]["terms"])


def test_the_example_of_facs_is_answered_as_it_is_shown(client: TestClient, api: str) -> None:
    (example,) = sent_in("api.md", "/api/facs")
    answer = client.post("/api/facs", json=json.loads(example)).json()
    shown = re.search(r'```json\n(\{"canonical".*?)```', api, re.S)
    assert shown is not None
    assert {**answer, "rig": "…"} == json.loads(shown[1])


def test_every_rule_of_facs_is_documented_with_its_codes(api: str) -> None:
    for rule in exclusions():
        pairs = ", ".join(" and ".join(n.removeprefix("AU") for n in pair) for pair in rule.pairs)
        assert f"| `{rule.rule}` | {pairs} |" in api
    for need in needs():
        others = " or ".join(name.removeprefix("AU") for name in need.any_of)
        assert f"| `{need.rule}` | {need.unit.removeprefix('AU')} without {others} |" in api


def test_every_picture_is_shown_and_all_of_them_are_light() -> None:
    pictures = sorted(DOCS.glob("*.jpg"))
    pages = [*DOCS.glob("*.md"), DOCS.parent / "README.md"]
    words = "".join(page.read_text(encoding="utf-8") for page in pages)
    assert [picture.name for picture in pictures if picture.name not in words] == []
    made = (DOCS.parent / "Makefile").read_text(encoding="utf-8")
    assert [picture.stem for picture in pictures if picture.stem not in made] == []
    assert sum(picture.stat().st_size for picture in pictures) < 3_000_000
