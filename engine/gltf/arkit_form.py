"""A clip as weights of ARKit's 52 shapes: the animation plays on every avatar that has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..arkit import arkit_table
from ..arrays import Float32Array, FloatArray
from ..clip import Clip
from ..frame import Frame, Pose
from ..head.head import Part
from ..settling import settled_arkit
from .builder import Channel, GlbBuilder
from .drawn import DrawnFace
from .error import FRAMES_AT_ONCE, Check, parts_of, rows_of
from .form import Fit
from .lighter import lighter
from .motion import ClipMotion
from .packing import WEIGHT_STEPS, Packing
from .pose import motions
from .rig import CARRIED, SMALLEST_MOVE, add_carried_part, carried_target
from .scene import Pivot
from .skin import add_piece
from .solving import bounded_weights
from .tongue import posed_tongue

PART_STRIDE = 4
"""Of the vertices of teeth, tongue and eyes every fourth is fitted: they move as a whole."""


def fit_arkit(clip: Clip, motion: ClipMotion, packing: Packing, check: Check) -> Fit:
    """Return the weights of ARKit's shapes, each simulated once on this rig, in every frame.

    Skin, lower teeth, tongue and eyes are fitted together by least squares within [0, 1]. What is
    left is in `residual_mm`: shapes add up along straight lines, and tissue does not.
    """
    rig, names = clip.rig, tuple(arkit_table().shapes)
    frames = settled_arkit(rig)
    moves = motion.drawer.moves(np.stack([frame.displacements for frame in frames]).astype("f4"))
    turns = motion.drawer.turns(np.stack([frame.displacements for frame in frames]).astype("f4"))
    carried = [lighter(part, rig.level) for part in rig.head.parts if part.follows in CARRIED]
    skin = motion.drawer.pieces[0]
    shapes = rows_of(np.ascontiguousarray(moves[:, skin])).astype(np.float32)
    rigid = _carried_moves(clip, carried, frames)
    weights = _weights(clip, motion, carried, shapes, rigid, check)
    if packing.quantize:
        weights = np.rint(weights * WEIGHT_STEPS) / WEIGHT_STEPS
    told = {
        "arkit": arkit_table().version,
        "residual_mm": _residual(motion, shapes, weights[_first_shown(motion)], check),
    }
    values = weights.astype(np.float32).ravel()

    def add(builder: GlbBuilder, face: DrawnFace, pivots: Mapping[str, Pivot]) -> list[Channel]:
        nodes = []
        for piece, place in zip(motion.pieces, motion.drawer.pieces, strict=True):
            nodes.append(
                add_piece(
                    builder,
                    face,
                    pivots["head"],
                    piece,
                    names=names,
                    moves=list(moves[:, place]),
                    turns=list(turns) if piece.part is None else (),
                    smallest=SMALLEST_MOVE,
                )
            )
        moved = [motions(rig.head, rig.jaw, frame.pose) for frame in frames]
        for part in carried:
            targets = [
                carried_target(part, each[part.follows], frame)
                for each, frame in zip(moved, frames, strict=True)
            ]
            nodes.append(add_carried_part(builder, part, pivots[part.follows], names, targets))
        return [Channel(node, "weights", values) for node in nodes]

    return Fit(add, told, CARRIED)


def _weights(
    clip: Clip,
    motion: ClipMotion,
    carried: Sequence[Part],
    shapes: Float32Array,
    rigid: Float32Array,
    check: Check,
) -> FloatArray:
    """Return the weights of each frame of the clip, shape (f, 52)."""
    products = (shapes @ shapes.T).astype(np.float64) + rigid @ rigid.T
    skin = np.concatenate(
        [rows_of(part) @ shapes.T for part in parts_of(motion.pieces[0].motion)]
    ).astype(np.float64)
    wanted = skin[motion.shown] + _wanted_of_parts(clip, carried, rigid)
    return bounded_weights(products, np.ascontiguousarray(wanted.T), check=check)


def _wanted_of_parts(clip: Clip, carried: Sequence[Part], rigid: Float32Array) -> FloatArray:
    wanted = []
    for start in range(0, len(clip.poses), FRAMES_AT_ONCE):
        some = [_Posed(pose) for pose in clip.poses[start : start + FRAMES_AT_ONCE]]
        wanted.append(_carried_moves(clip, carried, some) @ rigid.T)
    return np.concatenate(wanted).astype(np.float64)


class _Posed:
    """A frame of which only the pose counts."""

    def __init__(self, pose: Pose) -> None:
        self.pose = pose


def _carried_moves(
    clip: Clip, carried: Sequence[Part], frames: Sequence[Frame | _Posed]
) -> Float32Array:
    """Return how some vertices of the parts move in frames [mm], shape (n, 3 v)."""
    rows: list[Any] = []
    for frame in frames:
        moved = motions(clip.rig.head, clip.rig.jaw, frame.pose)
        row = []
        for part in carried:
            vertices, _ = posed_tongue(part, frame.pose)
            row.append(
                moved[part.follows].move(vertices[::PART_STRIDE]) - part.vertices[::PART_STRIDE]
            )
        rows.append(np.concatenate(row).ravel() if row else np.zeros(0))
    return np.stack(rows).astype(np.float32)


def _first_shown(motion: ClipMotion) -> Any:
    """Return the first frame of the clip that shows each different frame."""
    return np.unique(motion.shown, return_index=True)[1]


def _residual(
    motion: ClipMotion, shapes: Float32Array, weights: FloatArray, check: Check
) -> dict[str, float]:
    """Return how far the skin is from where it was simulated: rms and greatest, mm."""
    own = weights.astype(np.float32)
    greatest, total, count = 0.0, 0.0, 0
    for part, some in zip(parts_of(motion.pieces[0].motion), parts_of(own), strict=True):
        check()
        left = (rows_of(part) - some @ shapes).reshape(part.shape)
        squares = np.einsum("fvi,fvi->fv", left, left)
        greatest = max(greatest, float(squares.max()))
        total += float(squares.sum(dtype=np.float64))
        count += squares.size
    return {"rms": round((total / count) ** 0.5, 4), "max": round(greatest**0.5, 4)}
