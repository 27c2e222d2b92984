"""What the stream weighs and costs: each form of the frames of a face in lively motion."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from engine import Rig

from ..packed import decode_packed, encode_packed
from ..protocol import GRID_METRES, HEAD_BYTES, RATE, SurfaceFrame, decode_frame, encode_frame
from .lively import lively_frames
from .section import Section

_STATIC = Path(__file__).parents[2] / "static"
_BUNDLER = _STATIC / "node_modules" / ".bin" / "rolldown"
_ROUNDS = 3
_LONGEST_SECONDS = 120.0

Encode = Callable[[SurfaceFrame, SurfaceFrame | None], bytes]
Decode = Callable[[bytes, SurfaceFrame | None], object]


class _Form(NamedTuple):
    """One form of a frame.

    Attributes:
        name: What it is called.
        encode, decode: With the frame before it.
        viewer: Whether the viewer reads it.
    """

    name: str
    encode: Encode
    decode: Decode
    viewer: bool


def _floats(frame: SurfaceFrame, _: SurfaceFrame | None) -> bytes:
    return bytes(HEAD_BYTES) + (frame.steps * np.float32(GRID_METRES)).tobytes()


def _integers(frame: SurfaceFrame, _: SurfaceFrame | None) -> bytes:
    return bytes(HEAD_BYTES) + frame.steps.astype("<i2", copy=False).tobytes()


def _read(kind: str) -> Decode:
    return lambda data, _: np.frombuffer(data, kind, offset=HEAD_BYTES).reshape(-1, 3)


_FORMS = (
    _Form("float32", _floats, _read("<f4"), False),
    _Form("int16 from rest", _integers, _read("<i2"), False),
    _Form("plain", lambda frame, _: encode_frame(frame), lambda data, _: decode_frame(data), True),
    _Form("packed", encode_packed, decode_packed, True),
    _Form("packed, each whole", lambda frame, _: encode_packed(frame), decode_packed, True),
)


def measure_stream(rig: Rig, *, seconds: float) -> dict[str, Any]:
    """Return what frames of a face in lively motion weigh and cost, one row a form.

    Args:
        rig: Of the face.
        seconds: How long it moves, more than one.

    Returns:
        "frames"; for each form "bytes" a frame, "mbit_s" at 60 frames a second and that of the
        worst second, "encode_us" and "decode_us" of a frame, in Python and of the processor, and
        "viewer_us", the viewer's decoding in node; None where that does not read it, or node or
        its packages are missing.
    """
    frames = lively_frames(rig, seconds)
    befores = [None, *frames[:-1]]
    sent = [
        [form.encode(frame, base) for frame, base in zip(frames, befores, strict=True)]
        for form in _FORMS
    ]
    read = iter(_in_viewer([data for data, form in zip(sent, _FORMS, strict=True) if form.viewer]))
    rows = []
    for form, data in zip(_FORMS, sent, strict=True):
        sizes = np.array([len(each) for each in data])
        second = np.convolve(sizes, np.ones(RATE), "valid")
        encoded, decoded = _times(form, frames, data)
        rows.append(
            {
                "form": form.name,
                "bytes": round(float(sizes.mean())),
                "mbit_s": round(8e-6 * RATE * float(sizes.mean()), 3),
                "worst_mbit_s": round(8e-6 * float(second.max()), 3),
                "encode_us": encoded,
                "decode_us": decoded,
                "viewer_us": next(read) if form.viewer else None,
            }
        )
    return {"frames": len(frames), "forms": rows}


def stream_section(values: dict[str, Any]) -> Section:
    """Return the table of `measure_stream`."""
    return Section(
        "What the stream weighs and costs",
        f"{values['frames']} frames of the standard head in lively motion: idle life, eleven "
        "visemes a second, an emotion every 2.5 s, a head that turns. Mbit/s at 60 frames a "
        "second; µs of the processor a frame, here and, as the viewer decodes, in node. Packed is "
        "told by the frame before, but once a second; each whole is what a viewer that misses "
        "every other frame would get at worst.",
        ("form", "bytes", "Mbit/s", "worst second", "encoded, µs", "decoded, µs", "in node, µs"),
        tuple(
            (
                row["form"],
                f"{row['bytes']:,}",
                f"{row['mbit_s']:.2f}",
                f"{row['worst_mbit_s']:.2f}",
                f"{row['encode_us']:.0f}",
                f"{row['decode_us']:.0f}",
                "" if row["viewer_us"] is None else f"{row['viewer_us']:.0f}",
            )
            for row in values["forms"]
        ),
    )


def _times(
    form: _Form, frames: Sequence[SurfaceFrame], sent: Sequence[bytes]
) -> tuple[float, float]:
    """Return processor time of the best of a few rounds [µs a frame]: encoding, decoding."""
    befores = [None, *frames[:-1]]
    taken = []
    for _ in range(_ROUNDS):
        started = time.process_time()
        for frame, base in zip(frames, befores, strict=True):
            form.encode(frame, base)
        between = time.process_time()
        for data, base in zip(sent, befores, strict=True):
            form.decode(data, base)
        taken.append((between - started, time.process_time() - between))
    encoded, decoded = (1e6 * min(each) / len(frames) for each in zip(*taken, strict=True))
    return round(encoded, 1), round(decoded, 1)


def _in_viewer(forms: Sequence[Sequence[bytes]]) -> list[float | None]:
    """Return how long the viewer takes to decode a frame of each form [µs], None without node."""
    node = shutil.which("node")
    if node is None or not _BUNDLER.exists():
        return [None] * len(forms)
    with tempfile.TemporaryDirectory(prefix="risorius-bench-") as folder:
        program = Path(folder) / "decode-times.mjs"
        files = []
        for number, frames in enumerate(forms):
            files.append(Path(folder) / f"{number}.frames")
            files[-1].write_bytes(b"".join(struct.pack("<I", len(f)) + f for f in frames))
        bundle = [str(_BUNDLER), "bench/decode-times.ts", "--file", str(program)]
        _run([*bundle, "--platform", "node"])
        printed = _run([node, str(program), *map(str, files)])
    return [round(each, 1) for each in json.loads(printed)]


def _run(command: list[str]) -> str:
    done = subprocess.run(
        command, cwd=_STATIC, capture_output=True, text=True, check=True, timeout=_LONGEST_SECONDS
    )
    return done.stdout
