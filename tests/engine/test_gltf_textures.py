"""Files with their maps in them: which material shows which, and what vertices leave out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from glb_tools import assert_valid
from small_motion import small_clip, small_frame
from small_textures import small_textures, textured_rig

from engine.gltf import clip_to_glb, face_to_glb, surface_to_glb, targets_to_glb

RIG = textured_rig()
FRAME = small_frame(np.zeros_like(RIG.head.points), jaw_pitch=10.0)
CLIP = SimpleNamespace(**{**vars(small_clip(6)), "rig": RIG})
WRITERS: dict[str, Callable[[Any], bytes]] = {
    "face": lambda maps: face_to_glb(RIG, FRAME, textures=maps),
    "rig": lambda maps: targets_to_glb(RIG, ("AU26",), [FRAME], textures=maps),
    "clip": lambda maps: clip_to_glb(CLIP, textures=maps),
}
BALLS = {"face": "eye.L", "rig": "ball.L", "clip": "ball.L"}


def first(glb: Glb, node: str) -> dict[str, Any]:
    primitive: dict[str, Any] = glb.mesh(node)["primitives"][0]
    return primitive


def image(glb: Glb, texture: dict[str, int]) -> bytes:
    source = glb.json["images"][glb.json["textures"][texture["index"]]["source"]]
    assert source["mimeType"] == "image/jpeg"
    return glb.buffer(source["bufferView"])


@pytest.mark.parametrize("kind", WRITERS)
def test_the_skin_shows_its_maps(kind: str) -> None:
    maps = small_textures()
    glb = Glb(WRITERS[kind](maps))
    skin = glb.json["materials"][first(glb, "skin")["material"]]
    shading = skin["pbrMetallicRoughness"]
    assert image(glb, shading["baseColorTexture"]) == maps["albedo.jpg"]
    assert image(glb, skin["normalTexture"]) == maps["normal.jpg"]
    assert image(glb, skin["occlusionTexture"]) == maps["orm.jpg"]
    assert shading["metallicRoughnessTexture"]["index"] == skin["occlusionTexture"]["index"]
    assert (shading["metallicFactor"], shading["roughnessFactor"]) == (0.0, 1.0)
    eye = glb.json["materials"][first(glb, BALLS[kind])["material"]]
    assert image(glb, eye["pbrMetallicRoughness"]["baseColorTexture"]) == maps["eye.jpg"]
    # Wrinkles move, so a file that knows no gauges has no use for their map.
    assert len(glb.json["images"]) == len(maps) - 1


@pytest.mark.parametrize("kind", WRITERS)
def test_vertices_with_a_map_have_no_colour_of_their_own(kind: str) -> None:
    glb = Glb(WRITERS[kind](small_textures()))
    for node in ("skin", BALLS[kind]):
        assert "COLOR_0" not in first(glb, node)["attributes"]
        assert "TEXCOORD_0" in first(glb, node)["attributes"]
    assert "COLOR_0" in first(glb, "teeth.upper")["attributes"]


@pytest.mark.parametrize("kind", WRITERS)
def test_files_without_maps_have_colours(kind: str) -> None:
    glb = Glb(WRITERS[kind](None))
    assert "COLOR_0" in first(glb, "skin")["attributes"]
    assert "COLOR_0" in first(glb, BALLS[kind])["attributes"]
    assert "images" not in glb.json


def test_a_head_that_is_not_laid_out_keeps_its_colours() -> None:
    clip = small_clip(6)
    glb = Glb(clip_to_glb(clip, textures=small_textures()))
    assert "COLOR_0" in first(glb, "skin")["attributes"]
    assert "images" not in glb.json


def test_khronos_validator_accepts_each(tmp_path: Path) -> None:
    files = {kind: write(small_textures()) for kind, write in WRITERS.items()}
    bare = {f"bare-{kind}": write(None) for kind, write in WRITERS.items()}
    assert_valid(tmp_path, surface=surface_to_glb(RIG), **files, **bare)
