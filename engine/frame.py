"""A face at one moment: what a simulator hands out and a clip keeps."""

from __future__ import annotations

from dataclasses import dataclass

from .arrays import FloatArray


@dataclass(frozen=True)
class Pose:
    """The rigid parts of a face: degrees, and mm for what is thrust forward.

    Attributes:
        jaw_pitch, jaw_yaw, jaw_thrust: Opening, turn of the chin to the face's left, thrust.
        gaze_left, gaze_right: Yaw and pitch of each eye.
        head: Yaw, pitch, roll.
        head_thrust: How far the head is held forward, mm.
        tongue_thrust: How far the tongue is put out, mm.
    """

    jaw_pitch: float = 0.0
    jaw_yaw: float = 0.0
    jaw_thrust: float = 0.0
    gaze_left: tuple[float, float] = (0.0, 0.0)
    gaze_right: tuple[float, float] = (0.0, 0.0)
    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    head_thrust: float = 0.0
    tongue_thrust: float = 0.0


@dataclass(frozen=True, eq=False)
class Frame:
    """A face at one tick.

    Attributes:
        tick: Ticks since the face was added.
        displacements: Of the tissue surface from rest, mm, shape (s, 3).
        activations: Muscle activations as they act, shape (m,).
        pose: Jaw, gaze, head, tongue.
        asleep: True when nothing will move until a command comes.
        diverged: True when the face left the finite numbers and was put back to rest.
    """

    tick: int
    displacements: FloatArray
    activations: FloatArray
    pose: Pose
    asleep: bool
    diverged: bool
