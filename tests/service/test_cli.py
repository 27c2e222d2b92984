"""The command line: 0, or 2 and one clear sentence."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from service.cli import app

TIMELINE = {
    "timeline": [{"time": 0.0, "facs": "6C+12D", "fade": 0.1}],
    "duration": 0.2,
    "fps": 10,
}


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(result: Result) -> str:
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    return " ".join(result.output.split())


@pytest.fixture
def timeline(tmp_path: Path) -> Path:
    """A short timeline file."""
    path = tmp_path / "smile.json"
    path.write_text(json.dumps(TIMELINE))
    return path


def test_a_timeline_is_rendered(timeline: Path, tmp_path: Path) -> None:
    output = tmp_path / "smile.glb"
    result = run("clip", timeline, "-o", output, "--fps", 20)
    assert result.exit_code == 0, result.output
    assert "5 frames" in result.output
    assert output.read_bytes()[:4] == b"glTF"


@pytest.mark.parametrize(
    "command",
    ["measure", "measure --flesh", "analyze --facs 12", "emotions", "units", "separability"],
)
def test_a_rig_that_is_not_there_is_refused(command: str) -> None:
    assert "no rig named 'nobody'" in refused(run(*command.split(), "--rig", "nobody"))


def test_ground_truth_is_written_beside_a_clip(track: Path, tmp_path: Path) -> None:
    before = track.read_text()
    output = tmp_path / "laugh.glb"
    result = run("clip", track, "-o", output, "--no-textures", "--fps", 10, "--csv")
    assert result.exit_code == 0, result.output
    assert track.read_text() == before
    header, *rows = (tmp_path / "laugh.truth.csv").read_text().splitlines()
    assert len(rows) == 2
    assert {"time", "AU12", "zygomatic_major.L", "jaw_pitch", "x_67"} <= set(header.split(","))


def test_a_timeline_s_level_of_detail_counts(timeline: Path, tmp_path: Path) -> None:
    low, high = tmp_path / "low.glb", tmp_path / "high.glb"
    assert run("clip", timeline, "-o", high, "--no-textures").exit_code == 0
    timeline.write_text(json.dumps({**TIMELINE, "level": "low"}))
    assert run("clip", timeline, "-o", low, "--no-textures").exit_code == 0
    assert low.stat().st_size < high.stat().st_size


def test_a_clip_embeds_the_maps_or_leaves_them_out(timeline: Path, tmp_path: Path) -> None:
    full, bare = tmp_path / "full.glb", tmp_path / "bare.glb"
    assert run("clip", timeline, "-o", full, "--fps", 2).exit_code == 0
    assert run("clip", timeline, "-o", bare, "--fps", 2, "--no-textures").exit_code == 0
    assert b'"albedo"' in full.read_bytes()
    assert b'"albedo"' not in bare.read_bytes()


@pytest.mark.parametrize(
    ("content", "options", "said"),
    [
        (None, (), "cannot be read"),
        ("{", (), "not a JSON file"),
        ("[]", (), "not a timeline"),
        ('{"timeline": [{"time": NaN}]}', (), "not a timeline"),
        ('{"timeline": [{"time": 0, "facs": "odd"}]}', (), "cannot read"),
        (json.dumps(TIMELINE), ("--rig", "nobody"), "no rig"),
    ],
)
def test_a_file_that_cannot_be_rendered_is_refused(
    tmp_path: Path, content: str | None, options: tuple[str, ...], said: str
) -> None:
    source = tmp_path / "in.json"
    if content is not None:
        source.write_text(content)
    result = run("clip", source, "-o", tmp_path / "out.glb", *options)
    assert said in refused(result)
    assert not (tmp_path / "out.glb").exists()


@pytest.fixture
def track(tmp_path: Path) -> Path:
    """A tracker's short file."""
    path = tmp_path / "laugh.csv"
    rows = [f"{i},{i / 30:.3f},0.98,1,{i},0.5" for i in range(4)]
    path.write_text("\n".join(["frame, timestamp, confidence, success, AU12_r, [/odd]", *rows]))
    return path


def test_a_tracker_s_file_is_rendered_and_reported(track: Path, tmp_path: Path) -> None:
    output = tmp_path / "laugh.glb"
    result = run("clip", track, "-o", output, "--no-textures", "--fps", 10, "--gain", 2)
    assert result.exit_code == 0, result.output
    assert output.read_bytes()[:4] == b"glTF"
    said = " ".join(result.output.split())
    assert "OpenFace 2: 6 columns" in said
    assert "4, of which 4 count" in said
    assert "2 frames, 0.133333 s" in said
    result = run("clip", track, "-o", output, "--no-textures", "--fps", 10, "--json")
    report = json.loads(result.stdout)
    assert report["units"]["AU12"]["peak"] == 0.6
    assert report["ignored"] == {"not needed": ["[/odd]"]}


def test_a_table_is_played_by_a_map_and_without_doubtful_rows(tmp_path: Path) -> None:
    path, output = tmp_path / "face3.csv", tmp_path / "face3.glb"
    rows = [f"{i},{i / 30:.3f},{0.9 - 0.2 * i},0.5,0.1" for i in range(4)]
    path.write_text("\n".join(["frame,timestamp,confidence,AU01_r,AU03_r", *rows]))
    command = ("clip", path, "-o", output, "--no-textures", "--fps", 10, "--json")
    refused = run(*command)
    assert refused.exit_code == 2
    assert "with a map" in " ".join(refused.output.split())
    mapped = ("--au-map", "AU01_r:AU1,AU03_r:AU4", "--confidence", 0.4, "--full-scale", 2)
    result = run(*command, *mapped, "--max-gap", 1)
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert (report["rows"], report["used"]) == (4, 3)
    assert list(report["units"]) == ["AU1", "AU4"]


