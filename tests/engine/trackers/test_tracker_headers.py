"""Trackers are told apart by their headers, and columns found by their names."""

from __future__ import annotations

import json
import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracker_files import (
    ARKIT,
    INTENSITIES,
    OPENFACE_UNITS,
    PYFEAT_UNITS,
    csv_of,
    openface,
    openface_header,
    openface_rows,
    read,
    unit,
)

from engine import InvalidTrack, builtin_rig

SMILE = {"AU12_r": [1.0, 2.0, 3.0], "AU06_r": [0.0, 0.5, 1.0], "p_rx": [4.0, 4.0, 4.0]}


@pytest.mark.parametrize("columns", [714, 431, 334, 40])
def test_openface_is_read_in_every_layout(columns: int) -> None:
    track = read(openface(SMILE, 3, columns=columns))
    assert track.report.tracker == "OpenFace 2"
    assert str(columns) in track.report.layout
    assert track.report.columns == columns
    assert unit(track, "AU12") == pytest.approx([0.2, 0.4, 0.6])
    assert unit(track, "AU6") == pytest.approx([0.0, 0.1, 0.2])
    assert set(track.units) == {f"AU{number}" for number in OPENFACE_UNITS}


def test_presences_and_the_shape_model_move_nothing() -> None:
    values = {
        "AU12_c": [1.0] * 3,
        "AU28_c": [1.0] * 3,
        "p_rx": [0.5] * 3,
        "AU04_r": [1.0, 2.0, 1.0],
    }
    track = read(openface(values, 3, columns=714))
    assert "AU28" not in track.units
    assert unit(track, "AU12") == [0.0, 0.0, 0.0]
    assert not track.angles.any()
    told = {column: why for why, names in track.report.ignored.items() for column in names}
    assert "no intensity" in told["AU28_c"]
    assert "shape model" in told["p_rx"]


def test_twenty_six_columns_are_scaled_already() -> None:
    track = read(openface({"AU12_r": [0.2, 0.4, 0.6]}, 3, columns=26))
    assert unit(track, "AU12") == pytest.approx([0.2, 0.4, 0.6])
    assert "divided by five" in track.report.layout


def test_twenty_six_columns_that_go_beyond_one_are_not_and_it_is_said() -> None:
    data = openface({"AU12_r": [1.0, 2.0, 3.0]}, 3, columns=26)
    track = read(data)
    assert unit(track, "AU12") == pytest.approx([0.2, 0.4, 0.6])
    assert "full_scale" in " ".join(track.report.notes)
    assert unit(read(data, full_scale=10.0), "AU12") == pytest.approx([0.1, 0.2, 0.3])


def test_rows_that_do_not_count_do_not_tell_the_scale() -> None:
    values = {"AU12_r": [0.2, 4.5, 0.6], "success": [1.0, 0.0, 1.0]}
    assert unit(read(openface(values, 3, columns=26)), "AU12") == pytest.approx([0.2, 0.4, 0.6])


def test_openface_3_by_index_is_refused_unless_there_is_a_map() -> None:
    header = ["frame", "timestamp", *(f"AU{index:02d}_r" for index in range(1, 9))]
    rows = [[str(i), str(i / 30), *(["0.1"] * 7), "0.9"] for i in range(3)]
    with pytest.raises(InvalidTrack, match=r"AU03_r.*by index.*map"):
        read(csv_of(header, rows))
    track = read(csv_of(header, rows), au_map={"AU08_r": "AU26", "au01_R": "L1"}, smooth=0.0)
    assert track.units == ("AU26", "L1")
    assert unit(track, "AU26") == pytest.approx([0.9] * 3)
    with pytest.raises(InvalidTrack, match="AU09_r"):
        read(csv_of(header, rows), au_map={"AU09_r": "AU26"})
    with pytest.raises(InvalidTrack, match="nose"):
        read(csv_of(header, rows), au_map={"AU08_r": "nose"})


@st.composite
def shuffled(draw: st.DrawFn) -> bytes:
    header = openface_header(40)
    rows = openface_rows(header, 3, SMILE)
    order = draw(st.permutations(range(40)))
    names = [
        draw(st.sampled_from(["", " ", "  "])) + draw(st.sampled_from([n, n.lower(), n.upper()]))
        for n in header
    ]
    comma = draw(st.sampled_from([",", ", ", ";", "\t"]))
    return csv_of([names[i] for i in order], [[row[i] for i in order] for row in rows], comma)


