"""Packed frames: the same surface for a fifth of the bytes, as what changed since another frame.

The first 68 bytes are those of `protocol.py` but for three: the kind is 2, and byte 66 says
something else.

| byte | type | content |
|---|---|---|
| 0 | uint8 | kind: 2 = packed surface |
| 66 | uint16 | back: how many ticks before its own that of the base frame is; 0 = it needs none |
| 68 | 2 float32 | only with bit 1 of the flags: thrust of head and of tongue in metres |
| after them | raw deflate | 6 s bytes: 2 x 3 planes of s bytes |

All of it is done with 16 bits, without a carry. What is packed is displacement from rest in steps
of 20 micrometres; less that of the base frame, vertex by vertex, unless back is 0; of that, axis
by axis, each vertex's difference from the vertex before it. A difference d is written 2 d, and
-2 d - 1 below 0. The planes are the lower bytes of x, of y, of z, then the upper ones, which are
nearly all 0.

The base is always the frame that was sent before to the same viewer, so that whoever reads every
frame has it; who lost it waits for a whole one, which comes once a second.
"""

from __future__ import annotations

import zlib

import numpy as np
import numpy.typing as npt

from .protocol import (
    HEAD_BYTES,
    MalformedFrame,
    SurfaceFrame,
    decode_head,
    decode_thrusts,
    encode_head,
)

KIND_PACKED = 2
PACKED_VERSION = 1
MOST_BACK = 0xFFFF
_LEVEL = 1
"""Of deflate. Level 6 saves a tenth of the bytes and takes twice as long."""
_RAW = -15

Steps = npt.NDArray[np.int16]


class NoBase(ValueError):
    """A frame that says what changed since one that its reader has not got."""


def ticks_back(tick: int, base: int | None) -> int:
    """Return how far before `tick` the tick `base` is, 0 if nothing can be told by it."""
    back = 0 if base is None else (tick - base) % 2**32
    return back if back <= MOST_BACK else 0


def encode_packed(frame: SurfaceFrame, base: SurfaceFrame | None = None) -> bytes:
    """Return the bytes of `frame`, as what changed since `base`, whole without one.

    A base with another number of vertices, or further off than can be said, counts as none.
    """
    back = 0
    steps = frame.steps
    if base is not None and len(base.steps) == len(steps):
        back = ticks_back(frame.tick, base.tick)
    if base is not None and back:
        steps = steps - base.steps
    along = np.empty((3, len(steps)), np.int16)
    along[:, :1] = steps[:1].T
    np.subtract(steps[1:].T, steps[:-1].T, out=along[:, 1:])
    signless = ((along << 1) ^ (along >> 15)).view(np.uint16).reshape(-1)
    planes = np.concatenate([signless.astype(np.uint8), (signless >> 8).astype(np.uint8)])
    head, thrusts = encode_head(frame, KIND_PACKED, PACKED_VERSION, back)
    return head + thrusts + zlib.compress(planes.tobytes(), _LEVEL, _RAW)


def decode_packed(data: bytes, base: SurfaceFrame | None = None) -> SurfaceFrame:
    """Return what `data` says.

    Args:
        data: A frame.
        base: The frame that came before it, if there was one.

    Raises:
        NoBase: If it needs another base than that.
        MalformedFrame: If `data` is of another kind or version, or not as long as it says.
    """
    head = decode_head(data)
    if (head.kind, head.version) != (KIND_PACKED, PACKED_VERSION):
        raise MalformedFrame(f"kind {head.kind} version {head.version} is not packed version 1")
    thrusts, start = decode_thrusts(data, head, HEAD_BYTES)
    changed = _unpacked(data[start:], head.vertices)
    frame = head.frame(changed, thrusts)
    if not head.last:
        return frame
    known = base is not None and ticks_back(frame.tick, base.tick) == head.last
    if base is None or not known or base.steps.shape != changed.shape:
        raise NoBase(f"the frame of tick {frame.tick} needs that of {head.last} ticks before")
    np.add(changed, base.steps, out=changed)
    return frame


def _unpacked(packed: bytes, vertices: int) -> Steps:
    """Return the displacements [grid steps] that are packed, or their changes."""
    unpacker = zlib.decompressobj(_RAW)
    size = 6 * vertices
    try:
        planes = unpacker.decompress(packed, size + 1)
    except zlib.error as error:
        raise MalformedFrame(f"what follows byte {HEAD_BYTES} cannot be inflated") from error
    if len(planes) != size or not unpacker.eof or unpacker.unused_data:
        raise MalformedFrame(f"the header says {size} bytes of planes, the frame has others")
    lower, upper = np.frombuffer(planes, np.uint8).reshape(2, 3, vertices).astype(np.uint16)
    signless = lower | upper << 8
    along = (signless >> 1) ^ (0 - (signless & 1))
    return np.cumsum(along, axis=1, dtype=np.uint16).view(np.int16).T.copy()
