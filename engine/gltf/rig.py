"""The rig file: the head at rest with every action unit, or ARKit shape, as a morph target."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ..arkit import arkit_table
from ..arrays import FloatArray
from ..frame import Frame
from ..head.head import Part
from ..rig import Rig
from ..settling import settled_arkit, settled_units
from .accessors import metres
from .builder import GlbBuilder
from .drawn import DrawnFace
from .library import Textures
from .materials import look_name
from .pose import RigidMotion, motions
from .scene import (
    EYE_NODES,
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
CARRIED = ("jaw", *EYE_NODES)
"""Pivots whose parts ARKit's shapes turn."""


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


def arkit_to_glb(
    rig: Rig,
    *,
    textures: Textures | None = None,
    progress: Callable[[float], None] | None = None,
) -> bytes:
    """Return the rest head of `rig` with ARKit's 52 blend shapes as morph targets, as GLB.

    Weight 1 of target "mouthSmileLeft" is the face settled under that weight. The targets are on
    the meshes of the action units' form, and on both eyes, which the shapes of gaze turn: these
    files are for programs that set weights and no nodes. Both eyes have one pitch, so each of two
    names has half of it. The asset's extras name the version of the table, the shapes that move
    nothing (`still`, if there are any), and what others stand in for (`stands_in`).

    Args:
        rig: What to write.
        textures: As for `rig_to_glb`.
        progress: As for `rig_to_glb`.
    """
    table = arkit_table()
    frames = settled_arkit(rig, progress=progress)
    told = {
        "arkit": table.version,
        "still": [
            name for name, frame in zip(table.shapes, frames, strict=True) if _still(rig, frame)
        ],
        "stands_in": {
            shape.name: shape.stands_in for shape in table.shapes.values() if shape.stands_in
        },
    }
    return targets_to_glb(
        rig, tuple(table.shapes), frames, textures=textures, carried=CARRIED, told=told
    )


def targets_to_glb(
    rig: Rig,
    names: Sequence[str],
    frames: Sequence[Frame],
    *,
    textures: Textures | None = None,
    carried: Sequence[str] = ("jaw",),
    told: Mapping[str, object] | None = None,
) -> bytes:
    """Return the rest head of `rig` with one morph target per frame, called `names`.

    Args:
        rig: What to write.
        names: Of the targets.
        frames: The face at weight 1 of each.
        textures: As for `rig_to_glb`.
        carried: Pivots whose parts have the targets too, turned and moved as in each frame.
        told: What else the asset's extras say.
    """
    extras = {**file_extras(rig_id=rig.id, rig_name=rig.name), **(told or {})}
    builder = GlbBuilder(extras, textures)
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
    add_rigid_parts(builder, rig.head, pivots, skip=carried)
    moved = [motions(rig.head, rig.jaw, frame.pose) for frame in frames]
    for part in rig.head.parts:
        if part.follows in carried:
            targets = [
                carried_target(part, each[part.follows], frame)
                for each, frame in zip(moved, frames, strict=True)
            ]
            add_carried_part(builder, part, pivots[part.follows], names, targets)
    return builder.to_bytes()


def _still(rig: Rig, frame: Frame) -> bool:
    """Return whether nothing that a file shows of a frame is anywhere but at rest."""
    moved = motions(rig.head, rig.jaw, frame.pose)
    carried = (part for part in rig.head.parts if part.follows in CARRIED)
    ways = (_moved(part, moved[part.follows], frame)[0] - part.vertices for part in carried)
    return all((np.abs(way) < SMALLEST_MOVE).all() for way in (frame.displacements, *ways))


def carried_target(part: Part, motion: RigidMotion, frame: Frame) -> Target:
    """Return how a part that jaw or eye carries changes in a frame, in the head's frame."""
    vertices, normals = _moved(part, motion, frame)
    return {
        "POSITION": metres(vertices - part.vertices),
        "NORMAL": (normals - part.normals).astype(np.float32),
    }


def _moved(part: Part, motion: RigidMotion, frame: Frame) -> tuple[FloatArray, FloatArray]:
    """Return vertices [mm] and normals, shape (v, 3), of a part in a frame."""
    vertices, normals = posed_tongue(part, frame.pose)
    return motion.move(vertices), motion.turn(normals)


def add_carried_part(
    builder: GlbBuilder,
    part: Part,
    parent: Pivot,
    names: Sequence[str],
    targets: Sequence[Target],
) -> int:
    """Add a part with morph targets of how it is carried; return its node."""
    attributes = part_attributes(part, origin=parent.origin)
    grid = builder.packing.grid(attributes["POSITION"])
    primitive = builder.primitive(
        attributes,
        part.triangles,
        material=look_name(part),
        targets=add_targets(builder, targets, smallest=SMALLEST_MOVE, grid=grid),
        grid=grid,
    )
    return builder.node(
        part_node_name(part),
        parent=parent.node,
        mesh=builder.mesh(part.name, [primitive], target_names=names),
        extras={"role": "part", "material": part.material},
        grid=grid,
    )
