"""Blender imports every form of a clip: named shape keys, the right length, the right places.

PyPI's bpy wants an older numpy than ours, so it has an environment of its own; where
RISORIUS_BLENDER_PYTHON names its interpreter, Blender is asked.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from recorded import FPS, standard_clip

from engine.arkit import arkit_table
from engine.clip import Clip
from engine.gltf import clip_to_glb
from engine.gltf.clip import FORMS

SECONDS = 0.5
PYTHON = os.environ.get("RISORIUS_BLENDER_PYTHON", "")
HOW = (
    "Blender is not here: python3.11 -m venv blender && blender/bin/pip install bpy, then "
    "RISORIUS_BLENDER_PYTHON=blender/bin/python"
)
pytestmark = pytest.mark.skipif(not PYTHON, reason=HOW)
STORED = {"grid": {}, "plain": {"quantize": False, "sparse": False}}


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    played = standard_clip()
    rig = played.rig.at_level("medium")
    clip = Clip(rig, FPS, played.displacements, played.poses, played.activations)
    return {
        f"{form}-{name}": clip_to_glb(clip, form=form, **stored)
        for form in FORMS
        for name, stored in STORED.items()
    }


@pytest.fixture(scope="module")
def imported(files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("blender")
    paths = []
    for name, data in files.items():
        path = folder / f"{name}.glb"
        path.write_bytes(data)
        paths.append(str(path))
    script = str(Path(__file__).with_name("import_in_blender.py"))
    report = folder / "report.json"
    command = [PYTHON, script, str(report), str(SECONDS), *paths]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert ran.returncode == 0, ran.stdout[-2000:] + ran.stderr[-2000:]
    return {Path(each["path"]).stem: each for each in json.loads(report.read_text())}


NAMES = [f"{form}-{name}" for form in FORMS for name in STORED]


@pytest.mark.parametrize("name", NAMES)
def test_shape_keys_have_the_names_of_the_targets(
    name: str, files: dict[str, bytes], imported: dict[str, Any]
) -> None:
    glb, meshes = Glb(files[name]), imported[name]["meshes"]
    for node in ("skin", "brows", "lashes", "tongue"):
        assert meshes[node]["keys"] == ["Basis", *glb.mesh(node)["extras"]["targetNames"]]
    if name.startswith("arkit"):
        assert meshes["ball.L"]["keys"][1:] == list(arkit_table().shapes)


@pytest.mark.parametrize("name", NAMES)
def test_the_animation_is_as_long_as_the_clip(name: str, imported: dict[str, Any]) -> None:
    actions, fps = imported[name]["actions"], imported[name]["fps"]
    assert actions
    assert any("performance" in action for action in actions)
    assert max(last for _, last in actions.values()) / fps == pytest.approx(
        standard_clip().duration, abs=0.5 / fps
    )


@pytest.mark.parametrize("name", NAMES)
def test_vertices_are_where_the_file_has_them(
    name: str, files: dict[str, bytes], imported: dict[str, Any]
) -> None:
    glb, meshes = Glb(files[name]), imported[name]["meshes"]
    for node in ("skin", "brows", "lashes", "teeth.lower", "ball.L"):
        seen = np.array(meshes[node]["places"])
        expected = glb.positions(node, time=SECONDS)
        assert np.linalg.norm(seen - expected, axis=1).max() < 5e-5, node
