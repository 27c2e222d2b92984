"""The files' structure and numbers against golden summaries: a change of format shows as a diff."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb
from small_face import small_rig
from small_motion import small_clip, small_frame

from engine.gltf import clip_to_glb, face_to_glb, surface_to_glb
from engine.gltf.rig import targets_to_glb

GOLDEN = Path(__file__).parents[1] / "golden"
RIG = small_rig()
FRAME = small_frame(
    np.sin(np.arange(RIG.head.points.size)).reshape(-1, 3), jaw_pitch=10.0, head=(5.0, 3.0, 2.0)
)
FILES = {
    "surface": partial(surface_to_glb, RIG),
    "face": partial(face_to_glb, RIG, FRAME),
    "rig": partial(targets_to_glb, RIG, ("AU26",), [FRAME]),
    "clip": partial(clip_to_glb, small_clip(), quantize=False),
}


@pytest.mark.parametrize("kind", FILES)
def test_file_is_as_it_was(kind: str, update_golden: bool) -> None:
    path = GOLDEN / f"glb-{kind}.json"
    summary = summarise(Glb(FILES[kind]()))
    if update_golden:
        path.parent.mkdir(exist_ok=True)
        path.write_text(json.dumps(summary, indent=1) + "\n")
    golden = json.loads(path.read_text())
    arrays, golden_arrays = summary.pop("arrays"), golden.pop("arrays")
    assert summary == golden
    assert [entry[:3] for entry in arrays] == [entry[:3] for entry in golden_arrays]
    np.testing.assert_allclose(
        [entry[3:] for entry in arrays], [entry[3:] for entry in golden_arrays], atol=2e-5
    )


def summarise(glb: Glb) -> dict[str, Any]:
    """Everything but the binary data; of that, each array's shape, type, least and greatest."""
    kept = {name: glb.json.get(name) for name in ("asset", "nodes", "meshes", "materials")}
    kept["asset"]["extras"].pop("max_error_mm", None)  # its last digit is the machine's
    kept["animations"] = glb.json.get("animations", [])
    kept["scenes"] = glb.json["scenes"]
    arrays = []
    for index, entry in enumerate(glb.json["accessors"]):
        values = glb.array(index).astype(float)
        # The largest magnitude, not the signed bounds: a basis shape may come with either sign.
        numbers = [float(np.abs(values).max()), float(np.abs(values).mean())]
        shape = [entry["type"], entry["count"], entry["componentType"]]
        arrays.append([*shape, *(round(number, 6) for number in numbers)])
    return {**kept, "arrays": arrays}
