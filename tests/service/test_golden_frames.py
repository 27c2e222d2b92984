"""Binary frames against the golden files that the viewer's tests read as well."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from service.packed import decode_packed, encode_packed
from service.protocol import SurfaceFrame, decode_frame, encode_frame

FOLDER = Path(__file__).parents[1] / "golden" / "frames"


def steps_at(vertices: int, moved: dict[int, tuple[int, int, int]]) -> np.ndarray:
    steps = np.zeros((vertices, 3), np.int16)
    for vertex, step in moved.items():
        steps[vertex] = step
    return steps


def wave(vertices: int) -> np.ndarray:
    """Every third vertex at rest, the others on a wave of up to 12 mm."""
    index = np.arange(vertices)
    steps = np.stack([600 * np.sin(index / (7 + axis)) for axis in range(3)], axis=1)
    steps[::3] = 0
    return steps.astype(np.int16)


REST = {
    "jaw_quaternion": (0.0, 0.0, 0.0, 1.0),
    "jaw_offset": (0.0, 0.0, 0.0),
    "gaze": (0.0, 0.0, 0.0, 0.0),
    "head": (0.0, 0.0, 0.0),
}
POSED = {
    "jaw_quaternion": (0.125, -0.0625, 0.03125, 0.9897460),
    "jaw_offset": (0.0005, -0.00025, 0.002),
    "gaze": (10.0, -5.5, 8.25, -5.5),
    "head": (12.5, -3.0, 1.75),
}
CASES = {
    "rest": SurfaceFrame(tick=0, asleep=True, steps=steps_at(16, {}), **REST),
    "one-vertex": SurfaceFrame(tick=61, asleep=False, steps=steps_at(9, {8: (1, -2, 3)}), **POSED),
    "odd-bitmap": SurfaceFrame(
        tick=4_294_967_295,
        asleep=False,
        steps=steps_at(20, {0: (-1, 0, 0), 7: (0, 1, 0), 8: (0, 0, -1), 19: (5, 6, 7)}),
        **POSED,
    ),
    "limits": SurfaceFrame(
        tick=7,
        asleep=True,
        steps=steps_at(3, {0: (32767,) * 3, 1: (-32767,) * 3, 2: (32767, 0, -32767)}),
        **REST,
    ),
    "thrusts": SurfaceFrame(
        tick=12,
        asleep=False,
        steps=steps_at(5, {2: (4, -5, 6)}),
        head_thrust=0.03125,
        tongue_thrust=0.015625,
        **POSED,
    ),
    "wave": SurfaceFrame(tick=3600, asleep=False, steps=wave(777), **POSED),
}
PACKED = {
    "packed-rest": SurfaceFrame(tick=0, asleep=True, steps=steps_at(16, {}), **REST),
    "packed-whole": CASES["wave"],
    "packed-change": SurfaceFrame(
        tick=3602,
        asleep=False,
        steps=wave(777) + steps_at(777, {3: (1, -2, 300), 775: (-4, 5, -6), 776: (7, 0, 0)}),
        head_thrust=0.03125,
        tongue_thrust=0.015625,
        **POSED,
    ),
    "packed-limits": SurfaceFrame(
        tick=1,
        asleep=False,
        steps=steps_at(3, {0: (32767, -32767, 1), 1: (-32767, 32767, -2), 2: (0, 32767, 3)}),
        **REST,
    ),
}
"""Packed frames; the change is told by the wave."""
BASES = {"packed-change": "packed-whole"}


def described(frame: SurfaceFrame) -> dict[str, object]:
    """What the JSON beside the bytes says: header fields, and metres for every vertex."""
    thrusts = [frame.head_thrust, frame.tongue_thrust]
    return {
        "kind": 1,
        "version": 1,
        "flags": int(frame.asleep) + 2 * bool(frame.head_thrust or frame.tongue_thrust),
        "tick": frame.tick,
        "jaw_quaternion": list(frame.jaw_quaternion),
        "jaw_offset": list(frame.jaw_offset),
        "gaze": list(frame.gaze),
        "head": list(frame.head),
        **({"thrusts": thrusts} if any(thrusts) else {}),
        "vertex_count": len(frame.steps),
        "moved": int(frame.steps.any(axis=1).sum()),
        "displacements": np.round(frame.displacements, 8).tolist(),
    }


@pytest.mark.parametrize("name", CASES)
def test_golden_frame(name: str, update_golden: bool) -> None:
    frame = CASES[name]
    if update_golden:
        (FOLDER / f"{name}.bin").write_bytes(encode_frame(frame))
        (FOLDER / f"{name}.json").write_text(json.dumps(described(frame)) + "\n")
    data = (FOLDER / f"{name}.bin").read_bytes()
    expected = json.loads((FOLDER / f"{name}.json").read_text())
    assert encode_frame(frame) == data
    read = described(decode_frame(data))
    for field, value in expected.items():
        np.testing.assert_allclose(read[field], value, rtol=0, atol=1e-6, err_msg=field)


@pytest.mark.parametrize("name", PACKED)
def test_golden_packed_frame(name: str, update_golden: bool) -> None:
    frame, base = PACKED[name], PACKED.get(BASES.get(name, ""))
    if update_golden:
        (FOLDER / f"{name}.bin").write_bytes(encode_packed(frame, base))
        told = {**described(frame), "kind": 2, **({"base": BASES[name]} if base else {})}
        (FOLDER / f"{name}.json").write_text(json.dumps(told) + "\n")
    data = (FOLDER / f"{name}.bin").read_bytes()
    expected = json.loads((FOLDER / f"{name}.json").read_text())
    assert expected.pop("kind") == data[0]
    assert expected.pop("base", None) == BASES.get(name)
    # Deflate may be done in other ways by other releases of zlib: it is what they say that counts.
    for packed in (data, encode_packed(frame, base)):
        read = described(decode_packed(packed, base))
        for field, value in expected.items():
            np.testing.assert_allclose(read[field], value, rtol=0, atol=1e-6, err_msg=field)


def test_the_folder_holds_these_cases_only() -> None:
    assert {path.stem for path in FOLDER.glob("*.*") if path.suffix in {".bin", ".json"}} == {
        *CASES,
        *PACKED,
    }
