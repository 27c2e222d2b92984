"""The clip file: a performance as morph targets, their weights over time and moving nodes."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypedDict, Unpack

import numpy as np

from ..clip import Clip
from ..errors import Cancelled, InvalidValue, UnknownName
from ..performance import Origin, Performance
from ..settling import Progress
from .accessors import metres
from .arkit_form import fit_arkit
from .basis_form import fit_shapes
from .builder import Channel, GlbBuilder
from .drawn import DrawnFace
from .exact_form import every_frame
from .form import Fit, Form
from .library import Textures
from .lighter import lighter
from .motion import motion_of
from .packing import Packing
from .played import add_performance
from .pose import RigidMotion, motions, quaternions
from .scene import Pivot, add_pivots, add_rigid_parts, file_extras
from .tongue import TONGUE, out_weight

ANIMATION_NAME = "performance"
DRAWN_SHARE, FITTED_SHARE = 0.4, 0.8
"""Shares of the work that is done once the frames are drawn, and once shapes are fitted."""
FORMS: Mapping[str, Form] = {"basis": fit_shapes, "arkit": fit_arkit, "exact": every_frame}
"""How a clip's motion may be told, by name."""
LEAST_TOLERANCE, MOST_TOLERANCE = 0.01, 10.0
"""Of a clip, mm."""


@dataclass(frozen=True, eq=False)
class ClipFile:
    """A clip as GLB.

    Attributes:
        data: The file.
        told: What its extras say of the form: shapes, errors.
        fit_seconds: What the drawing of frames and the finding of shapes took.
        write_seconds: What the writing took.
    """

    data: bytes
    told: Mapping[str, object]
    fit_seconds: float
    write_seconds: float


class FileOptions(TypedDict, total=False):
    """How a clip is written, as `clip_file` says."""

    form: str
    tolerance: float
    quantize: bool
    sparse: bool
    textures: Textures | None
    origin: Origin | None
    seed: int | None
    progress: Progress | None
    cancelled: Callable[[], bool] | None


def clip_to_glb(clip: Clip, **options: Unpack[FileOptions]) -> bytes:
    """Return `clip` as GLB, as `clip_file` does.

    Raises:
        UnknownName, InvalidValue, Cancelled: As `clip_file`.
    """
    return clip_file(clip, **options).data


def clip_file(
    clip: Clip,
    *,
    form: str = "basis",
    tolerance: float = 0.1,
    quantize: bool = True,
    sparse: bool = True,
    textures: Textures | None = None,
    origin: Origin | None = None,
    seed: int | None = None,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ClipFile:
    """Return `clip` as GLB, one animation with a key per frame, and what is to be told of it.

    "basis" has few morph targets, a basis of the simulated motion with as few shapes as keep every
    vertex of every frame within `tolerance`; "arkit" has ARKit's 52 by name, with weights fitted
    to each frame, so that the animation plays on other avatars; "exact" has a target a frame. Jaw
    and eyes are nodes that turn, but with "arkit" morph targets too; the head is a node always.
    The extras state the error that is really left.

    Args:
        clip: What to write.
        form: One of `FORMS`.
        tolerance: Largest error of any vertex of "basis" [mm], 0.01 to 10; the grid of a quantised
            file goes by it in every form.
        quantize: Whether numbers are stored as integers, by `KHR_mesh_quantization`.
        sparse: Whether accessors may be sparse, where that is smaller.
        textures: The rig's maps (`textures_of`), to be embedded; without them vertices have
            colours.
        origin: Where the rig comes from, for the extras: with the timeline that `record` played
            they say what it takes to play the clip again (`performance_of`).
        seed: Of the idle life in the timeline.
        progress: Told the share of the work done, 0 to 1.
        cancelled: Asked again and again whether to stop.

    Raises:
        UnknownName: There is no such form.
        InvalidValue: The tolerance is out of range, or the clip too long for "exact".
        Cancelled: `cancelled` said so.
    """
    _check(form, tolerance)
    packing = Packing(quantize, sparse, tolerance)
    progress = progress or _nobody

    def check() -> None:
        if cancelled is not None and cancelled():
            raise Cancelled("the writing of a clip was stopped")

    started = time.perf_counter()
    face = DrawnFace.of(clip.rig.head)
    motion = motion_of(
        clip,
        face,
        [lighter(part, clip.rig.level) for part in face.strands],
        progress=lambda share: progress(DRAWN_SHARE * share),
        check=check,
    )
    progress(DRAWN_SHARE)
    fit = FORMS[form](clip, motion, packing, check)
    progress(FITTED_SHARE)
    fitted = time.perf_counter()
    told = {"form": form, **fit.told}
    extras = {
        **file_extras(rig_id=clip.rig.id, rig_name=clip.rig.name),
        **told,
        "tolerance_mm": packing.tolerance,
        "fps": clip.fps,
        "frames": len(clip.displacements),
    }
    builder = GlbBuilder(extras, textures, packing)
    asked = {
        "form": form,
        "tolerance": packing.tolerance,
        "quantize": packing.quantize,
        "sparse": packing.sparse,
        "textures": bool(textures),
    }
    performance = Performance.of(clip, origin=origin, seed=seed, file=asked)
    if performance is not None:
        add_performance(builder, performance)
    _add_scene(builder, clip, face, fit)
    data = builder.to_bytes()
    progress(1.0)
    return ClipFile(data, told, fitted - started, time.perf_counter() - fitted)


def _check(form: str, tolerance: float) -> None:
    if form not in FORMS:
        raise UnknownName("form of a clip", form, FORMS)
    if not LEAST_TOLERANCE <= tolerance <= MOST_TOLERANCE:
        raise InvalidValue(
            f"tolerance is {tolerance!r} mm; it must lie between {LEAST_TOLERANCE:g} and "
            f"{MOST_TOLERANCE:g}"
        )


def _add_scene(builder: GlbBuilder, clip: Clip, face: DrawnFace, fit: Fit) -> None:
    rig = clip.rig
    pivots = add_pivots(builder, rig.head, rig.jaw)
    channels = fit.add(builder, face, pivots)
    parts = add_rigid_parts(
        builder, rig.head, pivots, skip=fit.carried, drawn_as=lambda part: lighter(part, rig.level)
    )
    channels += _pose_channels(clip, pivots, skip=fit.carried)
    out = np.array([out_weight(pose) for pose in clip.poses])
    if out.any() and TONGUE in parts:
        channels.append(Channel(parts[TONGUE], "weights", out))
    builder.animation(ANIMATION_NAME, np.arange(len(clip.displacements)) / clip.fps, channels)


def _nobody(_share: float) -> None:
    """Tell nobody how far it is."""


def _pose_channels(
    clip: Clip, pivots: Mapping[str, Pivot], *, skip: Sequence[str]
) -> list[Channel]:
    """Return the channels of the nodes that move at all."""
    moved = [motions(clip.rig.head, clip.rig.jaw, pose) for pose in clip.poses]
    channels = []
    for name in moved[0]:
        own = [frame[name] for frame in moved]
        if name not in skip and not all(motion.still for motion in own):
            channels += _node_channels(pivots, name, own)
    return channels


def _node_channels(
    pivots: Mapping[str, Pivot], name: str, own: Sequence[RigidMotion]
) -> list[Channel]:
    node = pivots[name].node
    channels = [Channel(node, "rotation", quaternions([motion.rotation for motion in own]))]
    if any(motion.shift.any() for motion in own):
        parent = np.zeros(3) if name == "head" else pivots["head"].origin
        places = np.stack([motion.origin + motion.shift - parent for motion in own])
        channels.append(Channel(node, "translation", metres(places)))
    return channels
