"""The baked face: one space, no transforms, everything where the frame has it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from small_face import small_rig
from small_motion import small_frame

from engine.gltf import face_to_glb
from engine.gltf.drawn import DrawnFace
from engine.gltf.pose import motions

RIG = small_rig()
FRAME = small_frame(
    np.random.default_rng(3).normal(0, 1.5, RIG.head.points.shape),
    jaw_pitch=15.0,
    jaw_yaw=-3.0,
    gaze_left=(12.0, -4.0),
    gaze_right=(9.0, -4.0),
    head=(20.0, -5.0, 3.0),
)


@pytest.fixture(scope="module")
def glb() -> Glb:
    return Glb(face_to_glb(RIG, FRAME))


def test_no_node_is_moved(glb: Glb) -> None:
    for node in glb.json["nodes"]:
        assert not {"translation", "rotation", "scale", "matrix"} & set(node)
    assert "animations" not in glb.json
    assert "extensionsUsed" not in glb.json
    for mesh in glb.json["meshes"]:
        assert "targets" not in mesh["primitives"][0]


def test_skin_strands_and_bones_are_posed(glb: Glb) -> None:
    moved = motions(RIG.head, RIG.jaw, FRAME.pose)
    drawn = moved["head"].move(DrawnFace.of(RIG.head).positions(FRAME.displacements))
    seen = np.concatenate([glb.positions("skin"), glb.positions("brows")]) * 1000
    np.testing.assert_allclose(seen, drawn, atol=1e-4)
    for part in RIG.head.parts:
        if part.follows != "skin":
            placed = moved["head"].move(moved[part.follows].move(part.vertices))
            np.testing.assert_allclose(glb.positions(part.name) * 1000, placed, atol=1e-4)


def test_normals_turn_with_the_surface(glb: Glb) -> None:
    """The teeth's normals, all forward at rest, turn with jaw and head."""
    primitive = glb.mesh("teeth.lower")["primitives"][0]
    moved = motions(RIG.head, RIG.jaw, FRAME.pose)
    forward = moved["head"].turn(moved["jaw"].turn(np.array([[0.0, 0.0, 1.0]])))
    normals = glb.array(primitive["attributes"]["NORMAL"])
    np.testing.assert_allclose(normals, np.repeat(forward, len(normals), axis=0), atol=1e-6)


def test_khronos_validator_accepts_it(tmp_path: Path) -> None:
    assert_valid(tmp_path, face=face_to_glb(RIG, FRAME))
