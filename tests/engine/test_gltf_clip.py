"""The clip file, read back: positions, nodes, names and the stated error, of a hand-made clip."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid, run_node
from small_motion import small_clip

from engine.errors import Cancelled
from engine.gltf import clip_to_glb
from engine.gltf.clip import DRAWN_SHARE
from engine.gltf.drawn import DrawnFace
from engine.gltf.pose import motions

FRAMES = (0, 7, 20, 33, 39)


@pytest.fixture(scope="module")
def clip() -> Any:
    return small_clip()


@pytest.fixture(scope="module")
def data(clip: Any) -> bytes:
    return clip_to_glb(clip, tolerance=0.02, quantize=False)


@pytest.fixture(scope="module")
def glb(data: bytes) -> Glb:
    return Glb(data)


def expected(clip: Any, frame: int) -> np.ndarray:
    """Skin and strands of a frame in the scene, mm."""
    drawn = DrawnFace.of(clip.rig.head).positions(clip.displacements[frame])
    return motions(clip.rig.head, clip.rig.jaw, clip.poses[frame])["head"].move(drawn)


def seen(glb: Glb, time: float) -> np.ndarray:
    """Skin and strands as the file has them, mm."""
    return 1000 * np.concatenate([glb.positions(name, time=time) for name in ("skin", "brows")])


@pytest.mark.parametrize("frame", FRAMES)
def test_skin_and_strands_are_where_the_engine_has_them(clip: Any, glb: Glb, frame: int) -> None:
    error = np.linalg.norm(seen(glb, frame / clip.fps) - expected(clip, frame), axis=1).max()
    assert error <= 0.02 + 1e-4


def test_stated_error_is_the_true_one(clip: Any, glb: Glb) -> None:
    extras = glb.json["asset"]["extras"]
    errors = [
        np.linalg.norm(seen(glb, frame / clip.fps) - expected(clip, frame), axis=1).max()
        for frame in range(len(clip.poses))
    ]
    assert extras["max_error_mm"] == pytest.approx(max(errors), abs=5e-4)
    assert extras["max_error_mm"] >= max(errors) - 1e-4
    assert extras["tolerance_mm"] == 0.02
    assert (extras["fps"], extras["frames"], extras["rig"]) == (30, 40, clip.rig.id)
    assert extras["basis"] == len(glb.mesh("skin")["extras"]["targetNames"])


@pytest.mark.parametrize("frame", FRAMES)
def test_jaw_node_carries_the_teeth(clip: Any, glb: Glb, frame: int) -> None:
    head, jaw, pose = clip.rig.head, clip.rig.jaw, clip.poses[frame]
    (teeth,) = (part for part in head.parts if part.name == "teeth.lower")
    rotation, shift = jaw.transform(pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)
    moved = (teeth.vertices - jaw.center) @ rotation.T + jaw.center + shift
    moved = motions(head, jaw, pose)["head"].move(moved)
    placed = glb.positions("teeth.lower", time=frame / clip.fps) * 1000
    np.testing.assert_allclose(placed, moved, atol=2e-3)


def test_eyes_turn_to_the_left_and_up(clip: Any, glb: Glb) -> None:
    end = glb.matrix("eye.L", time=39 / 30)
    head = glb.matrix("head", time=39 / 30)
    forward = np.linalg.inv(head[:3, :3]) @ end[:3, :3] @ [0, 0, 1]
    yaw, pitch = np.radians(10), np.radians(5)
    looks = [np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)]
    np.testing.assert_allclose(forward, looks, atol=1e-6)


def test_head_turns_about_the_neck(clip: Any, glb: Glb) -> None:
    matrix = glb.matrix("head", time=39 / 30)
    np.testing.assert_allclose(matrix[:3, 3], [0, -0.09, -0.01], atol=1e-7)
    left, up, forward = matrix[:3, 0], matrix[:3, 1], matrix[:3, 2]
    assert forward[0] > 0.4  # turned to its left
    assert forward[1] == pytest.approx(np.sin(np.radians(10)), abs=1e-6)  # looks up
    assert left[1] > 0.1  # rolled away from the left shoulder: roll is -8
    assert up[1] > 0.9


def test_nodes_that_stay_still_are_not_animated(clip: Any, glb: Glb) -> None:
    (animation,) = glb.json["animations"]
    moved = {
        (glb.json["nodes"][channel["target"]["node"]]["name"], channel["target"]["path"])
        for channel in animation["channels"]
    }
    assert moved == {
        ("skin", "weights"),
        ("brows", "weights"),
        ("head", "rotation"),
        ("jaw", "rotation"),
        ("jaw", "translation"),
        ("eye.L", "rotation"),
    }


def test_animation_has_a_key_per_frame(clip: Any, glb: Glb) -> None:
    (animation,) = glb.json["animations"]
    assert animation["name"] == "performance"
    for sampler in animation["samplers"]:
        times = glb.json["accessors"][sampler["input"]]
        np.testing.assert_allclose(glb.array(sampler["input"]), np.arange(40) / 30, atol=1e-6)
        assert times["min"] == [0.0]
        assert times["max"] == [np.float32(39 / 30)]
        assert sampler["interpolation"] == "LINEAR"


def test_bounds_are_those_of_the_data(glb: Glb) -> None:
    for mesh in glb.json["meshes"]:
        for primitive in mesh["primitives"]:
            attributes = [primitive["attributes"], *primitive.get("targets", [])]
            for accessor in {entry["POSITION"] for entry in attributes}:
                stated, values = glb.json["accessors"][accessor], glb.array(accessor)
                np.testing.assert_array_equal(stated["min"], values.min(axis=0))
                np.testing.assert_array_equal(stated["max"], values.max(axis=0))


def test_same_clip_gives_the_same_bytes(clip: Any, data: bytes) -> None:
    assert clip_to_glb(small_clip(), tolerance=0.02, quantize=False) == data


def test_motion_that_is_too_large_to_hold_gives_the_same_file(
    clip: Any, data: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("engine.gltf.motion.BYTES_IN_MEMORY", 0)
    assert clip_to_glb(clip, tolerance=0.02, quantize=False) == data


def test_still_clip_still_has_an_animation(clip: Any, tmp_path: Path) -> None:
    still = small_clip()
    still.displacements[:] = 0
    still.poses = still.poses[:1] * len(still.poses)
    file = clip_to_glb(still)
    (animation,) = Glb(file).json["animations"]
    assert [c["target"]["path"] for c in animation["channels"]] == ["weights"]
    assert_valid(tmp_path, still=file)


def test_khronos_validator_accepts_it(data: bytes, tmp_path: Path) -> None:
    assert_valid(tmp_path, clip=data)


def test_three_plays_it(clip: Any, data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "clip.glb"
    path.write_bytes(data)
    frame, vertex = 20, 31
    (report,) = run_node(
        "play_glb.mjs", str(path), str(frame / clip.fps), str(vertex), needs="three"
    )
    np.testing.assert_allclose(
        np.array(report["skin"]) * 1000, expected(clip, frame)[vertex], atol=0.03
    )
    assert report["animation"] == "performance"
    teeth = Glb(data).positions("teeth.lower", time=frame / clip.fps)[0]
    np.testing.assert_allclose(report["teeth.lower"], teeth, atol=1e-6)


def test_writing_says_how_far_it_is(clip: Any, data: bytes) -> None:
    shares: list[float] = []
    assert clip_to_glb(clip, tolerance=0.02, quantize=False, progress=shares.append) == data
    assert shares == sorted(shares)
    assert shares[0] < 1.0
    assert shares[-1] == 1.0


def test_drawing_can_be_stopped(clip: Any) -> None:
    shares: list[float] = []
    with pytest.raises(Cancelled, match="stopped"):
        clip_to_glb(clip, progress=shares.append, cancelled=lambda: True)
    assert not shares


def test_the_search_for_shapes_can_be_stopped(clip: Any) -> None:
    shares = [0.0]
    with pytest.raises(Cancelled, match="stopped"):
        clip_to_glb(clip, progress=shares.append, cancelled=lambda: shares[-1] > 0.0)
    assert shares[-1] == DRAWN_SHARE


def test_frames_of_a_sleeping_face_are_one(clip: Any) -> None:
    still = small_clip()
    still.displacements[:] = still.displacements[[7] * 10 + [20] * 10 + [7] * 20]
    glb = Glb(clip_to_glb(still, form="exact"))
    assert len(glb.mesh("skin")["extras"]["targetNames"]) == 3
    shown = [glb.animated("skin", "weights", frame / 30).argmax() for frame in range(40)]
    assert shown == [0] * 10 + [1] * 10 + [2] * 20
