"""The tissue file: four sheets under each other, and every spring once, by kind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from glb_reader import Glb
from glb_tools import assert_valid

from engine import builtin_rig
from engine.gltf import tissue_to_glb
from engine.tissue import assemble


def test_sheets_and_springs_are_those_of_the_model(tmp_path: Path) -> None:
    rig = builtin_rig("standard")
    data = tissue_to_glb(rig)
    assert_valid(tmp_path, tissue=data)
    glb, model = Glb(data), assemble(rig.head, rig.parameters, literal_springs=False)
    n = model.node_count
    for sheet, name in enumerate(("epidermis", "dermis", "hypodermis")):
        rest = model.layers.nodes[sheet * n : (sheet + 1) * n]
        np.testing.assert_allclose(glb.positions(name) * 1000, rest, atol=1e-4)
    np.testing.assert_allclose(glb.positions("bone") * 1000, model.layers.bone, atol=1e-4)
    (bone,) = (mesh for mesh in glb.json["meshes"] if mesh["name"] == "bone")
    (primitive,) = bone["primitives"]
    rides = glb.array(primitive["attributes"]["_JAW"])
    np.testing.assert_allclose(rides, rig.head.jaw_weight[:n], atol=1e-6)
    told: dict[str, list[tuple[int, int]]] = {"structural": [], "shear": [], "tie": []}
    for node in glb.json["nodes"]:
        extras = node["extras"]
        if extras["role"] != "springs":
            continue
        primitive = glb.json["meshes"][node["mesh"]]["primitives"][0]
        assert primitive["mode"] == 1  # LINES
        pairs = glb.array(primitive["indices"]).reshape(-1, 2)
        sheets = {(int(first) // n, int(second) // n) for first, second in pairs}
        assert sheets == {(extras["from"], extras["to"])}
        told[extras["kind"]] += [(int(first), int(second)) for first, second in pairs]
    springs = model.arrays.springs
    expected = sorted(zip(springs.first.tolist(), springs.second.tolist(), strict=True))
    assert sorted(told["structural"] + told["shear"]) == expected
    assert len(told["tie"]) == n
    # Straight down under each node of the two upper sheets, and along every edge of the three.
    assert len(told["structural"]) == 2 * n + 3 * len(model.sheet.edges)
