"""The binary frames of the stream, version 1: a face's surface as displacements from rest.

This is the kind that everybody is sent; `packed.py` has the smaller one for those who ask.

A frame stands alone: whoever reads only this one has the whole face. All numbers are little
endian; lengths are in metres, as in `surface.glb`, whose vertex order the frame follows.

| byte | type | content |
|---|---|---|
| 0 | uint8 | kind: 1 = surface |
| 1 | uint8 | version of the kind: 1 |
| 2 | uint16 | flags; bit 0: asleep, the last new frame until something moves; bit 1: thrusts |
| 4 | uint32 | tick, 60 a second of the session's own time |
| 8 | 4 float32 | rotation of the jaw, quaternion x, y, z, w |
| 24 | 3 float32 | offset of the jaw's hinge from its rest place, x, y, z in metres |
| 36 | 4 float32 | gaze in degrees: left eye yaw, pitch; right eye yaw, pitch |
| 52 | 3 float32 | head in degrees: yaw, pitch, roll |
| 64 | uint16 | vertex count s |
| 66 | uint16 | moved count k: the vertices whose displacement follows |
| 68 | ceil(s / 8) bytes | bitmap, least significant bit first: bit i is set if vertex i is moved |
| even | k x 3 int16 | x, y, z displacement in steps of 20 micrometres, in vertex order |
| after them | 2 float32 | only with bit 1: thrust of head and of tongue in metres |

A zero byte pads the bitmap where the displacements would start at an odd offset. A vertex whose
bit is not set is at rest, to half a step. `docs/stream.md` has a reader in plain Python.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from engine import Frame, JawHinge

SUBPROTOCOL = "risorius.v1"
KIND_SURFACE = 1
FRAME_VERSION = 1
FLAG_ASLEEP = 1
FLAG_THRUSTS = 2
GRID_METRES = 2e-5
RATE = 60

_HEADER = struct.Struct("<BBHI4f3f4f3fHH")
_THRUSTS = struct.Struct("<2f")
_MILLIMETRES_PER_STEP = GRID_METRES * 1000.0
_STEP_LIMIT = 32767


class MalformedFrame(ValueError):
    """Bytes that are not a frame of this version."""


@dataclass(frozen=True, eq=False)
class SurfaceFrame:
    """What one binary frame says.

    Attributes:
        tick: Session time in ticks.
        asleep: Nothing new follows until something moves.
        jaw_quaternion: Rotation of the jaw, x, y, z, w.
        jaw_offset: Offset of the jaw's hinge from rest [m].
        gaze: Left yaw, left pitch, right yaw, right pitch [degrees].
        head: Yaw, pitch, roll [degrees].
        steps: Displacements from rest [grid steps], int16, shape (vertices, 3).
        head_thrust: How far the head is held forward [m].
        tongue_thrust: How far the tongue is put out [m].
    """

    tick: int
    asleep: bool
    jaw_quaternion: tuple[float, float, float, float]
    jaw_offset: tuple[float, float, float]
    gaze: tuple[float, float, float, float]
    head: tuple[float, float, float]
    steps: npt.NDArray[np.int16]
    head_thrust: float = 0.0
    tongue_thrust: float = 0.0

    @property
    def displacements(self) -> npt.NDArray[np.float64]:
        """Displacements from rest [m], shape (vertices, 3)."""
        return self.steps.astype(np.float64) * GRID_METRES


def surface_frame(frame: Frame, jaw: JawHinge) -> SurfaceFrame:
    """Return what viewers are told of `frame`: the surface on the grid, jaw, gaze and head.

    Raises:
        ValueError: If a number of the frame is not finite.
    """
    pose = frame.pose
    rotation, offset = jaw.transform(pose.jaw_pitch, pose.jaw_yaw, pose.jaw_thrust)
    return SurfaceFrame(
        tick=frame.tick,
        asleep=frame.asleep,
        jaw_quaternion=_quaternion(rotation),
        jaw_offset=(offset[0] / 1000.0, offset[1] / 1000.0, offset[2] / 1000.0),
        gaze=(*pose.gaze_left, *pose.gaze_right),
        head=pose.head,
        steps=to_grid(frame.displacements),
        head_thrust=pose.head_thrust / 1000.0,
        tongue_thrust=pose.tongue_thrust / 1000.0,
    )


def _quaternion(rotation: npt.NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Return a rotation of less than 120 degrees, shape (3, 3), as a quaternion x, y, z, w.

    Written out, because it is made for each frame of each watched face: a general function takes
    longer than all the rest of the frame.
    """
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = rotation.tolist()
    parts = (zy - yz, xz - zx, yx - xy, 1.0 + float(rotation.trace()))
    length = math.hypot(*parts)
    return (parts[0] / length, parts[1] / length, parts[2] / length, parts[3] / length)


def to_grid(displacements: npt.NDArray[np.float64]) -> npt.NDArray[np.int16]:
    """Round displacements [mm] to grid steps."""
    if not np.isfinite(displacements).all():
        raise ValueError("a displacement is not finite")
    steps = displacements / _MILLIMETRES_PER_STEP
    np.rint(steps, out=steps)
    np.clip(steps, -_STEP_LIMIT, _STEP_LIMIT, out=steps)
    return steps.astype(np.int16)


