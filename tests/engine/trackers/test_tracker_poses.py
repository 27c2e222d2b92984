"""Head and eyes turn as the person's did, whatever axes and signs a tracker has."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracker_files import angle, openface, read

from engine.gltf.pose import turned
from engine.trackers.angles import angles_of, turns_of
from engine.trackers.openface import head_turns

ANGLE = st.floats(-60.0, 60.0)


@given(ANGLE, ANGLE, ANGLE)
def test_angles_are_those_of_the_drawn_head(yaw: float, pitch: float, roll: float) -> None:
    turns = turns_of(np.array([[yaw, pitch, roll]]))
    assert np.allclose(turns[0], turned(yaw, pitch, roll), atol=1e-12)
    assert np.allclose(angles_of(turns), [[yaw, pitch, roll]], atol=1e-6)


@pytest.mark.parametrize(
    ("column", "axis", "sign"),
    [("pose_Rx", "pitch", -1.0), ("pose_Ry", "yaw", -1.0), ("pose_Rz", "roll", 1.0)],
)
def test_openface_turns_the_head(column: str, axis: str, sign: float) -> None:
    track = read(openface({column: [0.3]}, 1, columns=714))
    assert angle(track, "head", axis) == pytest.approx([sign * np.degrees(0.3)], abs=1e-3)
    others = {"yaw", "pitch", "roll"} - {axis}
    assert [angle(track, "head", other)[0] for other in others] == pytest.approx([0, 0], abs=1e-4)


def test_openface_s_matrix_is_its_own() -> None:
    """Against `Utilities::Euler2RotationMatrix`, written out, and seen from the face's side."""
    a, b, c = 0.2, -0.4, 0.3
    s1, s2, s3, c1, c2, c3 = *np.sin([a, b, c]), *np.cos([a, b, c])
    camera = np.array(
        [
            [c2 * c3, -c2 * s3, s2],
            [c1 * s3 + c3 * s1 * s2, c1 * c3 - s1 * s2 * s3, -c2 * s1],
            [s1 * s3 - c1 * c3 * s2, c3 * s1 + c1 * s2 * s3, c1 * c2],
        ]
    )
    nose = camera @ np.array([0.0, 0.0, -1.0])
    forward = head_turns(np.array([[a, b, c]]))[0][:, 2]
    assert forward == pytest.approx([nose[0], -nose[1], -nose[2]])


def test_eyes_that_stay_on_the_camera_turn_against_the_head() -> None:
    still = read(openface({"pose_Ry": [0.3], "gaze_angle_x": [0.0]}, 1, columns=714))
    assert angle(still, "head", "yaw") == pytest.approx([-17.19], abs=0.01)
    assert angle(still, "gaze", "yaw") == pytest.approx([17.19], abs=0.01)
    with_head = read(openface({"pose_Ry": [-0.3], "gaze_angle_x": [0.3]}, 1, columns=714))
    assert angle(with_head, "gaze", "yaw") == pytest.approx([0.0], abs=0.01)


def test_without_the_head_the_eyes_look_where_they_did_in_space() -> None:
    data = openface(
        {"pose_Ry": [0.3], "gaze_angle_x": [0.2], "gaze_angle_y": [0.1]}, 1, columns=714
    )
    track = read(data, head=False)
    assert not any(group == "head" for group, _ in track.axes)
    assert angle(track, "gaze", "yaw") == pytest.approx([np.degrees(0.2)], abs=1e-3)
    assert angle(track, "gaze", "pitch") == pytest.approx([-np.degrees(0.1)], abs=1e-3)
    assert read(data, head=False, gaze=False).axes == ()


def test_older_openface_tells_the_gaze_by_vectors() -> None:
    sight = {"gaze_0_x": [0.3], "gaze_0_y": [0.0], "gaze_0_z": [-1.0]}
    sight |= {"gaze_1_x": [0.1], "gaze_1_y": [0.0], "gaze_1_z": [-1.0]}
    track = read(openface(sight, 1, columns=431))
    assert angle(track, "gaze", "yaw") == pytest.approx([np.degrees(np.arctan(0.2))], abs=1e-3)


def test_a_gaze_that_is_missing_stays_where_it_was() -> None:
    gaze = {"gaze_angle_x": [0.2, float("nan"), 0.2], "AU45_r": [0.0, 5.0, 0.0]}
    track = read(openface(gaze, 3, columns=714))
    assert angle(track, "gaze", "yaw") == pytest.approx([np.degrees(0.2)] * 3, abs=1e-3)
