"""Faces that settle: what commands lead to, each on a face of its own, stepped side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple

import numpy as np

from .arkit import arkit_blend, arkit_table
from .cache import Arrays, cached_arrays, content_key
from .channels import GROUPS
from .frame import Frame, Pose
from .rig import Model, Rig
from .simulator import Simulator
from .sources import ENGINE_HASH
from .timeline import Keyframe, ticks

Progress = Callable[[float], None]
Watch = Callable[[Sequence[Frame]], None]

UNIT_FADE = 0.15
"""Seconds over which an action unit is raised before it settles; a jump excites the tissue."""
LAG_SECONDS = 0.1
"""After a command's fade, the time until muscles that lag behind it have begun to move for certain:
before that, a face that stands still has not arrived."""


def settled(
    rig: Rig,
    keyframes: Sequence[Keyframe],
    seconds: float = 1.0,
    *,
    model: Model | None = None,
    threads: int | None = None,
    still_mm: float = 0.0,
    progress: Progress | None = None,
    watch: Watch | None = None,
) -> list[Frame]:
    """Return the face that each keyframe leads to, each on a face of its own.

    Args:
        rig: Whose faces.
        keyframes: One a face, applied to the face at rest.
        seconds: How long the faces are given; they are stepped together.
        model: Forms of the physics; the rig's own, as live faces run them, if None.
        threads: Faces stepped at a time; None takes one a core.
        still_mm: A face has arrived, and is stepped no more, once no point of it moves as far in
            a tick; at 0 every face is given all of the time.
        progress: Told the share of the work done, 0 to 1; may raise to stop it.
        watch: Shown every face after each tick.
    """
    simulator = Simulator(rig, model=model or rig.model.live, threads=threads)
    names = [str(number) for number in range(len(keyframes))]
    for name, keyframe in zip(names, keyframes, strict=True):
        simulator.add(name)
        simulator.apply(name, keyframe)
    total = max(1, ticks(seconds))
    # Before a face could have arrived, nobody compares it with itself a tick ago.
    early = [ticks((keyframe.fade or 0.0) + LAG_SECONDS) for keyframe in keyframes]
    ends = [simulator.frame(name) for name in names]
    for tick in range(total):
        if not simulator.faces:
            break
        simulator.step()
        for name in simulator.faces:
            face, frame = int(name), simulator.frame(name)
            if still_mm and tick >= early[face] and _moved(ends[face], frame) < still_mm:
                simulator.remove(name)
            ends[face] = frame
        if watch is not None:
            watch(ends)
        if progress is not None:
            progress((tick + 1) / total if simulator.faces else 1.0)
    return ends


def _moved(before: Frame, now: Frame) -> float:
    """Return how far the point that moved farthest did, mm."""
    return float(np.linalg.norm(now.displacements - before.displacements, axis=1).max())


def settled_units(rig: Rig, *, progress: Progress | None = None) -> list[Frame]:
    """Return each action unit of `rig` settled at full intensity, in the rig's order.

    Kept on disk under the rig's id, for it takes seconds and many ask for it.
    """
    keyframes = [Keyframe(action_units={name: 1.0}, fade=UNIT_FADE) for name in rig.action_units]
    return _kept("units", rig, keyframes, progress)


def settled_arkit(rig: Rig, *, progress: Progress | None = None) -> list[Frame]:
    """Return each of ARKit's blend shapes settled on `rig` at weight 1, in the table's order.

    Kept on disk as the units are. A shape of which the rig does nothing is a face at rest.
    """
    keyframes = []
    for name in arkit_table().shapes:
        blend = arkit_blend({name: 1.0})
        jaw, gaze, head, tongue = (blend.axes.get(group, {}) for group in GROUPS)
        keyframes.append(
            Keyframe(
                action_units=blend.units,
                jaw=jaw,
                gaze=gaze,
                head=head,
                tongue=tongue,
                fade=UNIT_FADE,
            )
        )
    return _kept("arkit", rig, keyframes, progress)


def _kept(
    kind: str,
    rig: Rig,
    keyframes: Sequence[Keyframe],
    progress: Progress | None,
) -> list[Frame]:
    """Return where keyframes lead to, settled once and kept on disk."""
    key = content_key(rig.id, keyframes, ENGINE_HASH)

    def build() -> Arrays:
        return _to_arrays(settled(rig, keyframes, progress=progress))

    return _from_arrays(cached_arrays(kind, key, build))


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
