"""The clip file: a performance as few morph targets, their weights over time and moving nodes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray
from ..clip import Clip
from ..errors import Cancelled
from ..performance import Origin, Performance
from ..settling import Progress
from .basis import SHARE_DROPPED, MotionBasis, fit_basis
from .builder import Channel, GlbBuilder, Textures, metres
from .drawn import DrawnFace
from .error import FRAMES_AT_ONCE, Check, Motion
from .played import add_performance
from .pose import RigidMotion, motions
from .scene import Pivot, add_pivots, add_rigid_parts, file_extras
from .skin import add_skin, turn_of
from .tongue import TONGUE, out_weight

ANIMATION_NAME = "performance"
NORMAL_FRAMES = 150
"""Frames that the shapes' normals are fitted to."""
DRAWN_SHARE, BASIS_SHARE = 0.5, 0.95
"""Shares of the work that is done once the frames are drawn, and once their basis is found."""
ROUNDING = 1e-4
"""What single precision in metres may add to an error, mm."""
BYTES_IN_MEMORY = 2**29
"""Motion larger than this is not held but drawn again when it is looked at."""


def clip_to_glb(
    clip: Clip,
    *,
    tolerance: float = 0.05,
    textures: Textures | None = None,
    origin: Origin | None = None,
    seed: int | None = None,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> bytes:
    """Return `clip` as GLB: one animation, a key per frame.

    Skin and strands share one set of morph targets, a basis of their simulated motion with as few
    shapes as keep every vertex of every frame within `tolerance`; jaw, eyes and head are nodes
    that turn. The file's extras state the number of shapes and the error that they really leave.

    Args:
        clip: What to write.
        tolerance: Largest error of any vertex [mm].
        textures: The rig's maps (`textures_of`), to be embedded; without them vertices have
            colours.
        origin: Where the rig comes from, for the extras: with the timeline that `record` played
            they say what it takes to play the clip again (`performance_of`).
        seed: Of the idle life in the timeline.
        progress: Told the share of the work done, 0 to 1.
        cancelled: Asked again and again whether to stop.

    Raises:
        Cancelled: `cancelled` said so.
    """
    rig = clip.rig
    face = DrawnFace.of(rig.head)
    progress = progress or _nobody

    def check() -> None:
        if cancelled is not None and cancelled():
            raise Cancelled("the writing of a clip was stopped")

    motion = _drawn_motion(clip, face, progress, check)
    basis = fit_basis(motion, tolerance=tolerance, check=check)
    progress(BASIS_SHARE)
    builder = GlbBuilder(_extras(clip, basis, tolerance), textures)
    pivots = add_pivots(builder, rig.head, rig.jaw)
    skin = add_skin(
        builder,
        face,
        pivots["head"],
        names=[f"shape_{number:02d}" for number in range(len(basis.shapes))],
        moves=list(basis.shapes),
        turns=list(_turns(clip, face, basis)),
        smallest=SHARE_DROPPED * tolerance,
    )
    parts = add_rigid_parts(builder, rig.head, pivots)
    channels = [Channel(skin, "weights", basis.weights.ravel()), *_pose_channels(clip, pivots)]
    out = np.array([out_weight(pose) for pose in clip.poses])
    if out.any() and TONGUE in parts:
        channels.append(Channel(parts[TONGUE], "weights", out))
    asked = {"tolerance": tolerance, "textures": bool(textures)}
    performance = Performance.of(clip, origin=origin, seed=seed, file=asked)
    if performance is not None:
        add_performance(builder, performance)
    builder.animation(ANIMATION_NAME, np.arange(len(clip.displacements)) / clip.fps, channels)
    data = builder.to_bytes()
    progress(1.0)
    return data


def _extras(clip: Clip, basis: MotionBasis, tolerance: float) -> dict[str, object]:
    # Rounded up: the stated figure is a promise.
    error = math.ceil((basis.max_error + ROUNDING) * 1e4) / 1e4
    return {
        **file_extras(rig_id=clip.rig.id, rig_name=clip.rig.name),
        "basis": len(basis.shapes),
        "tolerance_mm": tolerance,
        "max_error_mm": error,
        "fps": clip.fps,
        "frames": len(clip.displacements),
    }


@dataclass(frozen=True, eq=False)
class DrawnMotion:
    """How skin and strands move from `rest` [mm], shape (v, 3), drawn frame by frame on demand."""

    face: DrawnFace
    rest: FloatArray
    displacements: Float32Array
    check: Check | None = None

    def __len__(self) -> int:
        return len(self.displacements)

    def __getitem__(self, frames: slice | IntArray, /) -> Float32Array:
        chosen = self.displacements[frames]
        motion = np.empty((len(chosen), *self.rest.shape), np.float32)
        for index, displacements in enumerate(chosen):
            if self.check is not None:
                self.check()
            if index and np.array_equal(displacements, chosen[index - 1]):
                motion[index] = motion[index - 1]  # A face that sleeps.
            else:
                motion[index] = self.face.positions(displacements) - self.rest
        return motion


def _drawn_motion(clip: Clip, face: DrawnFace, progress: Progress, check: Check) -> Motion:
    motion = DrawnMotion(face, face.rest_positions(), clip.displacements, check)
    count = len(motion)
    if count * motion.rest.size * np.dtype(np.float32).itemsize > BYTES_IN_MEMORY:
        return motion
    held = np.empty((count, *motion.rest.shape), np.float32)
    for start in range(0, count, FRAMES_AT_ONCE):
        frames = slice(start, min(start + FRAMES_AT_ONCE, count))
        held[frames] = motion[frames]
        progress(DRAWN_SHARE * frames.stop / count)
    return held


def _nobody(_share: float) -> None:
    """Tell nobody how far it is."""


def _turns(clip: Clip, face: DrawnFace, basis: MotionBasis) -> Float32Array:
    """Return the change of the skin's normals that best goes with each shape, shape (k, d, 3).

    Normals are not linear in the positions, so this is a least-squares fit over the frames.
    """
    count = len(clip.displacements)
    chosen = np.unique(np.linspace(0, count - 1, NORMAL_FRAMES).round().astype(np.int64))
    changes = np.stack([turn_of(face, clip.displacements[frame]).ravel() for frame in chosen])
    weights = basis.weights[chosen].astype(np.float64)
    # A little damping: shapes that none of these frames uses get no normals instead of noise.
    squares = weights.T @ weights + 1e-3 * np.eye(weights.shape[1])
    fitted = np.linalg.solve(squares, weights.T @ changes)
    return fitted.reshape(len(squares), -1, 3).astype(np.float32)


def _pose_channels(clip: Clip, pivots: Mapping[str, Pivot]) -> list[Channel]:
    """Return the channels of the nodes that move at all."""
    moved = [motions(clip.rig.head, clip.rig.jaw, pose) for pose in clip.poses]
    channels = []
    for name in moved[0]:
        own = [frame[name] for frame in moved]
        if not all(motion.still for motion in own):
            channels += _node_channels(pivots, name, own)
    return channels


def _node_channels(
    pivots: Mapping[str, Pivot], name: str, own: Sequence[RigidMotion]
) -> list[Channel]:
    node = pivots[name].node
    channels = [Channel(node, "rotation", np.stack([motion.quaternion for motion in own]))]
    if any(motion.shift.any() for motion in own):
        parent = np.zeros(3) if name == "head" else pivots["head"].origin
        places = np.stack([motion.origin + motion.shift - parent for motion in own])
        channels.append(Channel(node, "translation", metres(places)))
    return channels
