"""Every form of a clip's file, stored in every way: valid, and played by three.js as simulated."""

from __future__ import annotations

import itertools
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid, run_node
from recorded import FPS, standard_clip
from small_motion import small_clip
from small_textures import small_textures

from engine.arkit import arkit_table
from engine.clip import Clip, record
from engine.errors import InvalidValue, UnknownName
from engine.gltf import clip_to_glb
from engine.gltf.clip import FORMS
from engine.gltf.drawn import DrawnFace
from engine.gltf.lighter import lighter
from engine.gltf.packing import packed_normals
from engine.gltf.pose import motions
from engine.rig import builtin_rig
from engine.timeline import Keyframe, Timeline

STRIDE = 11
TOLERANCE = 0.1
TIMES = [frame / FPS for frame in range(1, 21)]
STORED = list(itertools.product((False, True), (False, True)))


@lru_cache(maxsize=1)
def clip() -> Clip:
    """The recorded performance, at the level that clips have."""
    played = standard_clip()
    return Clip(
        played.rig.at_level("medium"),
        played.fps,
        played.displacements,
        played.poses,
        played.activations,
    )


@lru_cache(maxsize=16)
def written(form: str, quantize: bool, sparse: bool) -> bytes:
    return clip_to_glb(clip(), form=form, quantize=quantize, sparse=sparse)


def simulated(frame: int) -> dict[str, np.ndarray]:
    """Where skin, strands and lower teeth are in the scene, mm, by node."""
    rig = clip().rig
    parts = [lighter(part, "medium") for part in rig.head.parts]
    riding = [part for part in parts if part.follows == "skin"]
    face = DrawnFace.of(rig.head)
    light = DrawnFace(face.head, tuple(riding), face.skin_normals, face.rest_normals)
    drawn = light.positions(clip().displacements[frame])
    moved = motions(rig.head, rig.jaw, clip().poses[frame])
    names = ["skin", *(part.name for part in riding)]
    found = {name: drawn[piece] for name, piece in zip(names, light.pieces(), strict=True)}
    for part in parts:
        if part.name in ("teeth.lower", "eye.L"):
            found[part.name.replace("eye", "ball")] = moved[part.follows].move(part.vertices)
    return {name: moved["head"].move(points) for name, points in found.items()}


@pytest.mark.parametrize(("quantize", "sparse"), STORED)
@pytest.mark.parametrize("form", FORMS)
def test_khronos_validator_accepts_it(
    form: str, quantize: bool, sparse: bool, tmp_path: Path
) -> None:
    bare = written(form, quantize, sparse)
    short = clip().after(0.8)
    maps = clip_to_glb(
        short, form=form, quantize=quantize, sparse=sparse, textures=small_textures()
    )
    assert_valid(tmp_path, bare=bare, maps=maps)


def played(data: bytes, folder: Path) -> list[dict[str, np.ndarray]]:
    """Where three.js has every eleventh vertex of each mesh, mm, at 20 times."""
    (folder / "clip.glb").write_bytes(data)
    times = [str(time) for time in TIMES]
    frames = run_node("play_frames.mjs", str(folder / "clip.glb"), *times, needs="three")
    assert {frame["name"] for frame in frames} == {"performance"}
    for frame in frames:
        assert frame["duration"] == pytest.approx(clip().duration)
    return [
        {name: 1000 * np.array(points) for name, points in frame["meshes"].items()}
        for frame in frames
    ]


def farthest(seen: dict[str, np.ndarray], name: str, points: np.ndarray) -> float:
    """Return the largest distance of a mesh's vertices from where they should be, mm."""
    # three.js leaves dots out of names.
    return float(np.linalg.norm(seen[name.replace(".", "")] - points[::STRIDE], axis=1).max())


@pytest.mark.parametrize(("quantize", "sparse"), STORED)
@pytest.mark.parametrize("form", ["basis", "exact"])
def test_three_plays_what_was_simulated(
    form: str, quantize: bool, sparse: bool, tmp_path: Path
) -> None:
    data = written(form, quantize, sparse)
    stated = Glb(data).json["asset"]["extras"]["max_error_mm"]
    assert stated <= (TOLERANCE if form == "basis" else 0.02)
    for frame, seen in enumerate(played(data, tmp_path), start=1):
        for name, points in simulated(frame).items():
            rigid = name in ("teeth.lower", "ball.L")
            assert farthest(seen, name, points) <= (0.01 if rigid else stated), name


