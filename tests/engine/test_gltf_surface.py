"""The surface file: stream order, the map and the other buffers a stranger draws with."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from small_face import small_rig

from engine.gltf import surface_to_glb
from engine.head.head import LidContact


@pytest.fixture(scope="module")
def rig() -> Any:
    return small_rig()


@pytest.fixture(scope="module")
def glb(rig: Any) -> Glb:
    return Glb(surface_to_glb(rig))


def extras(glb: Glb, node: str) -> dict[str, Any]:
    return glb.json["nodes"][glb.node(node)]["extras"]


def test_tissue_is_in_stream_order(rig: Any, glb: Glb) -> None:
    np.testing.assert_allclose(glb.positions("tissue") * 1000, rig.head.points, atol=1e-4)
    primitive = glb.mesh("tissue")["primitives"][0]
    np.testing.assert_array_equal(
        glb.array(primitive["indices"]).reshape(-1, 3), rig.head.triangles
    )
    assert extras(glb, "tissue")["names"] == list(rig.head.names)
    assert extras(glb, "tissue")["simulated"] == rig.head.sheet_count


def test_stated_map_moves_the_skin_as_the_engine_does(rig: Any, glb: Glb) -> None:
    displacements = np.random.default_rng(1).normal(0, 1, rig.head.points.shape)
    buffers = extras(glb, "skin")["map"]
    indptr, indices, weights = (glb.array(buffers[k]) for k in ("indptr", "indices", "weights"))
    moved = np.stack(
        [
            weights[a:b] @ displacements[indices[a:b]] if b > a else np.zeros(3)
            for a, b in pairwise(indptr)
        ]
    )
    skin = glb.positions("skin") * 1000 + moved
    np.testing.assert_allclose(skin, rig.head.drawn.deform(displacements, ()), atol=1e-3)


def test_stated_lids_push_the_skin_out_of_the_eyes(rig: Any, glb: Glb) -> None:
    displacements = np.tile([0.0, 0.0, -12.0], (len(rig.head.points), 1))
    pushed = rig.head.drawn.deform(displacements, rig.head.eyes)
    free = rig.head.drawn.deform(displacements, ())
    assert np.abs(pushed - free).max() > 1  # else nothing is tested
    lids, eyes = extras(glb, "skin")["lids"], extras(glb, "skin")["eyes"]
    vertices, sides, clearance = (glb.array(lids[k]) for k in ("vertices", "eyes", "clearance"))
    for vertex, side, gap in zip(vertices, sides, clearance, strict=True):
        eye = eyes[side]
        offset = free[vertex] * 1e-3 - eye["center"]
        inner = max(0, 1 - (np.hypot(*offset[:2]) / eye["bulge_radius"]) ** 2)
        least = eye["ball_radius_drawn"] + gap
        least += eye["bulge"] * inner ** eye["bulge_power"] if offset[2] > 0 else 0
        if np.linalg.norm(offset) < least and offset[2] > 0:
            offset *= least / np.linalg.norm(offset)
        seen = (offset + eye["center"]) * 1e3
        np.testing.assert_allclose(seen, pushed[vertex], atol=1e-3)


def test_parts_hang_from_what_they_follow(rig: Any, glb: Glb) -> None:
    for part in rig.head.parts:
        node = {"eye.L": "ball.L", "eye.R": "ball.R"}.get(part.name, part.name)
        np.testing.assert_allclose(glb.positions(node) * 1000, part.vertices, atol=1e-4)
        assert extras(glb, node)["material"] == part.material
    names = [node["name"] for node in glb.json["nodes"]]
    jaw = glb.json["nodes"][glb.node("jaw")]
    assert [names[child] for child in jaw["children"]] == ["teeth.lower"]
    np.testing.assert_allclose(glb.matrix("jaw")[:3, 3] * 1000, rig.jaw.center, atol=1e-4)
    np.testing.assert_allclose(
        glb.matrix("eye.R")[:3, 3] * 1000, rig.head.eyes[1].center, atol=1e-4
    )


def test_strands_name_their_roots(rig: Any, glb: Glb) -> None:
    brows = next(part for part in rig.head.parts if part.name == "brows")
    np.testing.assert_array_equal(glb.array(extras(glb, "brows")["roots"]), brows.roots)


def test_file_says_what_it_is(rig: Any, glb: Glb) -> None:
    asset = glb.json["asset"]
    assert asset["generator"] == "Risorius"
    assert asset["extras"] == {
        "license": "CC0-1.0",
        "rig": rig.id,
        "name": "small",
        "units": "m",
        "rate": 60,
        "grid": 2e-5,
    }
    assert extras(glb, "skin")["landmarks"] == dict(rig.head.landmarks)


def test_khronos_validator_accepts_it(rig: Any, tmp_path: Path) -> None:
    assert_valid(tmp_path, surface=surface_to_glb(rig))


def test_bare_head_has_neither_eyes_nor_lids(rig: Any, tmp_path: Path) -> None:
    """A head read from a file: skin and tissue only."""
    nothing = np.zeros(0, np.int64)
    drawn = replace(rig.head.drawn, lids=LidContact(nothing, nothing, np.zeros(0)))
    bare = small_rig()
    bare.head = replace(rig.head, drawn=drawn, eyes=(), parts=(), landmarks={})
    data = surface_to_glb(bare)
    assert_valid(tmp_path, bare=data)
    assert {node["name"] for node in Glb(data).json["nodes"]} == {
        "risorius",
        "head",
        "skull",
        "jaw",
        "tissue",
        "skin",
    }
    assert "lids" not in extras(Glb(data), "skin")
