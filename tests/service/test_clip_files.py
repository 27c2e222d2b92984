"""Files made clips: again bit for bit, many side by side, drawn; the rest of what fails is done."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from test_cli import TIMELINE, refused, run

from engine import ENGINE_HASH
from service.clip_files import Wanted, files_of, outputs_of
from service.clip_sheet import PICTURES, moments
from service.rendering import ClipRefused


def written(path: Path, **changes: Any) -> Path:
    path.write_text(json.dumps({**TIMELINE, "textures": False, **changes}))
    return path


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"rig": "paper", "level": "low"},
        {
            "start": 0.1,
            "duration": 1.5,
            "idle": {"seed": 7, "blinks": 2.0},
            "model": {"integrator": "verlet"},
        },
        {
            "timeline": [
                {"time": 0.0, "emotion": "joy", "hold": 0.05, "fade_out": 0.05, "layer": "mood"},
                {"time": 0.1, "arkit": {"jawOpen": 0.31}, "weight": 0.7, "ttl": 0.1},
            ]
        },
        {"textures": True, "fps": 7},
        {"form": "arkit", "quantize": False, "level": "high"},
        {"tolerance": 0.5, "sparse": False},
    ],
    ids=["facs", "paper", "life", "layers", "maps", "arkit", "rough"],
)
def test_a_clip_is_rendered_again_bit_for_bit(changes: dict[str, Any], tmp_path: Path) -> None:
    source = written(tmp_path / "a.json", **changes)
    first, again = tmp_path / "a.glb", tmp_path / "again.glb"
    assert run("clip", source, "-o", first, "--csv").exit_code == 0
    result = run("clip", first, "-o", again, "--csv")
    assert result.exit_code == 0, result.output
    assert again.read_bytes() == first.read_bytes()
    assert (tmp_path / "again.truth.csv").read_bytes() == (tmp_path / "a.truth.csv").read_bytes()
    assert "may make other bytes" not in result.output


def test_figures_are_printed_as_json(tmp_path: Path) -> None:
    source = written(tmp_path / "a.json", timeline=[{"time": 0.0, "facs": "12C+12D"}])
    result = run("clip", source, "-o", tmp_path / "a.glb", "--json")
    figures = json.loads(result.stdout)["clip"]
    assert figures["frames"] == 3
    assert figures["bytes"] == (tmp_path / "a.glb").stat().st_size
    assert "twice in facs" in figures["warnings"][0]


def test_of_another_engine_it_is_said_and_rendered(tmp_path: Path) -> None:
    first = tmp_path / "a.glb"
    assert run("clip", written(tmp_path / "a.json"), "-o", first).exit_code == 0
    other = "f" * len(ENGINE_HASH)
    first.write_bytes(first.read_bytes().replace(ENGINE_HASH.encode(), other.encode()))
    result = run("clip", first, "-o", tmp_path / "again.glb")
    assert result.exit_code == 0, result.output
    said = " ".join(result.output.split())
    assert "was made by the engine of Risorius" in said
    assert f"{other[:12]}; this one, {ENGINE_HASH[:12]}, may make other bytes of it." in said


@pytest.mark.parametrize(
    ("content", "options", "said"),
    [
        (None, (), "cannot be read"),
        (b"", (), "no GLB file"),
        (b"glTF" + bytes(40), (), "no GLB file"),
        (b"PK\3\4" + bytes(400), (), "no GLB file"),
        (b"", ("--fps", 3), "leave --rig and --fps out"),
        (b"", ("--url", "http://127.0.0.1:1"), "leave --url out"),
    ],
)
def test_a_glb_that_is_none_of_ours_is_refused(
    tmp_path: Path, content: bytes | None, options: tuple[Any, ...], said: str
) -> None:
    source = tmp_path / "in.glb"
    if content is not None:
        source.write_bytes(content)
    assert said in refused(run("clip", source, "-o", tmp_path / "out.glb", *options))
    assert not (tmp_path / "out.glb").exists()


def test_a_glb_of_another_program_is_refused(tmp_path: Path) -> None:
    document = json.dumps({"asset": {"version": "2.0"}}).encode().ljust(40)
    header = b"glTF" + (2).to_bytes(4, "little") + (20 + len(document)).to_bytes(4, "little")
    chunk = len(document).to_bytes(4, "little") + b"JSON" + document
    source = tmp_path / "in.glb"
    source.write_bytes(header + chunk)
    assert "no performance of ours" in refused(run("clip", source, "-o", tmp_path / "out.glb"))


def test_a_clip_is_not_written_over_by_itself(tmp_path: Path) -> None:
    source = tmp_path / "a.glb"
    source.write_bytes(b"")
    assert "written over" in refused(run("clip", source, "-o", source))


def test_folders_and_patterns_are_rendered_side_by_side(tmp_path: Path) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    written(folder / "a.json")
    written(folder / "b.json", timeline=[{"time": 0.0, "facs": "4D"}])
    (folder / "c.csv").write_text("AU12_r\n1\n2\n3\n")
    (folder / "d.json").write_text("{")
    (folder / "a.truth.csv").write_text("frame\n")
    result = run("clip", folder, "-o", out, "--no-textures", "--json", "--jobs", 2)
    assert result.exit_code == 2
    lines = [line for line in result.stderr.splitlines() if ": " in line]
    assert sorted(line.split(":")[0].rsplit("/")[-1][0] for line in lines) == ["a", "b", "c", "d"]
    assert "d.json is not a JSON file" in result.stderr
    assert sorted(file.name for file in out.iterdir()) == ["a.glb", "b.glb", "c.glb"]
    told = json.loads(result.stdout)
    assert set(told) == {str(folder / name) for name in ("a.json", "b.json", "c.csv")}
    assert told[str(folder / "c.csv")]["rows"] == 3
    for name, figures in told.items():
        size = (out / Path(name).with_suffix(".glb").name).stat().st_size
        assert figures["clip"]["bytes"] == size
    alone = tmp_path / "alone.glb"
    assert run("clip", folder / "b.json", "-o", alone, "--no-textures").exit_code == 0
    assert alone.read_bytes() == (out / "b.glb").read_bytes()


def test_what_files_are_named(tmp_path: Path) -> None:
    for name in ("b.json", "a.csv", "a.truth.csv", "notes.md", "c.glb"):
        (tmp_path / name).write_text("")
    a, b, c = (tmp_path / name for name in ("a.csv", "b.json", "c.glb"))
    assert files_of([tmp_path]) == [a, b]
    assert files_of([b, tmp_path, tmp_path / "[bc].*"]) == [b, a, c]
    assert files_of([tmp_path / "none.json"]) == [tmp_path / "none.json"]
    with pytest.raises(ClipRefused, match="names no file"):
        files_of([tmp_path / "*.xyz"])
    with pytest.raises(ClipRefused, match="would both be"):
        outputs_of([Path("x/a.csv"), Path("y/a.json")], tmp_path)
    with pytest.raises(ClipRefused, match="cannot be made"):
        outputs_of([b], b)
    assert Wanted().options.gain == 1.0


def test_a_sheet_shows_first_and_last_frame() -> None:
    assert moments(1) == [0]
    assert moments(5) == [0, 1, 2, 3, 4]
    shown = moments(301)
    assert (shown[0], shown[-1], len(shown)) == (0, 300, PICTURES)


def test_a_clip_s_frames_are_drawn_beside_it(tmp_path: Path) -> None:
    source = written(tmp_path / "a.json", timeline=[{"time": 0.0, "facs": "27E"}], duration=0.2)
    result = run("clip", source, "-o", tmp_path / "a.glb", "--png")
    if "apt install chromium" in result.output or "npm run build" in result.output:
        pytest.skip("there is no viewer or no Chromium here")
    assert result.exit_code == 0, result.output
    sheet = Image.open(tmp_path / "a.png").convert("L")
    assert sheet.width == 3 * 240
    first, last = (sheet.crop((left, 0, left + 240, 240)).tobytes() for left in (0, 480))
    assert first != last
