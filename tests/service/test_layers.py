"""The tissue under the skin: its bytes, the file of its sheets and springs, and a live face's."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import until
from starlette.testclient import TestClient

from service.layers import LayersFrame, decode_layers, encode_layers
from service.protocol import MalformedFrame

FOLDER = Path(__file__).parents[1] / "golden" / "layers"


def test_golden_layers(update_golden: bool) -> None:
    steps = np.arange(-18, 18, dtype=np.int16).reshape(3, 4, 3) * 100
    frame = LayersFrame(tick=4_294_967_295, steps=steps)
    said = {"tick": frame.tick, "nodes": 4, "displacements": frame.displacements.round(8).tolist()}
    if update_golden:
        (FOLDER / "four-nodes.bin").write_bytes(encode_layers(frame))
        (FOLDER / "four-nodes.json").write_text(json.dumps(said) + "\n")
    data = (FOLDER / "four-nodes.bin").read_bytes()
    assert encode_layers(frame) == data
    read, expected = decode_layers(data), json.loads((FOLDER / "four-nodes.json").read_text())
    assert read.tick == expected["tick"]
    np.testing.assert_allclose(read.displacements, expected["displacements"], atol=1e-9)


@pytest.mark.parametrize(
    ("data", "why"),
    [(b"\x10\x01", "at least 8"), (b"\x01" * 8, "not layers"), (b"\x10\x01\x01" + bytes(5), "26")],
)
def test_other_bytes_are_refused(data: bytes, why: str) -> None:
    with pytest.raises(MalformedFrame, match=why):
        decode_layers(data)


def test_layers_go_with_the_face(client: TestClient, session: str) -> None:
    path = f"/api/sessions/{session}"
    still = decode_layers(client.get(f"{path}/layers").content)
    assert not still.steps.any()
    controls = {"action_units": {"AU12": 1.0}, "jaw": {"pitch": 15.0}, "fade": 0.1}
    assert client.put(f"{path}/controls", json=controls).status_code == 200
    until(lambda: bool(client.get(path).json()["asleep"]))
    moved = decode_layers(client.get(f"{path}/layers").content)
    assert moved.tick > still.tick
    dermis, hypodermis, bone = np.linalg.norm(moved.displacements, axis=2).max(axis=1)
    # The jaw takes its bone along, and the tissue goes further than that.
    assert 0.01 < bone < 0.05
    assert min(dermis, hypodermis) > 0.01
    rig = client.get(path).json()["rig"]
    file = client.get(f"/api/rigs/{rig}/tissue.glb")
    assert file.headers["content-type"] == "model/gltf-binary"
    tag = {"If-None-Match": file.headers["etag"]}
    assert client.get(f"/api/rigs/{rig}/tissue.glb", headers=tag).status_code == 304