@dataclass(frozen=True)
class Head:
    """What the first 68 bytes of a frame say, of either kind.

    Attributes:
        kind, version: Which kind of frame it is.
        flags: Its bits.
        numbers: Tick, then jaw, gaze and head as in `SurfaceFrame`, 15 of them.
        vertices: Vertex count.
        last: The uint16 at byte 66, which each kind has for itself.
    """

    kind: int
    version: int
    flags: int
    numbers: tuple[float, ...]
    vertices: int
    last: int

    def frame(
        self, steps: npt.NDArray[np.int16], thrusts: tuple[float, float] = (0.0, 0.0)
    ) -> SurfaceFrame:
        """Return the frame with its displacements [grid steps], shape (vertices, 3)."""
        tick, *rest = self.numbers
        return SurfaceFrame(
            tick=int(tick),
            asleep=bool(self.flags & FLAG_ASLEEP),
            jaw_quaternion=(rest[0], rest[1], rest[2], rest[3]),
            jaw_offset=(rest[4], rest[5], rest[6]),
            gaze=(rest[7], rest[8], rest[9], rest[10]),
            head=(rest[11], rest[12], rest[13]),
            steps=steps,
            head_thrust=thrusts[0],
            tongue_thrust=thrusts[1],
        )


HEAD_BYTES = _HEADER.size


def encode_head(frame: SurfaceFrame, kind: int, version: int, last: int) -> tuple[bytes, bytes]:
    """Return the first 68 bytes of a frame, and its thrusts: eight bytes, none where both are 0."""
    thrusts = (frame.head_thrust, frame.tongue_thrust)
    flags = (FLAG_ASLEEP if frame.asleep else 0) | (FLAG_THRUSTS if any(thrusts) else 0)
    head = _HEADER.pack(
        kind,
        version,
        flags,
        frame.tick & 0xFFFFFFFF,
        *frame.jaw_quaternion,
        *frame.jaw_offset,
        *frame.gaze,
        *frame.head,
        len(frame.steps),
        last,
    )
    return head, _THRUSTS.pack(*thrusts) if flags & FLAG_THRUSTS else b""


def decode_head(data: bytes) -> Head:
    """Return what the first 68 bytes of a frame say.

    Raises:
        MalformedFrame: If there are fewer.
    """
    if len(data) < HEAD_BYTES:
        raise MalformedFrame(f"a frame has at least {HEAD_BYTES} bytes, this one {len(data)}")
    kind, version, flags, *numbers, vertices, last = _HEADER.unpack_from(data)
    return Head(kind, version, flags, tuple(numbers), vertices, last)


def decode_thrusts(data: bytes, head: Head, start: int) -> tuple[tuple[float, float], int]:
    """Return the thrusts of head and tongue [m] that byte `start` begins, if any, and their end.

    Raises:
        MalformedFrame: If the frame is over before.
    """
    if not head.flags & FLAG_THRUSTS:
        return (0.0, 0.0), start
    end = start + _THRUSTS.size
    if len(data) < end:
        raise MalformedFrame(f"{len(data)} bytes, but the header says that thrusts end at {end}")
    of_head, of_tongue = _THRUSTS.unpack_from(data, start)
    return (of_head, of_tongue), end


def encode_frame(frame: SurfaceFrame) -> bytes:
    """Return the bytes of `frame`, as laid out above."""
    moved = (frame.steps[:, 0] | frame.steps[:, 1] | frame.steps[:, 2]) != 0
    steps = frame.steps.astype("<i2", copy=False)
    head, thrusts = encode_head(frame, KIND_SURFACE, FRAME_VERSION, int(np.count_nonzero(moved)))
    bitmap = np.packbits(moved, bitorder="little").tobytes()
    padding = b"\0" * (len(bitmap) % 2)
    return head + bitmap + padding + steps.compress(moved, axis=0).tobytes() + thrusts


def decode_frame(data: bytes) -> SurfaceFrame:
    """Return what `data` says.

    Raises:
        MalformedFrame: If `data` is of another kind or version, or its length is not what its
            header says.
    """
    head = decode_head(data)
    if (head.kind, head.version) != (KIND_SURFACE, FRAME_VERSION):
        raise MalformedFrame(f"kind {head.kind} version {head.version} is not surface version 1")
    vertices, moved_count = head.vertices, head.last
    bitmap_size = (vertices + 7) // 8
    start = HEAD_BYTES + bitmap_size + bitmap_size % 2
    end = start + 6 * moved_count
    size = end + (_THRUSTS.size if head.flags & FLAG_THRUSTS else 0)
    if len(data) != size:
        raise MalformedFrame(f"{len(data)} bytes, but the header says {size}")
    thrusts, _ = decode_thrusts(data, head, end)
    bitmap = np.frombuffer(data, np.uint8, bitmap_size, HEAD_BYTES)
    moved = np.unpackbits(bitmap, count=vertices, bitorder="little").astype(bool)
    if np.count_nonzero(moved) != moved_count:
        raise MalformedFrame("the bitmap does not have as many bits set as vertices moved")
    steps = np.zeros((vertices, 3), np.int16)
    steps[moved] = np.frombuffer(data, "<i2", 3 * moved_count, start).reshape(-1, 3)
    return head.frame(steps, thrusts)
