"""Labelled clips: the same bits from a seed, gone on with where a call stopped, labels true."""

from __future__ import annotations

import csv
import hashlib
import json
import re
from pathlib import Path
from typing import Any

import pytest
from test_cli import refused, run

from engine import builtin_rig, parse_facs, people, performance_of
from service.dataset_plan import MOST_UNITS, DatasetPlan

SMALL = ("--level", "low", "--fps", 6, "--people", "amara,standard")


def lines_of(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / "manifest.jsonl").read_text().splitlines()]


def content_of(folder: Path) -> dict[str, str]:
    files = folder.iterdir()
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data set of four clips, made in one go by one process."""
    folder = tmp_path_factory.mktemp("sets") / "whole"
    result = run("dataset", "--count", 4, "--seed", 3, "-o", folder, "--jobs", 1, *SMALL)
    assert result.exit_code == 0, result.output
    assert "4 clips made" in result.output
    return folder


def test_a_line_says_who_did_what_and_names_its_files(made: Path) -> None:
    lines = lines_of(made)
    assert [line["number"] for line in lines] == [0, 1, 2, 3]
    names = {name for line in lines for name in (line["glb"], line["csv"])}
    assert {file.name for file in made.iterdir()} == {*names, "manifest.jsonl", "dataset.json"}
    for line in lines:
        for kind in ("glb", "csv"):
            data = (made / line[kind]).read_bytes()
            assert hashlib.sha256(data).hexdigest() == line[f"{kind}_sha256"]
        rig = builtin_rig(line["person"])
        assert line["rig"] == rig.id
        told = performance_of((made / line["glb"]).read_bytes())
        assert told.rig["id"] == rig.id
        assert told.engine == line["engine"]
        terms = {term.key: term.intensity for term in parse_facs(line["facs"])}
        assert terms == pytest.approx(line["action_units"])


def test_labels_are_what_the_ground_truth_says_at_the_apex(made: Path) -> None:
    for line in lines_of(made):
        with (made / line["csv"]).open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == line["frames"]
        reached, left = line["onset"] + line["fade"], line["onset"] + line["fade"] + line["hold"]
        held = [row for row in rows if reached + 0.02 <= float(row["time"]) <= left - 0.02]
        assert held
        for key, intensity in line["action_units"].items():
            for row in held:
                assert float(row[key]) == pytest.approx(intensity, abs=1e-3), (line, key)
        assert all(float(rows[0][key]) == 0.0 for key in line["action_units"])


def test_it_goes_on_where_it_stopped_to_the_same_bits(made: Path, tmp_path: Path) -> None:
    folder = tmp_path / "parts"
    asked = ("--seed", 3, "-o", folder, *SMALL)
    assert run("dataset", "--count", 2, *asked).exit_code == 0
    manifest = folder / "manifest.jsonl"
    cut, before = manifest.read_text()[:-9], (folder / "000000.glb").stat().st_mtime_ns
    manifest.write_text(cut)
    (folder / "000001.glb").write_bytes(b"half")
    (folder / "000002.glb.77").write_bytes(b"half")
    result = run("dataset", "--count", 4, "--jobs", 2, *asked)
    assert result.exit_code == 0, result.output
    assert "3 clips made" in result.output
    assert (folder / "000000.glb").stat().st_mtime_ns == before
    assert content_of(folder) == content_of(made)
    assert "0 clips made" in run("dataset", "--count", 4, *asked).output
    assert content_of(folder) == content_of(made)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--seed", 4, *SMALL), "was begun with another seed;"),
        (("--seed", 3, *SMALL, "--fps", 7), "another fps;"),
        (("--seed", 3, *SMALL, "--idle"), "another idle;"),
        (("--seed", 3, *SMALL, "--people", "nobody"), "no rig named 'nobody'"),
        (("--seed", 3, *SMALL, "--level", "lowest"), "no level 'lowest'"),
        (("--seed", -1), "--seed"),
        (("--count", 0), "--count"),
    ],
)
def test_what_does_not_go_on_with_it_is_refused(
    made: Path, options: tuple[Any, ...], said: str
) -> None:
    before = content_of(made)
    assert said in refused(run("dataset", "-o", made, *options))
    assert content_of(made) == before


def test_a_folder_of_something_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    assert "holds no data set" in refused(run("dataset", "-o", tmp_path))
    (tmp_path / "letter.txt").rename(tmp_path / "dataset.json")
    assert "not what a data set follows from" in refused(run("dataset", "-o", tmp_path))
    assert "cannot be written" in refused(run("dataset", "-o", tmp_path / "no" / "set"))


def test_draws_cover_people_and_expressions_and_depend_on_seed_and_number_alone() -> None:
    rig = builtin_rig("standard")
    plan = DatasetPlan(5, strangers=3)
    shown = [plan.shown(number, rig) for number in range(400)]
    assert shown[7] == plan.shown(7, rig)
    assert shown[7] != DatasetPlan(6, strangers=3).shown(7, rig)
    persons = [plan.person(number) for number in range(400)]
    assert {person.root for person in persons if not person.steps} == set(people())
    samples = {json.dumps(person.steps) for person in persons if person.steps}
    assert len(samples) == 3
    emotions = [each.label["emotion"] for each in shown]
    assert 140 < sum(name is not None for name in emotions) < 260
    mixed = [each.label["action_units"] for each in shown if each.label["emotion"] is None]
    assert {len(units) for units in mixed} == set(range(1, MOST_UNITS + 1))
    assert len({name for units in mixed for name in units}) > 30
    assert all(re.fullmatch(r"\d+(\.\d\d?)?", str(each.label["fade"])) for each in shown)
