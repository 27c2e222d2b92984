"""README's examples work as pasted, and its tables say what is measured."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.error import HTTPError

import pytest

from service.app import create_app
from service.server import running
from service.settings import Settings

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    """Return README's code blocks in `language`."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.S)


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A ready service on a free port."""
    folder = tmp_path_factory.mktemp("readme")
    settings = Settings(data_dir=folder / "data", cache_dir=folder / "cache")
    with running(create_app(settings), settings) as address:
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline:
            try:
                urllib.request.urlopen(f"{address}/api/ready").close()
                break
            except HTTPError as waiting:
                waiting.close()
                time.sleep(0.1)
        yield address


def shell(script: str, folder: Path, variables: Mapping[str, str]) -> str:
    """Run `script` as a person would, and return what it prints."""
    bin_folder = Path(sys.executable).parent
    done = subprocess.run(
        ["bash", "-euc", script.replace(".venv/bin", str(bin_folder))],
        cwd=folder,
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def first_lines(who: str) -> str:
    """Return the five lines that README has for a group of people."""
    (found,) = re.findall(rf"^\*\*{who}[^*\n]*\*\*.*?```sh\n(.*?)```", README, re.S | re.M)
    assert len(found.splitlines()) <= 5
    return str(found)


def pasted(script: str, url: str, folder: Path) -> str:
    """Run a script against the service at `url`, with a browser that saves the page it is shown."""
    browser = {"BROWSER": "curl -s -o page.html %s"}
    return shell(script.replace("localhost:8000", url.removeprefix("http://")), folder, browser)


def test_who_puppeteers_sees_a_face_and_takes_it_home(url: str, tmp_path: Path) -> None:
    said = pasted(first_lines("You puppeteer in the browser"), url, tmp_path)
    assert answers(said)[0]["warnings"] == []
    assert (tmp_path / "page.html").stat().st_size > 0
    assert (tmp_path / "performance.glb").read_bytes()[:4] == b"glTF"


def test_a_chat_agent_posts_what_it_feels(url: str, tmp_path: Path) -> None:
    said = pasted(first_lines("Your chat agent"), url, tmp_path)
    (address,) = re.findall(r"watch it: (\S+)", said)
    assert [played["found"] for played in answers(said)] == ["label", "scores"]
    session = f"{url}/api/sessions/{address.rpartition('=')[2]}"
    with urllib.request.urlopen(session, timeout=30) as answer:
        (writer,) = json.load(answer)["layers"]["emotion"]["writers"]
    assert [part["recipe"] for part in writer["emotion"]["parts"]] == ["surprise", "happiness"]
    assert writer["expires_in"] > 10


def test_a_batch_job_gets_its_clip(url: str, tmp_path: Path) -> None:
    pasted(first_lines("Your batch job"), url, tmp_path)
    data = (tmp_path / "clip.glb").read_bytes()
    assert data[:4] == b"glTF"
    assert json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])["animations"]


def test_a_person_is_made_by_a_recipe(url: str, tmp_path: Path) -> None:
    (example,) = [block for block in blocks("sh") if "/api/rigs" in block]
    said = pasted(example, url, tmp_path)
    assert answers(said)[0]["recipe"]["age"] == 60


def answers(said: str) -> list[dict[str, Any]]:
    """Return the JSON objects in what a script printed, one after another."""
    found, start = [], said.find("{")
    while start >= 0:
        value, end = json.JSONDecoder().raw_decode(said, start)
        found.append(value)
        start = said.find("{", end)
    return found


def test_the_python_example_renders_a_smile(tmp_path: Path) -> None:
    (example,) = blocks("python")
    assert len([line for line in example.splitlines() if line]) <= 5
    program = tmp_path / "example.py"
    program.write_text(example)
    subprocess.run([sys.executable, "-X", "dev", program.name], cwd=tmp_path, check=True)
    assert (tmp_path / "smile.glb").read_bytes()[:4] == b"glTF"


def test_the_table_is_what_the_calibration_fits() -> None:
    from engine import builtin_rig, measure_units

    rows = re.findall(r"(AU\d+) \| ([a-z ]+) \| [^|]+ \| (-?[\d.]+)", README)
    told = {(unit, what.strip()): float(value) for unit, what, value in rows}
    for measured in measure_units(builtin_rig("standard")):
        mark = measured.landmark
        if int(mark.unit.removeprefix("AU")) > 50:
            continue  # Head and gaze go as far as their pose says.
        assert told[mark.unit, mark.what] == pytest.approx(measured.value, abs=0.1)


def test_every_page_that_readme_points_to_exists() -> None:
    for target in re.findall(r"\]\((?!http)([^)#]+)\)", README):
        assert (ROOT / target).exists(), target


def test_every_make_target_that_is_named_exists() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in ("README.md", "CONTRIBUTING.md"):
        text = (ROOT / page).read_text(encoding="utf-8")
        for target in re.findall(r"`?make ([a-z]+)", text):
            if target in ("it", "index"):
                continue
            assert re.search(rf"^{target}:", makefile, re.M), f"{page}: make {target}"