@given(shuffled())
def test_order_spaces_and_case_of_columns_never_matter(data: bytes) -> None:
    expected, track = read(openface(SMILE, 3)), read(data)
    assert sorted(track.units) == sorted(expected.units)
    for key in expected.units:
        assert unit(track, key) == unit(expected, key)


@given(st.lists(st.lists(st.floats(0.0, 5.0), min_size=17, max_size=17), min_size=1, max_size=8))
def test_intensities_come_back_from_a_file(rows: list[list[float]]) -> None:
    values = {name: [row[i] for row in rows] for i, name in enumerate(INTENSITIES)}
    track = read(openface(values, len(rows)))
    order = [track.units.index(f"AU{number}") for number in OPENFACE_UNITS]
    assert np.allclose(track.intensities[:, order], np.array(rows) / 5.0, atol=2e-3)
    assert len(track) == len(rows)


def pyfeat(version: int, rows: int = 4, step: int = 1) -> bytes:
    units = [f"AU{number:02d}" for number in PYFEAT_UNITS]
    pose = ["Pitch", "Roll", "Yaw"]
    late = version == 2
    feelings = ["Neutral", "Happy", "valence", "arousal"] if late else ["neutral", "happiness"]
    rest = ["gaze_pitch", "gaze_yaw", "jawOpen", "Identity_1", "Identity_2"] if late else []
    header = ["FaceScore", *pose, *units, *feelings, *rest, "input", "frame"]
    values = {"FaceScore": "0.99", "AU12": "0.5", "Pitch": "0.1" if late else "5.7", "jawOpen": "1"}
    values |= {"input": '"a,b.mp4"', "Identity_1": "private", "Identity_2": "private"}
    return csv_of(
        header,
        [
            [str(i * step) if n == "frame" else values.get(n, "0") for n in header]
            for i in range(rows)
        ],
    )


@pytest.mark.parametrize("version", [0, 2])
def test_pyfeat_is_read_in_radians_or_degrees_by_its_version(version: int) -> None:
    track = read(pyfeat(version), fps=30)
    assert track.report.tracker == "py-feat"
    assert unit(track, "AU12") == pytest.approx([0.5] * 4)
    pitch = track.angles[:, track.axes.index(("head", "pitch"))]
    assert pitch == pytest.approx([5.73 if version == 2 else 5.7] * 4, abs=0.01)
    assert (("gaze", "yaw") in track.axes) == (version == 2)
    assert "scores" in " ".join(track.report.notes)


def test_embeddings_of_a_face_are_never_read() -> None:
    report = read(pyfeat(2)).report.to_json()
    assert "private" not in json.dumps(report)
    assert any("never read" in why for why in report["ignored"])


def test_frames_that_step_by_two_take_twice_as_long() -> None:
    assert len(read(pyfeat(0, rows=11, step=2), fps=30)) == 21
    assert len(read(pyfeat(0, rows=11, step=1), fps=30)) == 11


def test_a_file_with_a_row_a_second_is_no_gap() -> None:
    track = read(pyfeat(0, rows=5, step=30), fps=30)
    assert track.report.gaps == 0
    assert unit(track, "AU12") == pytest.approx([0.5] * len(track))


def test_a_score_that_is_stuck_at_full_is_left_out_and_an_intensity_is_played() -> None:
    header = ["frame", "AU12", "AU20"]
    rows = [[str(i), f"{0.5 + 0.2 * (i % 2)}", "1.0"] for i in range(40)]
    track = read(csv_of(header, rows), fps=30)
    assert track.units == ("AU12",)
    assert ("AU20",) in track.report.ignored.values()
    held = read(openface({"AU12_r": [5.0] * 40}, 40))
    assert unit(held, "AU12") == [1.0] * 40
    assert held.report.stuck == ("AU12",)


def test_libreface_is_read() -> None:
    header = ["frame_idx", "frame_time_in_ms", "pitch", "yaw", "roll", "au_1", "au_12"]
    header += ["au_1_intensity", "au_12_intensity", "lm_mp_0_x", "facial_expression", "gaze_yaw"]
    rows = [
        [str(i), str(i * 1000 / 30), "10", "5", "0", "1", "0", "2.5", "5", "0.1", "Neutral", "0"]
        for i in range(3)
    ]
    track = read(csv_of(header, rows))
    assert track.report.tracker == "LibreFace"
    assert track.units == ("AU1", "AU12")
    assert unit(track, "AU1") == pytest.approx([0.5] * 3)
    assert unit(track, "AU12") == pytest.approx([1.0] * 3)


def pascal(name: str) -> str:
    return name[0].upper() + name[1:]


