"""The rig file with ARKit's shapes: their names, and each the face that its weight leads to."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from small_face import small_rig
from small_motion import small_frame

from engine import Rig, Timeline, arkit_table, arkit_to_glb, builtin_rig, record
from engine.arrays import FloatArray
from engine.gltf.drawn import DrawnFace
from engine.gltf.pose import motions

NAMES = list(arkit_table().shapes)
MOVED = ("skin", "teeth.lower", "tongue", "ball.L", "ball.R")


@pytest.fixture(scope="module")
def rig() -> Rig:
    return builtin_rig("standard").at_level("low")


@pytest.fixture(scope="module")
def data(rig: Rig) -> bytes:
    return arkit_to_glb(rig)


@pytest.fixture(scope="module")
def glb(data: bytes) -> Glb:
    return Glb(data)


def way(glb: Glb, node: str, shape: str) -> FloatArray:
    """Return where a shape at weight 1 moves a node's vertices, mm."""
    primitives = glb.mesh(node)["primitives"]
    targets = [primitive["targets"][NAMES.index(shape)] for primitive in primitives]
    return 1000.0 * np.concatenate([glb.array(target["POSITION"]) for target in targets])


def test_every_mesh_that_moves_has_arkit_s_names(glb: Glb) -> None:
    assert len(NAMES) == 52
    for node in MOVED:
        assert glb.mesh(node)["extras"]["targetNames"] == NAMES
        for primitive in glb.mesh(node)["primitives"]:
            assert len(primitive["targets"]) == 52
    assert "targets" not in glb.mesh("teeth.upper")["primitives"][0]


def test_the_file_says_what_it_cannot(glb: Glb) -> None:
    extras = glb.json["asset"]["extras"]
    assert extras["arkit"] == arkit_table().version
    assert "still" not in extras  # Lists that are empty are not written.
    assert set(extras["stands_in"]) == {"mouthClose", "mouthLeft", "mouthRight"}


@pytest.mark.parametrize("name", NAMES)
def test_every_shape_moves_something(glb: Glb, name: str) -> None:
    assert max(np.abs(way(glb, node, name)).max() for node in MOVED) > 0.3


@pytest.mark.parametrize(
    "name", ["mouthSmile", "mouthFrown", "browDown", "eyeBlink", "cheekSquint", "noseSneer"]
)
def test_a_side_moves_its_own(glb: Glb, name: str) -> None:
    across = glb.positions("skin")[:, 0]
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        moved = np.linalg.norm(way(glb, "skin", name + side), axis=1)
        own, other = moved[sign * across > 0.0], moved[sign * across < 0.0]
        assert own.sum() > 3.0 * other.sum()
        assert own.max() > 1.0


def test_gaze_turns_the_eyes_and_jaw_the_teeth(glb: Glb) -> None:
    for node in ("ball.L", "ball.R"):
        front = glb.positions(node)[:, 2] > np.quantile(glb.positions(node)[:, 2], 0.95)
        assert way(glb, node, "eyeLookUpLeft")[front, 1].mean() > 1.5
        assert not way(glb, node, "jawOpen").any()
    inwards = way(glb, "ball.L", "eyeLookInLeft")
    assert inwards[:, 0].min() < -4.0
    assert np.abs(way(glb, "ball.R", "eyeLookInLeft")).max() < 0.2
    assert way(glb, "teeth.lower", "jawOpen")[:, 1].mean() < -10.0
    assert way(glb, "tongue", "jawOpen")[:, 1].mean() < -5.0
    assert way(glb, "tongue", "tongueOut")[:, 2].max() > 20.0


@pytest.mark.parametrize("name", ["mouthSmileLeft", "jawOpen", "eyeLookUpRight"])
def test_weight_one_is_where_the_weight_leads_to(rig: Rig, glb: Glb, name: str) -> None:
    weight = [{"time": 0.0, "arkit": {name: 1.0}, "fade": 0.1}]
    timeline = Timeline.from_json({"timeline": weight, "duration": 1.2})
    clip = record(rig, timeline, fps=10)
    face, pose = DrawnFace.of(rig.head), clip.poses[-1]
    drawn = face.positions(clip.displacements[-1]) - face.rest_positions()
    assert np.linalg.norm(way(glb, "skin", name) - drawn, axis=1).max() < 0.2
    moved = motions(rig.head, rig.jaw, pose)
    for node in ("teeth.lower", "ball.R"):
        part = next(p for p in rig.head.parts if p.name == node.replace("ball", "eye"))
        carried = moved[part.follows].move(part.vertices) - part.vertices
        assert np.abs(way(glb, node, name) - carried).max() < 0.05


def test_a_shape_that_a_rig_cannot_do_is_there_and_named(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = small_rig()
    table = arkit_table()
    two = replace(table, shapes={name: table.shapes[name] for name in ("tongueOut", "jawOpen")})
    unmoved = np.zeros(rig.head.points.shape)
    # This head has no tongue.
    frames = [small_frame(unmoved, tongue_thrust=40.0), small_frame(unmoved, jaw_pitch=12.0)]
    monkeypatch.setattr("engine.gltf.rig.arkit_table", lambda: two)
    monkeypatch.setattr("engine.gltf.rig.settled_arkit", lambda _rig, progress=None: frames)
    glb = Glb(arkit_to_glb(rig))
    assert glb.json["asset"]["extras"]["still"] == ["tongueOut"]
    assert glb.mesh("skin")["extras"]["targetNames"] == ["tongueOut", "jawOpen"]
    still = glb.positions("skin", weights=np.array([1.0, 0.0]))
    np.testing.assert_array_equal(still, glb.positions("skin"))


def test_khronos_validator_accepts_it(data: bytes, tmp_path: Path) -> None:
    assert_valid(tmp_path, arkit=data)
