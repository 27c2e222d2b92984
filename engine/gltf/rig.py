"""The rig file: the head at rest with every action unit as a morph target."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..frame import Frame
from ..head.head import Part
from ..rig import Rig
from ..settling import settled_units
from .builder import GlbBuilder, Textures, metres
from .drawn import DrawnFace
from .pose import motions
from .scene import (
    Pivot,
    add_pivots,
    add_rigid_parts,
    file_extras,
    part_attributes,
    part_node_name,
)
from .skin import add_skin, turn_of
from .targets import Target, add_targets
from .tongue import posed_tongue

SMALLEST_MOVE = 2e-3
"""Vertices that an action unit moves by less are taken as still: a tenth of the stream's grid, mm.
"""


def rig_to_glb(
    rig: Rig,
    *,
    textures: Textures | None = None,
    progress: Callable[[float], None] | None = None,
) -> bytes:
    """Return the rest head of `rig` with its action units as morph targets, as GLB.

    Weight 1 of target "AU12" is the face settled under AU12 at full intensity, both sides. The
    targets are the same, in the same order, on every mesh that has any: skin and strands (one
    mesh), lower teeth, lower gum and tongue; so a jaw action unit set on all of them moves the
    teeth with the lips. Between 0 and 1 a target moves along straight lines, which for a jaw is not
    quite its arc. Units of gaze and head turn nodes: their targets move nothing.

    Args:
        rig: What to write.
        textures: Its maps (`textures_of`), to be embedded; without them vertices have colours.
        progress: Told the share of the work done, 0 to 1.
    """
    names = tuple(rig.action_units)
    return targets_to_glb(rig, names, settled_units(rig, progress=progress), textures=textures)


def targets_to_glb(
    rig: Rig, names: Sequence[str], frames: Sequence[Frame], *, textures: Textures | None = None
) -> bytes:
    """Return the rest head of `rig` with one morph target per frame, called `names`."""
    builder = GlbBuilder(file_extras(rig_id=rig.id, rig_name=rig.name), textures)
    pivots = add_pivots(builder, rig.head, rig.jaw)
    face = DrawnFace.of(rig.head)
    rest = face.rest_positions()
    add_skin(
        builder,
        face,
        pivots["head"],
        names=names,
        moves=[face.positions(frame.displacements) - rest for frame in frames],
        turns=[turn_of(face, frame.displacements) for frame in frames],
        smallest=SMALLEST_MOVE,
    )
    add_rigid_parts(builder, rig.head, pivots, skip="jaw")
    for part in rig.head.parts:
        if part.follows == "jaw":
            targets = [_jaw_target(rig, part, frame) for frame in frames]
            _add_jaw_part(builder, part, pivots["jaw"], names, targets)
    return builder.to_bytes()


def _jaw_target(rig: Rig, part: Part, frame: Frame) -> Target:
    jaw = motions(rig.head, rig.jaw, frame.pose)["jaw"]
    vertices, normals = posed_tongue(part, frame.pose)
    return {
        "POSITION": metres(jaw.move(vertices) - part.vertices),
        "NORMAL": (jaw.turn(normals) - part.normals).astype(np.float32),
    }


def _add_jaw_part(
    builder: GlbBuilder,
    part: Part,
    parent: Pivot,
    names: Sequence[str],
    targets: Sequence[Target],
) -> None:
    primitive = builder.primitive(
        part_attributes(part, origin=parent.origin),
        part.triangles,
        material=part.material,
        targets=add_targets(builder, targets, smallest=SMALLEST_MOVE),
    )
    builder.node(
        part_node_name(part),
        parent=parent.node,
        mesh=builder.mesh(part.name, [primitive], target_names=names),
        extras={"role": "part", "material": part.material},
    )