@pytest.mark.parametrize(("quantize", "sparse"), STORED)
def test_three_plays_arkit_s_shapes(quantize: bool, sparse: bool, tmp_path: Path) -> None:
    data = written("arkit", quantize, sparse)
    glb = Glb(data)
    stated = glb.json["asset"]["extras"]["residual_mm"]["max"]
    for frame, seen in enumerate(played(data, tmp_path), start=1):
        assert farthest(seen, "skin", simulated(frame)["skin"]) <= stated + 0.02
        for name in ("skin", "brows", "teeth.lower", "ball.L"):
            in_file = 1000 * glb.positions(name, time=frame / FPS)
            assert farthest(seen, name, in_file) < 0.01, name


@pytest.mark.parametrize("form", FORMS)
def test_all_ways_of_storing_say_the_same(form: str) -> None:
    files = [Glb(written(form, *stored)) for stored in STORED]
    for time in (0.25, 0.75):
        places = [glb.positions("skin", time=time) for glb in files]
        for other in places[1:]:
            assert np.abs(other - places[0]).max() < 1.5e-4
    sizes = {stored: len(written(form, *stored)) for stored in STORED}
    assert sizes[True, True] < sizes[False, True] < sizes[False, False]
    assert sizes[True, True] < sizes[True, False] < sizes[False, False]


@pytest.mark.parametrize(("quantize", "sparse"), STORED)
@pytest.mark.parametrize("form", FORMS)
def test_every_weight_is_from_0_to_1(form: str, quantize: bool, sparse: bool) -> None:
    glb = Glb(written(form, quantize, sparse))
    (animation,) = glb.json["animations"]
    moved = [
        each["target"] for each in animation["channels"] if each["target"]["path"] == "weights"
    ]
    assert moved
    for target in moved:
        name = glb.json["nodes"][target["node"]]["name"]
        weights = np.array([glb.animated(name, "weights", frame / FPS) for frame in range(25)])
        assert weights.min() >= 0.0
        assert weights.max() <= 1.0
        assert not np.any(glb.mesh(name)["weights"])


@pytest.mark.parametrize(("quantize", "sparse"), STORED)
def test_a_file_uses_what_was_asked_for(quantize: bool, sparse: bool) -> None:
    document = Glb(written("basis", quantize, sparse)).json
    assert ("extensionsRequired" in document) == quantize
    assert any("sparse" in accessor for accessor in document["accessors"]) == sparse


def test_arkit_s_shapes_are_all_there_by_name_and_move_what_has_them() -> None:
    glb = Glb(written("arkit", True, True))
    names = list(arkit_table().shapes)
    for node in ("skin", "brows", "lashes", "teeth.lower", "tongue", "ball.L", "ball.R"):
        assert glb.mesh(node)["extras"]["targetNames"] == names
        weights = glb.animated(node, "weights", 0.5)
        assert weights is not None
        assert weights.min() >= 0.0
        assert weights.max() <= 1.0
    (animation,) = glb.json["animations"]
    moved = {
        (glb.json["nodes"][each["target"]["node"]]["name"], each["target"]["path"])
        for each in animation["channels"]
    }
    assert ("head", "rotation") in moved
    assert not {name for name, path in moved if path != "weights"} - {"head"}


@pytest.mark.parametrize("name", ["jawOpen", "mouthSmileLeft", "eyeLookUpLeft", "browInnerUp"])
def test_a_shape_that_was_played_is_found_again(name: str) -> None:
    rig = builtin_rig("standard").at_level("low")
    keyframe = Keyframe(**_played(name))
    settled = record(rig, Timeline((keyframe,), 1.0), fps=10)
    glb = Glb(clip_to_glb(settled, form="arkit"))
    weights = glb.animated("skin", "weights", 1.0)
    assert weights is not None
    found = dict(zip(arkit_table().shapes, weights, strict=True))
    # Both eyes have one pitch, which the two shapes of it share.
    own = [name, "eyeLookUpRight"] if name == "eyeLookUpLeft" else [name]
    assert sum(found[each] for each in own) > 0.8
    assert max(weight for each, weight in found.items() if each not in own) < 0.35
    face = DrawnFace.of(rig.head)
    drawn = face.skin(settled.displacements[-1])
    error = np.linalg.norm(1000 * glb.positions("skin", time=1.0) - drawn, axis=1)
    assert np.sqrt((error**2).mean()) < 0.1


