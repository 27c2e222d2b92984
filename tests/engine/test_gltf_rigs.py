"""Every kind of file of the built-in rigs, read back against the simulator."""

from __future__ import annotations

import io
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
import trimesh
from glb_reader import Glb
from glb_tools import assert_valid, run_node
from recorded import FPS, standard_clip
from small_textures import small_textures

from engine.clip import record
from engine.gltf import clip_to_glb, face_to_glb, rig_to_glb, surface_to_glb
from engine.gltf.drawn import DrawnFace
from engine.gltf.pose import motions
from engine.rig import builtin_rig
from engine.settling import settled_units
from engine.simulator import Simulator
from engine.textures import texture_names
from engine.timeline import Keyframe, Timeline

FRAMES = (0, 3, 9, 14, 19, FPS)


@lru_cache(maxsize=1)
def clip_bytes() -> bytes:
    return clip_to_glb(standard_clip())


@pytest.fixture(scope="module")
def glb() -> Glb:
    return Glb(clip_bytes())


@pytest.fixture(scope="module")
def face() -> DrawnFace:
    return DrawnFace.of(standard_clip().rig.head)


@pytest.mark.parametrize("frame", FRAMES)
def test_clip_is_where_the_simulator_was(glb: Glb, face: DrawnFace, frame: int) -> None:
    clip = standard_clip()
    moved = motions(clip.rig.head, clip.rig.jaw, clip.poses[frame])["head"]
    drawn = moved.move(face.positions(clip.displacements[frame]))
    names = ["skin", *(part.name for part in face.strands)]
    seen = 1000 * np.concatenate([glb.positions(name, time=frame / FPS) for name in names])
    assert np.linalg.norm(seen - drawn, axis=1).max() <= 0.1


def test_clip_states_its_true_error(glb: Glb, face: DrawnFace) -> None:
    clip, extras = standard_clip(), glb.json["asset"]["extras"]
    errors = []
    for frame, displacements in enumerate(clip.displacements):
        moved = motions(clip.rig.head, clip.rig.jaw, clip.poses[frame])["head"]
        seen = glb.positions("skin", time=frame / FPS) * 1000
        errors.append(np.linalg.norm(seen - moved.move(face.skin(displacements)), axis=1).max())
    assert max(errors) <= extras["max_error_mm"] <= extras["tolerance_mm"]
    names = glb.mesh("skin")["extras"]["targetNames"]
    assert extras["basis"] == extras["shapes"]["skin"] == len(names) < len(clip)


@pytest.mark.parametrize("frame", FRAMES)
def test_clip_turns_the_jaw_as_the_hinge_does(glb: Glb, frame: int) -> None:
    clip = standard_clip()
    pose, jaw = clip.poses[frame], clip.rig.jaw
    rotation, shift = jaw.transform(pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)
    head = glb.matrix("head", time=frame / FPS)
    local = np.linalg.inv(head) @ glb.matrix("jaw", time=frame / FPS)
    np.testing.assert_allclose(local[:3, :3], rotation, atol=1e-6)
    neck = np.array([0.0, -90.0, -10.0])
    np.testing.assert_allclose(local[:3, 3] * 1000, jaw.center + shift - neck, atol=1e-3)


def test_clip_is_the_same_bytes_again() -> None:
    assert clip_to_glb(standard_clip()) == clip_bytes()


def test_three_sees_the_mouth_corner_where_the_engine_has_it(
    face: DrawnFace, tmp_path: Path
) -> None:
    clip, frame = standard_clip(), 14
    (tmp_path / "clip.glb").write_bytes(clip_bytes())
    corner = clip.rig.head.landmarks["ch.L"]
    arguments = (str(tmp_path / "clip.glb"), str(frame / FPS), str(corner))
    (report,) = run_node("play_glb.mjs", *arguments, needs="three")
    moved = motions(clip.rig.head, clip.rig.jaw, clip.poses[frame])["head"]
    drawn = moved.move(face.positions(clip.displacements[frame]))[corner]
    rest = face.rest_positions()[corner]
    assert np.linalg.norm(drawn - rest) > 3  # else nothing is tested
    np.testing.assert_allclose(np.array(report["skin"]) * 1000, drawn, atol=0.06)


def test_action_units_are_named_targets_that_lead_to_the_settled_faces(face: DrawnFace) -> None:
    rig = builtin_rig("standard")
    glb = Glb(rig_to_glb(rig))
    names = list(rig.action_units)
    for node in ("skin", "teeth.lower", "gum.lower", "tongue"):
        assert glb.mesh(node)["extras"]["targetNames"] == names
    frames = dict(zip(names, settled_units(rig), strict=True))
    for name in ("AU1", "AU12", "AU26"):
        weights = np.array([float(other == name) for other in names])
        seen = glb.positions("skin", weights=weights) * 1000
        drawn = face.positions(frames[name].displacements)
        assert np.linalg.norm(seen - drawn, axis=1).max() < 0.01
    opened = glb.positions("teeth.lower", weights=weights) - glb.positions("teeth.lower")
    assert opened[:, 1].mean() < -0.005  # AU26 drops the teeth


def test_trimesh_opens_a_face_that_is_a_head_in_metres() -> None:
    rig = builtin_rig("standard")
    scene = trimesh.load(io.BytesIO(face_to_glb(rig, settled_units(rig)[0])), file_type="glb")
    low, high = scene.bounds
    np.testing.assert_allclose(high - low, [0.17, 0.30, 0.22], atol=0.04)
    assert set(scene.geometry) >= {"skin", "teeth.lower", "brows"}
    assert scene.geometry["skin"].is_winding_consistent


@pytest.mark.parametrize("name", ["standard", "paper"])
def test_khronos_validator_accepts_all_kinds(name: str, tmp_path: Path) -> None:
    rig = builtin_rig(name)
    simulator = Simulator(rig)
    simulator.add("face")
    command = Keyframe(action_units={"AU12": 1.0}, jaw={"pitch": 15.0}, head={"yaw": 20.0})
    simulator.apply("face", command)
    for _ in range(12):
        simulator.step()
    clip = record(rig, Timeline((command,), duration=0.3), fps=30)
    maps = small_textures() if texture_names(rig) else None
    face = simulator.frame("face")
    assert_valid(
        tmp_path,
        surface=surface_to_glb(rig),
        rig=rig_to_glb(rig, textures=maps),
        face=face_to_glb(rig, face, textures=maps),
        bare=face_to_glb(rig, face),
        clip=clip_to_glb(clip, textures=maps),
    )
