"""Where the tissue under a face's skin is, as bytes for viewers that peel it. Kind 16, version 1.

All numbers are little endian. The points are those of `tissue.glb`, sheet by sheet; the outermost
one, the epidermis, is what the stream shows, and is left out.

| byte | type | content |
|---|---|---|
| 0 | uint8 | kind: 16 = layers |
| 1 | uint8 | version of the kind: 1 |
| 2 | uint16 | nodes n of a sheet |
| 4 | uint32 | tick, 60 a second of the session's own time |
| 8 | 3 n x 3 int16 | x, y, z from rest in steps of 20 µm: dermis, hypodermis, bone |
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from engine import Snapshot

from .protocol import GRID_METRES, MalformedFrame, to_grid

KIND_LAYERS = 16
LAYERS_VERSION = 1
SHEETS = 3
"""Those that are told: dermis, hypodermis, bone."""
_HEADER = struct.Struct("<BBHI")


@dataclass(frozen=True, eq=False)
class LayersFrame:
    """The tissue under the skin at one moment.

    Attributes:
        tick: Session time in ticks.
        steps: From rest [grid steps], int16, shape (3, nodes, 3): dermis, hypodermis, bone.
    """

    tick: int
    steps: npt.NDArray[np.int16]

    @property
    def displacements(self) -> npt.NDArray[np.float64]:
        """Displacements from rest [m], shape (3, nodes, 3)."""
        return self.steps.astype(np.float64) * GRID_METRES


def layers_frame(snapshot: Snapshot) -> LayersFrame:
    """Return where a face's tissue is.

    Raises:
        ValueError: If a number of it is not finite.
    """
    tissue = snapshot.assembly.tissue
    n = tissue.node_count
    moved = (snapshot.x.T - tissue.arrays.rest.T).reshape(SHEETS, n, 3)[1:]
    bone = snapshot.skull.bone.T - tissue.layers.bone
    return LayersFrame(snapshot.tick, to_grid(np.concatenate([moved, bone[None]])))


def encode_layers(frame: LayersFrame) -> bytes:
    """Return the bytes of `frame`, as laid out above."""
    nodes, tick = frame.steps.shape[1], frame.tick & 0xFFFFFFFF
    header = _HEADER.pack(KIND_LAYERS, LAYERS_VERSION, nodes, tick)
    return header + frame.steps.astype("<i2", copy=False).tobytes()


def decode_layers(data: bytes) -> LayersFrame:
    """Return what `data` says.

    Raises:
        MalformedFrame: If `data` is of another kind or version, or its length is not what its
            header says.
    """
    if len(data) < _HEADER.size:
        raise MalformedFrame(f"layers have at least {_HEADER.size} bytes, these {len(data)}")
    kind, version, nodes, tick = _HEADER.unpack_from(data)
    if (kind, version) != (KIND_LAYERS, LAYERS_VERSION):
        raise MalformedFrame(f"kind {kind} version {version} is not layers version 1")
    size = _HEADER.size + 6 * SHEETS * nodes
    if len(data) != size:
        raise MalformedFrame(f"{len(data)} bytes, but the header says {size}")
    steps = np.frombuffer(data, "<i2", offset=_HEADER.size).reshape(SHEETS, nodes, 3)
    return LayersFrame(tick, steps.astype(np.int16))
