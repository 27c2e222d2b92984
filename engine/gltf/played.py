"""The performance in a clip's file: what it takes to play it again, and where that stands."""

from __future__ import annotations

import json
import struct
import zlib
from typing import Any

import numpy as np

from ..errors import InvalidTrack
from ..performance import Performance
from .builder import GlbBuilder

KEY = "performance"
"""Name in the extras of the asset."""
MOST_TEXT = 2**14
"""A longer timeline is not text in the extras but compressed, in a buffer view of its own."""
MOST_BYTES = 2**28
"""No timeline is longer, uncompressed: a file may say that it is."""
_JSON, _BINARY = b"JSON", b"BIN\0"


def add_performance(builder: GlbBuilder, performance: Performance) -> None:
    """Put a performance into the extras of a file.

    A long timeline, of a tracker say, is UTF-8 JSON compressed by zlib: "timeline" is then
    {"bufferView": …, "encoding": "zlib"}.
    """
    told = performance.to_json()
    text = json.dumps(told["timeline"], separators=(",", ":")).encode()
    if len(text) > MOST_TEXT:
        packed = np.frombuffer(zlib.compress(text, 9), np.uint8)
        told["timeline"] = {"bufferView": builder.view(packed), "encoding": "zlib"}
    else:
        told["timeline"] = tuple(told["timeline"])
    told["rig"] = {**told["rig"], "steps": tuple(told["rig"].get("steps", ()))}
    builder.tell({KEY: told})


def performance_of(data: bytes) -> Performance:
    """Return the performance in a clip's GLB file.

    Raises:
        InvalidTrack: If it is no GLB file, none of ours, or none of a performance.
    """
    document, binary = _chunks(data)
    told = document.get("asset", {}).get("extras", {}).get(KEY)
    if not isinstance(told, dict):
        raise InvalidTrack(
            "this GLB file holds no performance of ours: expected asset.extras.performance, as "
            "clips have it; rigs, faces and files of other programs do not"
        )
    timeline = told.get("timeline")
    if isinstance(timeline, dict):
        told = {**told, "timeline": _unpacked(document, binary, timeline)}
    return Performance.from_json(told)


def _unpacked(document: dict[str, Any], binary: bytes, packed: dict[str, Any]) -> Any:
    try:
        view = document["bufferViews"][packed["bufferView"]]
        first = view.get("byteOffset", 0)
        inflate = zlib.decompressobj()
        text = inflate.decompress(binary[first : first + view["byteLength"]], MOST_BYTES)
        return json.loads(text)
    except (KeyError, IndexError, TypeError, ValueError, zlib.error, RecursionError) as error:
        raise InvalidTrack(f"its timeline cannot be unpacked: {error}") from error


def _chunks(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the document and the binary chunk of a GLB file (specification, section 4.4).

    Raises:
        InvalidTrack: If it is none.
    """
    try:
        magic, version, _ = struct.unpack_from("<4sII", data)
        size, kind = struct.unpack_from("<I4s", data, 12)
        if (magic, version, kind) != (b"glTF", 2, _JSON):
            raise ValueError("it does not begin as one does")
        document = json.loads(data[20 : 20 + size])
        after = 20 + size
        binary = b""
        if len(data) >= after + 8:
            length, kind = struct.unpack_from("<I4s", data, after)
            binary = data[after + 8 : after + 8 + length] if kind == _BINARY else b""
        if not isinstance(document, dict):
            raise ValueError("its document is no object")
    except (struct.error, ValueError, RecursionError) as error:
        raise InvalidTrack(f"this is no GLB file: {error}") from error
    return document, binary