def live_link(names: list[str], values: dict[str, float], rows: int = 3) -> bytes:
    header = ["Timecode", "BlendShapeCount", *names, "HeadYaw", "HeadPitch", "HeadRoll"]
    header += ["LeftEyeYaw"]
    lines = [
        [f"17:03:59:{i:02d}.250", "61", *(str(values.get(n, 0.0)) for n in header[2:])]
        for i in range(rows)
    ]
    return csv_of(header, lines)


@given(st.permutations([pascal(name) for name in ARKIT]), st.randoms())
def test_live_link_face_is_read_in_any_order_and_case(
    names: list[str], chance: random.Random
) -> None:
    values = {pascal("jawLeft"): 0.5, pascal("mouthSmileRight"): 0.25, "HeadYaw": 0.1}
    cased = [chance.choice([n, n.lower(), n.upper()]) for n in names]
    table = {cased[names.index(n)] if n in names else n: v for n, v in values.items()}
    track = read(live_link(cased, table))
    assert track.report.tracker == "Live Link Face"
    assert unit(track, "L30") == pytest.approx([0.5] * len(track))
    assert unit(track, "R12") == pytest.approx([0.25] * len(track))
    assert not any(unit(track, "L12"))
    assert track.angles[0, track.axes.index(("head", "yaw"))] == pytest.approx(5.7296, abs=1e-3)


def test_a_column_that_is_there_twice_is_refused() -> None:
    with pytest.raises(InvalidTrack, match="same shape"):
        read(live_link([pascal(name) for name in ARKIT] + ["jawOpen_"], {}))
    header = [*openface_header(40), "au12_R"]
    with pytest.raises(InvalidTrack, match="2 columns named"):
        read(csv_of(header, [["0"] * 41]))


def test_a2f_3d_is_read() -> None:
    header = ["timeCode", *(f"blendShapes.{pascal(name)}" for name in ARKIT)]
    rows = [[f"{i / 30:.4f}", *("0.5" if n == "jawOpen" else "0" for n in ARKIT)] for i in range(4)]
    track = read(csv_of(header, rows))
    assert track.report.tracker == "A2F-3D"
    assert track.report.clock.source == "timestamps"
    assert unit(track, "AU27") == pytest.approx([0.5] * 4)


def test_eyes_look_where_blend_shapes_say() -> None:
    looks = {"EyeLookOutLeft": 1.0, "EyeLookInRight": 1.0}
    track = read(live_link([pascal(name) for name in ARKIT], looks))
    assert track.angles[0, track.axes.index(("gaze", "yaw"))] == pytest.approx(32.0)
    assert track.angles[0, track.axes.index(("gaze", "vergence"))] == pytest.approx(0.0)
    assert not any(
        axis[0] == "gaze"
        for axis in read(live_link([pascal(name) for name in ARKIT], looks), gaze=False).axes
    )


def json_lines(form: str, rows: int = 3) -> bytes:
    shapes = {"jawOpen": 0.5, "mouthSmileLeft": 0.25, "_neutral": 0.9}
    lists = [{"categoryName": name, "score": value} for name, value in shapes.items()]
    matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 2, -30, 1]
    forms = {
        "object": {"blendshapes": shapes},
        "categories": {"face_blendshapes": lists},
        "faces": {
            "faceBlendshapes": [{"categories": lists}],
            "facialTransformationMatrixes": [{"data": matrix}],
        },
        "flat": shapes,
    }
    lines = [{"timestamp_ms": i * 1000 / 30, **forms[form]} for i in range(rows)]
    return ("\n".join(json.dumps(line) for line in lines) + "\n").encode()


@pytest.mark.parametrize("form", ["object", "categories", "faces", "flat"])
def test_json_lines_of_mediapipe_are_read(form: str) -> None:
    track = read(json_lines(form))
    assert track.report.tracker == "MediaPipe"
    assert len(track) == 3
    assert unit(track, "AU27") == pytest.approx([0.5] * 3)
    assert unit(track, "L12") == pytest.approx([0.25] * 3)
    assert (("head", "yaw") in track.axes) == (form == "faces")


def test_units_that_a_rig_does_not_have_are_left_out_and_named() -> None:
    rig = builtin_rig("paper")
    fewer = replace(rig, action_units={n: u for n, u in rig.action_units.items() if n != "AU28"})
    assert read(pyfeat(0)).on(rig).units == read(pyfeat(0)).units
    track = read(pyfeat(0)).on(fewer)
    assert "AU28" not in track.units
    assert "AU12" in track.units
    assert track.intensities.shape[1] == len(track.units)
    assert "AU28" in track.report.ignored["the rig has no such unit"]
