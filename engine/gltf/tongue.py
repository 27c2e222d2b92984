"""The tongue of a file: one morph target, "out", beside the jaw that carries it."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..frame import Pose
from ..head.geometry import vertex_normals
from ..head.head import Part
from ..head.parts.tongue import FULL_THRUST, tongue_out
from .accessors import metres
from .targets import Target

TONGUE = "tongue"
TARGET_NAME = "out"


def out_weight(pose: Pose) -> float:
    """Return the weight of "out" for a pose: 1 is `FULL_THRUST`."""
    return pose.tongue_thrust / FULL_THRUST


def out_target(part: Part) -> Target:
    """Return the morph target of a tongue: where it goes as it is put out in full."""
    vertices, normals = posed_tongue(part, Pose(tongue_thrust=FULL_THRUST))
    return {
        "POSITION": metres(vertices - part.vertices),
        "NORMAL": (normals - part.normals).astype(np.float32),
    }


def posed_tongue(part: Part, pose: Pose) -> tuple[FloatArray, FloatArray]:
    """Return vertices [mm] and unit normals, shape (v, 3), of a part as far as a tongue's is out.

    Every part but the tongue comes back as it is.
    """
    weight = out_weight(pose)
    if part.name != TONGUE or weight == 0.0:
        return part.vertices, part.normals
    vertices = part.vertices + weight * tongue_out(part.vertices)
    return vertices, vertex_normals(vertices, part.triangles)
