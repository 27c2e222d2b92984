"""When rows were, which of them count, and what is between them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracker_files import csv_of, openface, openface_header, openface_rows, read, unit

from engine import InvalidTrack
from engine.trackers.clock import timecode_seconds

HEADER = openface_header(40)


def table(times: list[float], smiles: list[float], **columns: list[float]) -> bytes:
    values = {"timestamp": times, "AU12_r": smiles, **columns}
    return csv_of(HEADER, openface_rows(HEADER, len(times), values))


def test_a_clock_may_start_anywhere() -> None:
    track = read(table([1.0 + i / 30 for i in range(4)], [1.0, 2.0, 3.0, 4.0]))
    assert unit(track, "AU12") == pytest.approx([0.2, 0.4, 0.6, 0.8])
    assert track.report.clock.start == 1.0


def test_a_nonsense_clock_gives_way_to_the_rate_that_is_said() -> None:
    data = table([i * 0.001 for i in range(50)], [float(i % 5) for i in range(50)])
    assumed = read(data)
    assert assumed.duration == pytest.approx(50 / 30)
    assert any("give fps" in note for note in assumed.report.notes)
    said = read(data, fps=10)
    assert said.duration == pytest.approx(5.0, abs=0.1)
    assert not any("give fps" in note for note in said.report.notes)
    assert "frame numbers at 10" in said.report.clock.source


def test_a_good_clock_is_believed_whatever_rate_is_said() -> None:
    data = table([i / 30 for i in range(31)], [0.0] * 31)
    assert read(data, fps=10).duration == read(data).duration


def test_milliseconds_are_told_by_their_steps() -> None:
    track = read(table([i * 40.0 for i in range(26)], [0.0] * 26))
    assert track.duration == pytest.approx(1.0, abs=0.05)
    assert any("milliseconds" in note for note in track.report.notes)


@given(st.lists(st.floats(0.02, 0.3), min_size=2, max_size=40))
def test_an_irregular_clock_keeps_its_times(steps: list[float]) -> None:
    times = [0.0, *np.cumsum(steps).round(3).tolist()]
    smiles = [min(time, 5.0) for time in times]
    track = read(table(times, smiles))
    # The smile is the time itself: so it must be in every frame.
    at = np.arange(len(track)) / track.rate
    assert np.allclose(unit(track, "AU12"), np.minimum(at, 5.0) / 5.0, atol=0.02)
    assert track.report.clock.repairs == {}


def test_a_clock_that_jumps_back_goes_on() -> None:
    times = [i / 30 for i in range(10)] + [i / 30 for i in range(10)]
    track = read(table(times, [float(i) / 4 for i in range(20)]))
    assert len(track) == 20
    assert unit(track, "AU12") == pytest.approx([i / 20 for i in range(20)], abs=1e-2)
    assert sum(track.report.clock.repairs.values()) == 1


def test_rows_of_one_moment_are_one() -> None:
    times = [i / 30 for i in range(10) for _ in range(2)]
    track = read(table(times, [1.0, 5.0] * 10))
    assert unit(track, "AU12") == pytest.approx([0.2] * 10)


def test_the_face_seen_most_is_played_unless_another_is_asked_for() -> None:
    faces = [0.0, 1.0, 1.0] * 10
    times = [i // 3 / 30 if i % 3 < 2 else i // 3 / 30 + 1 / 60 for i in range(30)]
    smiles = [1.0 if face == 0.0 else 4.0 for face in faces]
    data = table(times, smiles, face_id=faces)
    most = read(data)
    assert (most.report.face, most.report.faces) == ("1", {"0": 10, "1": 20})
    assert unit(most, "AU12") == pytest.approx([0.8] * len(most))
    other = read(data, face="0")
    assert unit(other, "AU12") == pytest.approx([0.2] * len(other))
    assert any("face=1" in note for note in other.report.notes)
    with pytest.raises(InvalidTrack, match=r"no face '7'.*0, 1"):
        read(data, face="7")


def test_rows_without_a_face_are_dropped_and_bridged() -> None:
    smiles = [1.0, 1.0, 1.0, 5.0, 5.0, 1.0, 1.0]
    success = [1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0]
    confidence = [0.98, 0.98, 0.98, 0.9, 0.03, 0.98, 0.98]
    track = read(table([i / 30 for i in range(7)], smiles, success=success, confidence=confidence))
    assert unit(track, "AU12") == pytest.approx([0.2] * 7)
    report = track.report
    assert (report.used, report.filled, report.lost) == (5, 2, 0)
    assert sorted(report.dropped.values()) == [1, 1]
    assert report.units["AU12"].peak == pytest.approx(0.2)


def test_a_face_that_is_lost_for_long_rests_and_comes_back() -> None:
    success = [1.0] * 30 + [0.0] * 60 + [1.0] * 30
    times = [i / 30 for i in range(120)]
    track = read(table(times, [5.0] * 120, success=success, pose=[0.0] * 120))
    smile = unit(track, "AU12")
    assert smile[:30] == [1.0] * 30
    assert max(smile[45:75]) == 0.0
    assert smile[-30:] == pytest.approx([1.0] * 30)
    assert np.abs(np.diff(smile)).max() < 0.2
    report = track.report
    assert (report.lost, report.filled, report.gaps) == (60, 0, 1)
    assert report.longest_gap == pytest.approx(61 / 30, abs=1e-3)


def test_a_file_keeps_its_length_though_its_ends_have_no_face() -> None:
    success = [0.0] * 40 + [1.0] * 5 + [0.0] * 40
    track = read(table([i / 30 for i in range(85)], [5.0] * 85, success=success))
    assert len(track) == 85
    assert max(unit(track, "AU12")[:25]) == 0.0
    assert max(unit(track, "AU12")[-25:]) == 0.0
    assert track.report.lost == 80


def test_a_file_in_which_no_row_counts_says_why() -> None:
    with pytest.raises(InvalidTrack, match=r"none of the 3 rows.*success is 0"):
        read(table([0.0, 0.1, 0.2], [1.0] * 3, success=[0.0] * 3))


def test_what_lies_beyond_the_longest_track_is_counted_and_checked() -> None:
    smiles = [1.0] * 50 + [4.0] * 50
    track = read(table([i / 10 for i in range(100)], smiles), max_seconds=2.0)
    assert track.duration == 2.0
    assert track.report.rows == track.report.used == 100
    assert track.report.units["AU12"].peak == pytest.approx(0.8)
    assert track.report.left_out == pytest.approx(7.9)
    with pytest.raises(InvalidTrack, match="row 100"):
        read(table([i / 10 for i in range(100)], [*smiles[:-1], -3.0]), max_seconds=2.0)


def test_timecodes_are_read_with_their_part_of_a_frame() -> None:
    seconds = timecode_seconds(["01:00:01:15.500", "01:00:02:00"], 30.0)
    assert seconds == pytest.approx([3601.0 + 15.5 / 30, 3602.0])
    with pytest.raises(InvalidTrack, match=r"row 1.*timecode"):
        timecode_seconds(["noon"], 30.0)


def test_a_track_stands_on_its_rows_or_on_ticks() -> None:
    def rate(fps: float) -> int:
        return read(openface({}, 30, fps=fps)).rate

    assert [rate(fps) for fps in (15.0, 30.0, 25.0, 50.0, 60.0)] == [30, 30, 60, 60, 60]
