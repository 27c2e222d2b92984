"""README's examples work as pasted, and its tables say what is measured."""

from __future__ import annotations

import re
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
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


def shell(script: str, folder: Path) -> str:
    """Run `script` as a person would, and return what it prints."""
    bin_folder = Path(sys.executable).parent
    done = subprocess.run(
        ["bash", "-euc", script.replace(".venv/bin", str(bin_folder))],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_shell_examples_drive_a_face(url: str, tmp_path: Path) -> None:
    examples = [block for block in blocks("sh") if "curl" in block]
    assert len(examples) == 3
    script = "\n".join(examples).replace("localhost:8000", url.removeprefix("http://"))
    said = shell(script, tmp_path)
    assert '"recipe"' in said
    assert (tmp_path / "face.glb").read_bytes()[:4] == b"glTF"


def test_the_batch_example_renders_a_clip(tmp_path: Path) -> None:
    (example,) = [block for block in blocks("sh") if "risorius clip" in block]
    shell(example, tmp_path)
    assert (tmp_path / "clip.glb").read_bytes()[:4] == b"glTF"


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
