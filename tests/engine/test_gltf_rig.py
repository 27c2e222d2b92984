"""The rig file: every action unit a named morph target, on the skin and on what the jaw carries."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from small_face import small_rig
from small_motion import small_frame

from engine.gltf.drawn import DrawnFace
from engine.gltf.rig import targets_to_glb

NAMES = ("AU1", "AU12", "AU26")


@pytest.fixture(scope="module")
def rig() -> Any:
    return small_rig()


@pytest.fixture(scope="module")
def frames(rig: Any) -> list[Any]:
    random = np.random.default_rng(5)
    shape = rig.head.points.shape
    local = random.normal(0, 2, shape) * (np.arange(shape[0]) < 3)[:, None]
    return [
        small_frame(local),
        small_frame(random.normal(0, 2, shape)),
        small_frame(random.normal(0, 1, shape), jaw_pitch=12.0),
    ]


@pytest.fixture(scope="module")
def data(rig: Any, frames: list[Any]) -> bytes:
    return targets_to_glb(rig, NAMES, frames)


@pytest.fixture(scope="module")
def glb(data: bytes) -> Glb:
    return Glb(data)


def test_every_mesh_with_targets_has_the_same(glb: Glb) -> None:
    for name in ("skin", "teeth.lower"):
        mesh = glb.mesh(name)
        assert mesh["extras"]["targetNames"] == list(NAMES)
        assert mesh["weights"] == [0.0] * len(NAMES)
        for primitive in mesh["primitives"]:
            assert len(primitive["targets"]) == len(NAMES)
    assert "targets" not in glb.mesh("teeth.upper")["primitives"][0]


@pytest.mark.parametrize("unit", range(3))
def test_weight_one_is_the_settled_face(rig: Any, frames: list[Any], glb: Glb, unit: int) -> None:
    seen = glb.positions("skin", weights=np.eye(3)[unit]) * 1000
    expected = DrawnFace.of(rig.head).positions(frames[unit].displacements)
    assert np.linalg.norm(seen - expected, axis=1).max() < 0.005


def test_jaw_unit_moves_the_lower_teeth(rig: Any, frames: list[Any], glb: Glb) -> None:
    (teeth,) = (part for part in rig.head.parts if part.name == "teeth.lower")
    rotation, shift = rig.jaw.transform(12.0)
    moved = (teeth.vertices - rig.jaw.center) @ rotation.T + rig.jaw.center + shift
    seen = glb.positions("teeth.lower", weights=np.array([0, 0, 1.0])) * 1000
    np.testing.assert_allclose(seen, moved, atol=5e-3)
    still = glb.positions("teeth.lower", weights=np.array([1.0, 1, 0])) * 1000
    np.testing.assert_allclose(still, teeth.vertices, atol=1e-4)


def test_local_units_are_stored_sparse(glb: Glb) -> None:
    target = glb.mesh("skin")["primitives"][0]["targets"][0]["POSITION"]
    entry = glb.json["accessors"][target]
    assert "bufferView" not in entry
    assert entry["sparse"]["count"] < entry["count"] / 2


def test_khronos_validator_accepts_it(data: bytes, tmp_path: Path) -> None:
    assert_valid(tmp_path, rig=data)
