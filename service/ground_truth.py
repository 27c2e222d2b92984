"""What a clip truly shows, a line a frame: action units, activations, pose, and landmarks."""

from __future__ import annotations

import csv
import io

import numpy as np

from engine import Clip, Timeline, landmarks_68

from .commanded import commanded_units

_POSE = (
    "jaw_pitch",
    "jaw_yaw",
    "jaw_thrust",
    "gaze_left_yaw",
    "gaze_left_pitch",
    "gaze_right_yaw",
    "gaze_right_pitch",
    "head_yaw",
    "head_pitch",
    "head_roll",
    "head_thrust",
    "tongue_thrust",
)


def ground_truth_csv(clip: Clip, timeline: Timeline, start: float = 0.0) -> str:
    """Return a table: frame, time [s], commanded units, activation of each muscle, pose, landmarks.

    The clip begins at `start` seconds of its timeline.

    The 68 landmarks are numbered as trackers number them, `x_0` to `z_67`, in the head's frame
    [mm], before the head's pose.
    """
    head = clip.rig.head
    times = [index / clip.fps for index in range(len(clip.displacements))]
    unit_names, units = commanded_units(timeline, clip.rig, [start + time for time in times])
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(
        [
            "frame",
            "time",
            *unit_names,
            *clip.rig.muscle_names,
            *_POSE,
            *(f"{axis}_{number}" for number in range(68) for axis in "xyz"),
        ]
    )
    for index, displacements in enumerate(clip.displacements):
        pose = clip.poses[index]
        landmarks = landmarks_68(head, displacements.astype(np.float64))
        table.writerow(
            [
                index,
                f"{times[index]:.6g}",
                *(f"{value:.4f}" for value in units[index]),
                *(f"{value:.4f}" for value in clip.activations[index]),
                *(f"{value:.3f}" for value in (pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)),
                *(f"{value:.3f}" for value in (*pose.gaze_left, *pose.gaze_right, *pose.head)),
                *(f"{value:.3f}" for value in (pose.head_thrust, pose.tongue_thrust)),
                *(f"{value:.3f}" for value in landmarks.ravel()),
            ]
        )
    return text.getvalue()