@pytest.mark.parametrize(
    ("content", "options", "said"),
    [
        ("AU12_r\n1\n", ("--au-map", "AU12_r"), "--au-map has 'AU12_r'; expected a column"),
        (None, (), "cannot be read"),
        ("", (), "the file is empty; expected a CSV"),
        ("name,age\nJoe,7\n", (), "expected those of OpenFace 2"),
        ("AU12_r\n1\n", ("--neutral", "often"), "expected auto, a share"),
        ("AU12_r\n1\n", ("--gain", "-1"), "gain is -1.0; expected"),
        ("AU12_r\n1\n", ("--rig", "nobody"), "no rig"),
        ("AU12_r\n1\n", ("--url", "http://127.0.0.1:1"), "does not answer"),
    ],
)
def test_a_tracker_s_file_that_cannot_be_rendered_is_refused(
    tmp_path: Path, content: str | None, options: tuple[str, ...], said: str
) -> None:
    source = tmp_path / "in.csv"
    if content is not None:
        source.write_text(content)
    assert said in refused(run("clip", source, "-o", tmp_path / "out.glb", *options))
    assert not (tmp_path / "out.glb").exists()


def test_a_missing_folder_is_said(timeline: Path, tmp_path: Path) -> None:
    assert "does not exist" in refused(run("clip", timeline, "-o", tmp_path / "no" / "b.glb"))


@pytest.mark.parametrize("arguments", [("clip",), ("clip", "--fps", "0"), ("dance",), ("--odd",)])
def test_wrong_usage_ends_with_2(arguments: tuple[str, ...]) -> None:
    refused(run(*arguments))


def test_a_sheet_says_which_sets_there_are(tmp_path: Path) -> None:
    said = refused(run("sheet", "-o", tmp_path / "a.png", "--set", "emotion"))
    assert "did you mean 'emotions'?" in said


def test_a_sheet_says_which_views_there_are(tmp_path: Path) -> None:
    assert "three-quarter" in refused(run("sheet", "-o", tmp_path / "a.png", "--view", "behind"))


def test_a_sheet_that_is_cut_out_wants_a_folder(tmp_path: Path) -> None:
    said = refused(run("sheet", "-o", tmp_path / "a.png", "--cut-out"))
    assert "a.png is no folder" in said


def test_a_sheet_says_what_is_no_edit(tmp_path: Path) -> None:
    said = refused(run("sheet", "-o", tmp_path / "a.png", "--edit", '{"palsi": {}}'))
    assert said.rstrip().endswith("did you mean 'palsy' or 'passing'?")


def test_only_one_worker_is_served(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "one worker" in refused(run("serve", "--workers", 2))
    monkeypatch.setenv("WEB_CONCURRENCY", "4")
    assert "one worker" in refused(run("serve"))


def test_a_port_in_use_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RISORIUS_DATA_DIR", str(tmp_path))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert f"Port {port} on 127.0.0.1 is in use" in refused(run("serve", "--port", port))


def test_a_setting_that_is_not_valid_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RISORIUS_MAX_SESSIONS", "many")
    assert "max_sessions" in refused(run("serve"))


@pytest.mark.parametrize(
    ("variable", "value"),
    [
        ("DATA_DIR", "{file}/data"),
        ("DATABASE_URL", "nonsense"),
        ("DATABASE_URL", "sqlite:///{folder}"),
        ("DATABASE_URL", "postgresql://someone:secret@nowhere/faces"),
    ],
)
def test_a_database_that_cannot_be_opened_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str, value: str
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("RISORIUS_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv(f"RISORIUS_{variable}", value.format(file=file, folder=tmp_path))
    said = refused(run("serve", "--port", 0))
    assert "cannot be opened" in said
    assert "RISORIUS_DATA_DIR" in said
    assert "secret" not in said


def test_a_service_starts_says_where_and_stops(tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    process = subprocess.Popen(
        [sys.executable, "-m", "service", "serve", "--port", str(port)],
        env={**os.environ, "RISORIUS_DATA_DIR": str(tmp_path)},
        cwd=Path(__file__).parents[2],
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + 60
        while True:
            try:
                ready = f"http://127.0.0.1:{port}/api/ready"
                with urllib.request.urlopen(ready, timeout=5) as answer:
                    assert answer.status == 200
                    break
            except OSError as error:
                if isinstance(error, urllib.error.HTTPError):
                    error.close()
                assert time.monotonic() < deadline
                time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=30)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 0
    assert f"http://127.0.0.1:{port}" in said
    assert "ready" in said


def test_documents_of_a_short_run_are_refused(tmp_path: Path) -> None:
    assert "leave out --quick" in refused(run("bench", "--quick", "--docs", tmp_path))
    assert "does not exist" in refused(run("bench", "--docs", tmp_path / "nowhere"))


def test_a_part_of_the_benchmark_that_is_not_there_is_said() -> None:
    assert "did you mean 'crowds'" in refused(run("bench", "--only", "crowd"))
