"""Finished performances: a timeline played through a fresh simulator, frame by frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .arrays import Float32Array
from .errors import Cancelled, Diverged, InvalidValue
from .frame import Frame, Pose
from .rig import Model, Rig
from .settling import Progress
from .simulator import Simulator
from .timeline import TICKS_PER_SECOND, Timeline, ticks

FACE = "clip"
MAX_FPS = TICKS_PER_SECOND


@dataclass(frozen=True, eq=False)
class Clip:
    """A finished performance of one face.

    Attributes:
        rig: Who performed.
        fps: Frames a second; frame i is at i / fps seconds.
        displacements: Of the tissue surface from rest [mm], shape (f, s, 3).
        poses: Jaw, gaze and head of each frame, length f.
        activations: Of each muscle, shape (f, m).
        timeline: What was played; None of frames that were put together.
        model: The forms of the physics that it was played with.
        start: Seconds of the timeline that are left out.
    """

    rig: Rig
    fps: int
    displacements: Float32Array
    poses: tuple[Pose, ...]
    activations: Float32Array
    timeline: Timeline | None = None
    model: Model | None = None
    start: float = 0.0

    def __len__(self) -> int:
        return len(self.poses)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) / self.fps

    def after(self, seconds: float) -> Clip:
        """Return the clip without its first `seconds`, to the nearest frame; one is left."""
        first = min(round(seconds * self.fps), len(self) - 1)
        return replace(
            self,
            displacements=self.displacements[first:],
            poses=self.poses[first:],
            activations=self.activations[first:],
            start=self.start + first / self.fps,
        )


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

    def frames() -> Iterator[Frame]:
        for index in range(count):
            if cancelled is not None and cancelled():
                raise Cancelled(f"the recording was stopped at frame {index} of {count}")
            yield player.advance(nearest_tick(index, fps))
            if progress is not None:
                progress((index + 1) / count)

    played = _taken(rig, fps, frames(), count)
    return replace(played, timeline=timeline, model=player.model)


def clip_of(rig: Rig, fps: int, frames: Sequence[Frame]) -> Clip:
    """Return `frames`, taken `fps` a second, as a clip.

    Raises:
        InvalidValue: There are none.
    """
    return _taken(rig, fps, frames, len(frames))


def _taken(rig: Rig, fps: int, frames: Iterable[Frame], count: int) -> Clip:
    """Return the clip of `count` frames, each copied as it comes.

    A frame of a fast face is a view of its bank, sixteen faces wide: kept, it would keep them all.
    """
    poses = []
    displacements = activations = np.empty((0, 0, 3), np.float32)
    for index, frame in enumerate(frames):
        if index == 0:
            displacements = np.empty((count, *frame.displacements.shape), np.float32)
            activations = np.empty((count, *frame.activations.shape), np.float32)
        displacements[index] = frame.displacements
        activations[index] = frame.activations
        poses.append(frame.pose)
    if not poses:
        raise InvalidValue("there are 0 frames; a clip has at least one")
    return Clip(rig, fps, displacements, tuple(poses), activations)


def nearest_tick(index: int, fps: int) -> int:
    """Return the tick nearest to frame `index`; halves go up, so that the steps stay even."""
    return (2 * index * TICKS_PER_SECOND + fps) // (2 * fps)


class _Player:
    """One face, its simulator, and the keyframes that are still to come."""

    def __init__(self, rig: Rig, timeline: Timeline, model: Model | None) -> None:
        self._coming = list(timeline.keyframes)
        self._simulator = Simulator(rig, model=model)
        self.model = self._simulator.model
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
