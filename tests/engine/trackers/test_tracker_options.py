"""Gain, the neutral face, smoothing, and the timeline that plays a track."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracker_files import csv_of, openface, read, unit

from engine import InvalidTrack, InvalidValue, Rig, Timeline, TrackOptions, track_timeline
from engine.mixing import Mixer
from engine.timeline import ticks
from engine.trackers.neutral import without_neutral
from engine.trackers.one_euro import OneEuro, smoothing


def test_gain_makes_more_of_it_and_never_more_than_all() -> None:
    track = read(openface({"AU12_r": [1.0, 2.0, 3.0]}, 3), gain=2.0)
    assert unit(track, "AU12") == pytest.approx([0.4, 0.8, 1.0])
    assert track.report.gain == 2.0
    assert any("gain=4.0" in n for n in read(openface({"AU12_r": [1.0]}, 1)).report.notes)


@given(st.floats(0.0, 0.97), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=9))
def test_neutral_is_0_and_full_stays_full(neutral: float, values: list[float]) -> None:
    column = np.array([[neutral], [1.0], *([value] for value in values)])
    found = without_neutral(column, np.array([neutral]))[:, 0]
    assert found[0] == 0.0
    assert found[1] == pytest.approx(1.0)
    assert (np.diff(found[np.argsort(column[:, 0])]) >= 0.0).all()


def test_neutral_is_off_unless_it_is_asked_for_and_advised_where_it_helps() -> None:
    browy = openface({"AU04_r": [2.0] * 20 + [4.0] * 10}, 30)
    plain = read(browy)
    assert unit(plain, "AU4")[0] == pytest.approx(0.4)
    assert any("neutral=0.1" in note for note in plain.report.notes)
    found = read(browy, neutral=0.1)
    assert unit(found, "AU4")[0] == 0.0
    assert unit(found, "AU4")[-1] == pytest.approx((0.8 - 0.4) / 0.6)
    assert found.report.units["AU4"].neutral == pytest.approx(0.4)


def test_neutral_frames_are_named_as_the_file_numbers_them() -> None:
    data = openface({"AU04_r": [5.0] * 5 + [1.0] * 5 + [3.0] * 5}, 15)
    track = read(data, neutral=(6, 10))  # OpenFace numbers its frames from 1.
    assert track.report.units["AU4"].neutral == pytest.approx(0.2)
    with pytest.raises(InvalidTrack, match="frames 90 to 99"):
        read(data, neutral=(90, 99))


def test_neutral_frames_of_a_file_without_numbers_count_from_0() -> None:
    rows = [[str(i / 30), value] for i, value in enumerate(["5", "5", "1", "1", "3"])]
    track = read(csv_of(["timestamp", "AU04_r"], rows), neutral=(2, 3))
    assert track.report.units["AU4"].neutral == pytest.approx(0.2)


@pytest.mark.parametrize(
    "options",
    [{"gain": -1.0}, {"fps": 0.0}, {"neutral": 1.5}, {"neutral": (5, 2)}, {"smooth": float("nan")}],
)
def test_options_out_of_range_are_refused(options: dict[str, object]) -> None:
    with pytest.raises(InvalidValue, match=next(iter(options))):
        TrackOptions(**options)  # type: ignore[arg-type]


def test_the_filter_is_the_paper_s_at_a_step() -> None:
    """The first step after rest, by hand: the speed's filter, then the cutoff, then the value."""
    rate, cutoff, beta = 60.0, 1.5, 2.0
    out = OneEuro(rate, cutoff, beta).filtered(np.array([[0.0], [1.0]]))[:, 0]
    speed = float(smoothing(1.0, rate)) * rate
    assert out[1] == pytest.approx(float(smoothing(cutoff + beta * speed, rate)))
    assert float(smoothing(1.0, rate)) == pytest.approx(1.0 / (1.0 + rate / (2.0 * np.pi)))


def test_smoothing_calms_noise_and_lets_a_blink_pass() -> None:
    noise = np.random.default_rng(0).normal(0.5, 0.05, (600, 1))
    calm = OneEuro(60.0, 1.5).filtered(noise)
    assert calm[60:].std() < 0.5 * noise.std()
    blink = np.concatenate([np.zeros(30), np.linspace(0, 1, 6), np.ones(3), np.zeros(30)])[:, None]
    assert OneEuro(60.0, 1.5).filtered(blink).max() > 0.8


def test_smoothing_is_off_for_intensities_and_can_be_asked_for() -> None:
    jumps = openface({"AU12_r": [0.0, 5.0] * 15}, 30)
    assert read(jumps).report.smoothing == 0.0
    assert any("smooth=1.5" in note for note in read(jumps).report.notes)
    calm = read(jumps, smooth=0.5)
    assert np.abs(np.diff(unit(calm, "AU12")[5:])).max() < 0.9


def test_peak_speeds_are_those_of_the_rows_and_of_what_is_played() -> None:
    unit_report = read(openface({"AU12_r": [0.0, 1.0, 1.0, 0.0]}, 4), gain=2.0).report.units["AU12"]
    assert unit_report.peak_speed == pytest.approx(0.2 * 30, rel=0.02)
    assert unit_report.played_speed == pytest.approx(0.4 * 30, rel=0.02)


@pytest.mark.parametrize("fps", [30.0, 60.0])
def test_the_command_goes_straight_from_frame_to_frame(standard_rig: Rig, fps: float) -> None:
    smile = [0.5, 1.0, 2.0, 3.0, 1.0, 0.5]
    track = read(
        openface(
            {"AU12_r": smile, "pose_Rx": [0.01 * i for i in range(6)]}, 6, columns=714, fps=fps
        )
    )
    assert track.rate == fps
    timeline = track_timeline(track)
    mixer, coming, found = Mixer(standard_rig), list(timeline.keyframes), []
    pitch = standard_rig.channels.index("head", "pitch")
    for tick in range(ticks(timeline.duration) - int(60 / fps) + 1):
        while coming and ticks(coming[0].time) <= tick:
            mixer.apply(coming.pop(0), tick)
        found.append(mixer.at(tick)[pitch])
    at = np.arange(len(found)) / 60.0
    frames = np.degrees([-0.01 * i for i in range(6)])
    assert np.allclose(found, np.interp(at, np.arange(6) / fps, frames), atol=0.02)


def test_a_timeline_is_of_the_tracker_and_says_only_what_changes() -> None:
    track = read(openface({"AU12_r": [1.0] * 20 + [2.0] * 20}, 40))
    timeline = track_timeline(track)
    assert len(timeline.keyframes) == 2
    assert {(k.owner, k.layer, k.replace) for k in timeline.keyframes} == {
        ("tracker", "puppet", True)
    }
    assert timeline.keyframes[1].time == pytest.approx(19 / 30)
    assert timeline.keyframes[1].action_units == {"AU12": 0.4}
    assert timeline.duration == pytest.approx(40 / 30)
    assert Timeline.from_json(timeline.to_json()).keyframes == timeline.keyframes


def test_every_track_can_be_played(standard_rig: Rig) -> None:
    wild = {"AU12_r": [0.0, 5.0], "pose_Rx": [-3.0, 3.0], "gaze_angle_x": [2.0, -2.0]}
    for keyframe in track_timeline(read(openface(wild, 2, columns=714))).keyframes:
        standard_rig.check(keyframe)
