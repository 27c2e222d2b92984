"""Finished performances: a timeline played through a fresh simulator, frame by frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass

import numpy as np

from .arrays import Float32Array
from .cache import Arrays, cached_arrays, content_key
from .errors import Cancelled, Diverged, InvalidValue
from .frame import Frame, Pose
from .rig import Model, Rig
from .simulator import Simulator
from .sources import ENGINE_HASH
from .timeline import TICKS_PER_SECOND, Keyframe, Timeline, ticks

Progress = Callable[[float], None]

FACE = "clip"
MAX_FPS = TICKS_PER_SECOND
UNIT_FADE = 0.15
"""Seconds over which an action unit is raised before it settles; a jump excites the tissue."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A finished performance of one face.

    Attributes:
        rig: Who performed.
        fps: Frames a second; frame i is at i / fps seconds.
        displacements: Of the tissue surface from rest [mm], shape (f, s, 3).
        poses: Jaw, gaze and head of each frame, length f.
        activations: Of each muscle, shape (f, m).
    """

    rig: Rig
    fps: int
    displacements: Float32Array
    poses: tuple[Pose, ...]
    activations: Float32Array

    def __len__(self) -> int:
        return len(self.poses)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) / self.fps


def record(
    rig: Rig,
    timeline: Timeline,
    *,
    fps: int = 30,
    model: Model | None = None,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Clip:
    """Play `timeline` on a fresh face of `rig` and return what it did.

    The face is stepped at the live rate and does what a live face does, bit for bit. A keyframe
    takes effect at the tick nearest to its time; a frame shows the tick nearest to its own.

    Args:
        rig: Who performs.
        timeline: What to do; the clip has a frame at 0 s and its last at the end.
        fps: Frames a second, 1 to 60.
        model: Forms of the physics, the rig's own if None.
        progress: Told the share of the work done, 0 to 1, after each frame.
        cancelled: Asked before each frame whether to stop.

    Raises:
        InvalidValue: `fps` is out of range.
        UnknownName: A keyframe names what the rig does not have.
        Diverged: The simulation left the finite numbers.
        Cancelled: `cancelled` said so.
    """
    if not 1 <= fps <= MAX_FPS:
        raise InvalidValue(f"fps is {fps!r}; expected a whole number from 1 to {MAX_FPS}")
    player = _Player(rig, timeline, model)
    count = round(timeline.duration * fps) + 1
    frames = []
    for index in range(count):
        if cancelled is not None and cancelled():
            raise Cancelled(f"the recording was stopped at frame {index} of {count}")
        frames.append(player.advance(nearest_tick(index, fps)))
        if progress is not None:
            progress((index + 1) / count)
    return clip_of(rig, fps, frames)


def clip_of(rig: Rig, fps: int, frames: Sequence[Frame]) -> Clip:
    """Return `frames`, taken `fps` a second, as a clip."""
    return Clip(
        rig=rig,
        fps=fps,
        displacements=np.stack([frame.displacements for frame in frames]).astype(np.float32),
        poses=tuple(frame.pose for frame in frames),
        activations=np.stack([frame.activations for frame in frames]).astype(np.float32),
    )


def nearest_tick(index: int, fps: int) -> int:
    """Return the tick nearest to frame `index`; halves go up, so that the steps stay even."""
    return (2 * index * TICKS_PER_SECOND + fps) // (2 * fps)


class _Player:
    """One face, its simulator, and the keyframes that are still to come."""

    def __init__(self, rig: Rig, timeline: Timeline, model: Model | None) -> None:
        self._coming = list(timeline.keyframes)
        self._simulator = Simulator(rig, model=model)
        self._simulator.add(FACE)
        self._tick = 0

    def advance(self, tick: int) -> Frame:
        """Step to `tick`, applying keyframes on the way, and return the face there."""
        while self._tick < tick:
            while self._coming and ticks(self._coming[0].time) <= self._tick:
                self._simulator.apply(FACE, self._coming.pop(0))
            stepped = self._simulator.step()
            self._tick += 1
            if FACE in stepped and stepped[FACE].diverged:
                raise Diverged(f"the face diverged at {self._tick / TICKS_PER_SECOND:.2f} s")
        return self._simulator.frame(FACE)


def settled(
    rig: Rig,
    keyframes: Sequence[Keyframe],
    seconds: float = 1.0,
    *,
    progress: Progress | None = None,
) -> list[Frame]:
    """Return the face that each keyframe leads to, each on a face of its own.

    Args:
        rig: Whose faces.
        keyframes: One a face, applied to the face at rest.
        seconds: How long the faces are given; they are stepped together.
        progress: Told the share of the work done, 0 to 1.
    """
    simulator = Simulator(rig)
    faces = [f"face {number}" for number in range(len(keyframes))]
    for face, keyframe in zip(faces, keyframes, strict=True):
        simulator.add(face)
        simulator.apply(face, keyframe)
    total = max(1, ticks(seconds))
    for tick in range(total):
        simulator.step()
        if progress is not None:
            progress((tick + 1) / total)
    return [simulator.frame(face) for face in faces]


def settled_units(rig: Rig, *, progress: Progress | None = None) -> list[Frame]:
    """Return each action unit of `rig` settled at full intensity, in the rig's order.

    Kept on disk under the rig's id, for it takes seconds and many ask for it.
    """
    keyframes = [Keyframe(action_units={name: 1.0}, fade=UNIT_FADE) for name in rig.action_units]
    key = content_key(rig.id, keyframes, ENGINE_HASH)

    def build() -> Arrays:
        return _to_arrays(settled(rig, keyframes, progress=progress))

    return _from_arrays(cached_arrays("units", key, build))


def _to_arrays(frames: Sequence[Frame]) -> Arrays:
    return {
        "ticks": np.array([frame.tick for frame in frames]),
        "flags": np.array([(frame.asleep, frame.diverged) for frame in frames]),
        "displacements": np.stack([frame.displacements for frame in frames]),
        "activations": np.stack([frame.activations for frame in frames]),
        "poses": np.array([np.hstack(astuple(frame.pose)) for frame in frames]),
    }


def _from_arrays(arrays: Arrays) -> list[Frame]:
    return [
        Frame(
            tick=int(tick),
            displacements=displacements,
            activations=activations,
            pose=_pose(pose.tolist()),
            asleep=bool(flags[0]),
            diverged=bool(flags[1]),
        )
        for tick, flags, displacements, activations, pose in zip(
            *(arrays[name] for name in ("ticks", "flags", "displacements", "activations", "poses")),
            strict=True,
        )
    ]


def _pose(numbers: list[float]) -> Pose:
    pitch, yaw, thrust, *gaze, turn, nod, tilt, head_thrust, tongue_thrust = numbers
    left, right = (gaze[0], gaze[1]), (gaze[2], gaze[3])
    return Pose(pitch, yaw, thrust, left, right, (turn, nod, tilt), head_thrust, tongue_thrust)
