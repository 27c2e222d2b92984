"""The measurements: every figure is there and makes sense; none is held to a number of seconds."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from rich.console import Console

from engine import builtin_rig
from engine.head.geometry import triangle_areas
from service.benching import PARTS, measure
from service.benching.documents import write_documents
from service.benching.ledger import COLUMNS, OtherColumns, append_row, row_of
from service.benching.meshes import split
from service.benching.motion import TICKS_BETWEEN, Motion
from service.benching.picture import picture
from service.benching.report import markdown, sections, terminal

NOT_INSTALLED = "taichi is not installed: pip install 'risorius[bench]'"
Figures = dict[str, Any]


@pytest.fixture(scope="module")
def figures() -> Figures:
    """A short run of all but the page, which tests/browser/ opens."""
    return measure(only=[part for part in PARTS if part != "page_opening"], quick=True)


def peer(figures: Figures, name: str) -> dict[str, Any]:
    (found,) = [row for row in figures["peers"]["peers"] if row["name"] == name]
    return dict(found)


def without_taichi(figures: Figures) -> Figures:
    peers = [
        {"name": row["name"], "version": "", "unavailable": NOT_INSTALLED}
        if row["name"] == "taichi"
        else row
        for row in figures["peers"]["peers"]
    ]
    return {**figures, "peers": {**figures["peers"], "peers": peers}}


def test_every_figure_is_measured(figures: Figures) -> None:
    json.dumps(figures, allow_nan=False)
    assert {"processor", "cores", "python", "numba"} <= set(figures["machine"])
    assert {"risorius", "source", "date", "load_average", "niceness", "rig", "roof"} <= set(figures)
    for name in (
        "clip_simulation_times_real_time",
        "clip_times_real_time",
        "encode_milliseconds",
        "frame_bytes",
    ):
        assert figures["output"][name] > 0
    assert 0 < figures["roof"]["share_of_peak_percent"] < 100
    assert [row["faces"] for row in figures["crowds"]] == [1, 4, 16, 64, 256]
    assert [row["faces"] for row in figures["latency"]] == [1, 16, 64]
    for row in figures["latency"]:
        assert 0 < row["answered_median_ms"] <= row["answered_p99_ms"]
        assert row["answered_median_ms"] <= row["seen_median_ms"] <= row["seen_p99_ms"]


def test_an_emotion_is_timed_to_its_first_frame_beside_others(figures: Figures) -> None:
    found = figures["emotion_to_frame"]
    assert found["others"] == 20
    assert found["awake_median"] >= 20
    assert found["ticks"] > found["late_ticks"] >= 0
    assert [row["way"] for row in found["ways"]] == ["at once", "with its own onset"]
    for row in found["ways"]:
        assert row["emotions"] > 0
        assert 0 < row["answered_median_ms"] <= row["answered_p99_ms"]
        assert 0 < row["frame_median_ms"] <= row["frame_p99_ms"]
        assert row["frame_median_ticks"] == pytest.approx(0.06 * row["frame_median_ms"], abs=0.01)
    at_once, onset = found["ways"]
    assert at_once["moved_median_ticks"] < onset["moved_median_ticks"]


def test_clips_are_measured_by_length_and_by_form(figures: Figures) -> None:
    rows = figures["clips"]
    assert [(row["form"], row["seconds"]) for row in rows] == [
        ("basis", 0.5),
        ("basis", 1.0),
        ("arkit", 1.0),
        ("exact", 1.0),
    ]
    for row in rows:
        assert row["bytes"] < row["bytes_with_textures"]
        for name in ("simulation_seconds", "fit_seconds", "write_seconds", "seconds_a_second"):
            assert row[name] >= 0
    basis, exact = rows[1], rows[3]
    assert basis["error_mm"] <= 0.1
    assert basis["targets"] < exact["targets"]
    assert basis["bytes"] < exact["bytes"]


def test_late_ticks_are_counted_without_clips_and_beside_some(figures: Figures) -> None:
    found = figures["beside_clips"]
    assert (found["others"], found["clips"]) == (20, 4)
    assert [row["way"] for row in found["ways"]] == ["without clips", "beside 4 clips"]
    for row in found["ways"]:
        assert row["ticks"] > row["late_ticks"] >= 0
        assert row["tick_p99_ms"] > 0
        assert row["lateness_p99_ms"] >= 0
        assert row["loop_delay_p99_ms"] > 0


def test_one_part_is_measured_alone() -> None:
    figures = measure(only=["roof"], quick=True)
    assert "crowds" not in figures
    assert [section.title for section in sections(figures)] == ["The roof of the machine"]


def test_the_lanes_outrun_what_does_the_same_work(figures: Figures) -> None:
    """At sixteen faces, in the same run: generously, for a machine that does other things."""
    assert peer(figures, "lanes (float32)")["ratio"]["16"] == 1.0
    assert peer(figures, "alone (float64)")["ratio"]["16"] > 3.0
    for name in ("numpy", "scipy"):
        assert peer(figures, name)["ratio"]["16"] > 2.0
        assert peer(figures, name)["ratio"]["64"] > 2.0


def test_faces_side_by_side_cost_less_than_one_by_one(figures: Figures) -> None:
    cost = {row["faces"]: row["face_tick_us"] for row in figures["crowds"]}
    assert cost[16] < 0.5 * cost[1]
    for row in figures["crowds"]:
        assert row["awake"] == 1.0
        assert row["diverged"] == 0
        assert row["face_tick_us"] == pytest.approx(
            row["commanding_us"] + row["stepping_us"], abs=0.2
        )
        assert row["faces_per_core_60hz"] == pytest.approx(1e6 / 60 / row["face_tick_us"], rel=0.01)


def test_verlet_takes_fewer_steps_and_less_time(figures: Figures) -> None:
    rows = {(row["integrator"], row["precision"]): row for row in figures["integrators"]}
    assert len(rows) == 6
    assert rows["verlet", "float64"]["substeps"] < rows["rk2", "float64"]["substeps"]
    assert rows["verlet", "float64"]["face_tick_ms"] < rows["rk2", "float64"]["face_tick_ms"]
    lanes, alone = rows["verlet", "float32"], rows["verlet", "float64"]
    assert lanes["face_tick_ms"] < 0.5 * alone["face_tick_ms"]


def test_a_finer_mesh_costs_more(figures: Figures) -> None:
    coarse, fine = figures["meshes"]
    assert fine["triangles"] == 4 * coarse["triangles"]
    assert fine["face_tick_us"] > 1.5 * coarse["face_tick_us"]
    assert fine["diverged"] == coarse["diverged"] == 0


def test_split_triangles_cover_the_same_surface_without_seams() -> None:
    corners = np.array([[0.0, 0, 0], [2, 0, 0], [0, 3, 0], [2, 3, 1]])
    triangles = np.array([[0, 1, 2], [2, 1, 3]])
    for parts in (1, 2, 3):
        points, finer = split(corners, triangles, parts)
        assert len(finer) == 2 * parts**2
        assert len(points) == (parts + 1) ** 2
        area, whole = triangle_areas(points, finer), triangle_areas(corners, triangles)
        assert area.sum() == pytest.approx(whole.sum())


def test_every_face_takes_up_a_mix_of_its_own_every_fifteen_ticks() -> None:
    motion = Motion(builtin_rig("standard"), 40)
    first = dict(motion.due(0))
    assert set(first) == set(range(40))
    assert len({str(mix.action_units) for mix in first.values()}) == 40
    later = [face for tick in range(1, 1 + TICKS_BETWEEN) for face, _ in motion.due(tick)]
    assert sorted(later) == list(range(40))


def test_packed_frames_weigh_a_third_of_plain_ones_and_plain_ones_less_than_all(
    figures: Figures,
) -> None:
    rows = {row["form"]: row for row in figures["stream"]["forms"]}
    assert figures["stream"]["frames"] == 90
    assert rows["float32"]["bytes"] > rows["int16 from rest"]["bytes"] > rows["plain"]["bytes"]
    assert 3 * rows["packed"]["bytes"] < rows["plain"]["bytes"]
    assert rows["packed"]["worst_mbit_s"] < rows["packed, each whole"]["worst_mbit_s"] < 1.0
    for row in rows.values():
        assert 0 < row["mbit_s"] <= row["worst_mbit_s"]
        assert row["encode_us"] > 0
        assert row["viewer_us"] is None or row["viewer_us"] > 0
    assert rows["float32"]["viewer_us"] is None


def test_every_viewer_of_a_crowd_is_sent_frames_and_what_they_cost_adds_up(
    figures: Figures,
) -> None:
    assert [(row["faces"], row["viewers"]) for row in figures["viewers"]] == [(1, 3), (2, 2)]
    for row in figures["viewers"]:
        assert 0 < row["least_fps"] <= row["median_fps"] < 90
        assert row["mbit_s"] > 0
        assert 0 < row["encoding_percent"] < 100
        assert 0 < row["sending_percent"] < 100
        assert row["simulating_percent"] > 0
        assert row["loop_us_a_frame"] > 0


def test_the_tables_say_what_is_not_installed(figures: Figures) -> None:
    missing = without_taichi(figures)
    rows = sections(missing)[0].rows
    assert [row[1] for row in rows if row[0] == "taichi"] == ["not installed"]
    assert "not installed" in picture(missing)
    assert row_of(missing)["taichi_ratio"] == ""
    assert [column for column, value in row_of(missing).items() if value == ""] != []


def test_the_tables_have_every_part(figures: Figures) -> None:
    console = Console(record=True, width=160)
    console.print(terminal(figures))
    printed, written = console.export_text(), markdown(figures)
    for section in sections(figures):
        assert section.title in printed
        assert f"## {section.title}" in written
        assert all(len(row) == len(section.head) for row in section.rows)


def test_a_run_is_written_as_a_page_a_picture_and_a_row(figures: Figures, tmp_path: Path) -> None:
    write_documents(tmp_path, figures)
    write_documents(tmp_path, figures)
    page = (tmp_path / "benchmarks.md").read_text(encoding="utf-8")
    assert "benchmarks.svg" in page
    assert "lanes (float32)" in page
    ElementTree.parse(tmp_path / "benchmarks.svg")
    head, *rows = csv.reader((tmp_path / "benchmarks.csv").read_text().splitlines())
    assert tuple(head) == COLUMNS
    assert len(rows) == 2
    assert rows[0] == rows[1]
    row = dict(zip(head, rows[0], strict=True))
    assert row["machine"] == figures["machine"]["processor"]
    assert float(row["faces_per_core"]) > 0
    assert float(row["alone_ratio"]) > 1


def test_rows_are_not_mixed_with_others(figures: Figures, tmp_path: Path) -> None:
    path = tmp_path / "benchmarks.csv"
    path.write_text("release,speed\n0.1,12\n")
    with pytest.raises(OtherColumns, match="release, speed"):
        append_row(path, figures)
    assert path.read_text() == "release,speed\n0.1,12\n"
