"""The face of one frame, baked: plain positions in one space, no node is moved."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..frame import Frame
from ..rig import Rig
from .accessors import metres
from .builder import GlbBuilder
from .drawn import DrawnFace, roots_of, turn_with, unit_normals
from .library import Array, Textures
from .materials import look_name
from .pose import RigidMotion, motions
from .scene import file_extras, part_attributes, rigid_parts, skin_attributes
from .tongue import posed_tongue


def face_to_glb(rig: Rig, frame: Frame, *, textures: Textures | None = None) -> bytes:
    """Return the face of `frame` as GLB: what a 3D printer or a still picture needs.

    Tissue, jaw, gaze and head pose are all baked into the positions, so that every mesh is in the
    same space and no reader needs to know about nodes, morph targets or animation.

    Args:
        rig: Whose face it is.
        frame: How it stands.
        textures: Its maps (`textures_of`), to be embedded; without them vertices have colours.
    """
    face = DrawnFace.of(rig.head)
    moved = motions(rig.head, rig.jaw, frame.pose)
    vertices = face.skin(frame.displacements)
    normals = face.skin_normals(vertices)
    extras = file_extras(rig_id=rig.id, rig_name=rig.name)
    builder = GlbBuilder({**extras, "tick": int(frame.tick)}, textures)
    root = builder.node("risorius")

    def add(name: str, attributes: dict[str, Array], triangles: Array, material: str) -> None:
        mesh = builder.mesh(name, [builder.primitive(attributes, triangles, material=material)])
        builder.node(name, parent=root, mesh=mesh, extras={"material": material})

    shading = unit_normals(rig.head.drawn.normals + normals - face.rest_normals)
    skin = {
        **skin_attributes(rig.head),
        **_placed(vertices, shading, moved["head"]),
    }
    add("skin", skin, rig.head.drawn.triangles, "skin")
    for part, ridden in zip(face.strands, face.ride(vertices, normals), strict=True):
        roots = roots_of(part)
        turned = turn_with(face.rest_normals[roots], normals[roots], part.normals)
        attributes = {**part_attributes(part), **_placed(ridden, turned, moved["head"])}
        add(part.name, attributes, part.triangles, part.material)
    for part in rigid_parts(rig.head):
        own = moved[part.follows]
        at, facing = posed_tongue(part, frame.pose)
        placed = _placed(own.move(at), own.turn(facing), moved["head"])
        add(part.name, {**part_attributes(part), **placed}, part.triangles, look_name(part))
    return builder.to_bytes()


def _placed(vertices: FloatArray, normals: FloatArray, head: RigidMotion) -> dict[str, Array]:
    return {
        "POSITION": metres(head.move(vertices)),
        "NORMAL": unit_normals(head.turn(normals)).astype(np.float32),
    }