def _played(name: str) -> dict[str, Any]:
    timeline = Timeline.from_json({"timeline": [{"time": 0.0, "arkit": {name: 1.0}, "fade": 0.1}]})
    (keyframe,) = timeline.keyframes
    return {
        field: getattr(keyframe, field) for field in ("action_units", "jaw", "gaze", "head", "fade")
    }


def test_the_stated_residual_is_the_true_one() -> None:
    glb = Glb(written("arkit", False, True))
    errors = []
    for frame in range(len(clip())):
        seen = glb.positions("skin", time=frame / FPS) * 1000
        errors.append(np.linalg.norm(seen - simulated(frame)["skin"], axis=1))
    stated = glb.json["asset"]["extras"]["residual_mm"]
    assert stated["max"] == pytest.approx(np.max(errors), abs=0.02)
    assert stated["max"] > 0.2  # Tissue does not add up along straight lines.


@pytest.mark.parametrize("tolerance", [0.02, 0.1, 0.5])
@pytest.mark.parametrize("quantize", [False, True])
def test_tolerance_is_kept_and_read_back(tolerance: float, quantize: bool) -> None:
    data = clip_to_glb(clip(), tolerance=tolerance, quantize=quantize)
    extras = Glb(data).json["asset"]["extras"]
    assert extras["tolerance_mm"] == tolerance
    assert extras["max_error_mm"] <= tolerance
    errors = [
        np.linalg.norm(
            1000 * Glb(data).positions("skin", time=frame / FPS) - simulated(frame)["skin"], axis=1
        ).max()
        for frame in (5, 9, 14, 20)
    ]
    assert max(errors) <= extras["max_error_mm"]


def test_normals_turn_with_the_skin() -> None:
    """The exact form's normals are those of the drawn skin, and the basis' are near them."""
    face = DrawnFace.of(clip().rig.head)
    for form, quantize, most in (("exact", False, 0.5), ("exact", True, 1.5), ("basis", True, 3.0)):
        glb = Glb(written(form, quantize, True))
        primitive = glb.mesh("skin")["primitives"][0]
        for frame in (9, 20):
            normals = glb.array(primitive["attributes"]["NORMAL"]).astype(float)
            weights = glb.animated("skin", "weights", frame / FPS)
            assert weights is not None
            for weight, target in zip(weights, primitive["targets"], strict=True):
                normals = normals + weight * glb.array(target["NORMAL"])
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            change = face.normal_change(face.skin(clip().displacements[frame]))
            wanted = clip().rig.head.drawn.normals + change
            wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
            cosine = np.einsum("ij,ij->i", normals, wanted).clip(-1, 1)
            assert np.degrees(np.arccos(np.quantile(cosine, 0.01))) < most, (form, quantize)


def test_quantised_normals_count_as_unit() -> None:
    normals = np.random.default_rng(3).normal(0, 1, (20_000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    stored = packed_normals(normals) / 127
    assert np.abs(np.linalg.norm(stored, axis=1) - 1).max() < 0.0067
    assert np.einsum("ij,ij->i", stored, normals).min() > 0.99


def test_what_cannot_be_written_is_refused() -> None:
    with pytest.raises(UnknownName, match="usdz"):
        clip_to_glb(small_clip(4), form="usdz")
    for tolerance in (0.0, -1.0, 1e9, float("nan")):
        with pytest.raises(InvalidValue, match="tolerance"):
            clip_to_glb(small_clip(4), tolerance=tolerance)
    with pytest.raises(InvalidValue, match="exact"):
        clip_to_glb(small_clip(1000), form="exact")
