"""The peer in Taichi on the processor: one parallel iteration a block of faces, lanes in vectors.

An iteration goes through springs, elements and fat one after another and adds to its own block's
forces, so nothing is atomic, and all steps of a call are one kernel. Taichi runs on one thread, as
all peers do.

Tried, for the springs of 16 faces: one iteration a spring and face with atomics takes some twenty
times as long; tensions first, then sums by node, twice; a loop over the lanes in place of vectors,
which the compiler does not turn into vector instructions, three times for the tensions alone.
"""

from __future__ import annotations

import importlib
import io
import os
import warnings
from contextlib import redirect_stdout
from functools import lru_cache
from typing import Any

import numpy as np

from engine.arrays import Float32Array, FloatArray
from engine.dynamics import Skull, Tissue

from .common import (
    EVALUATIONS,
    INTEGRATORS,
    MOST_LANES,
    Blocks,
    Integrator,
    Tables,
    blocks_of,
    installed_version,
    missing,
)
from .taichi_kernels import Fields


class TaichiPeer:
    """Taichi on the processor, float32."""

    name = "taichi"
    integrators = INTEGRATORS

    _tables: Tables
    _layout: Blocks
    _fields: Fields

    @property
    def version(self) -> str:
        """See `Peer`."""
        return installed_version("taichi")

    @property
    def unavailable(self) -> str | None:
        """See `Peer`."""
        return missing("taichi", "taichi")

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """See `Peer`."""
        self._tables = Tables(tissue)
        self._layout = blocks_of(faces, widths=(1, MOST_LANES // 2, MOST_LANES))
        self._fields = Fields(_taichi(), self._tables, self._layout)
        bones, still = self._tables.bones(skull), np.zeros((faces, 3, self._tables.nodes))
        for name in ("targets", "normals", "load", "depth"):
            face: FloatArray = getattr(bones, name)
            self._set(name, np.broadcast_to(face, (faces, *face.shape)))
        self._set("u", still)
        self._set("at", still)
        self._set("v", still)
        self.evaluate(1)

    def force(self, x: FloatArray) -> FloatArray:
        """See `Peer`."""
        kept = self._fields.at.to_numpy()
        self._set("at", x - self._tables.rest)
        self.evaluate(1)
        self._fields.at.from_numpy(kept)
        return self._faces("force")

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """See `Peer`."""
        self._set("u", x - self._tables.rest)
        self._set("at", x - self._tables.rest)
        self._set("v", v * (self._tables.inverse_mass > 0.0))

    def where(self) -> tuple[FloatArray, FloatArray]:
        """See `Peer`."""
        return self._faces("u") + self._tables.rest, self._faces("v")

    def evaluate(self, count: int) -> None:
        """See `Peer`."""
        self._fields.advance(0, count, 0.0)

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """See `Peer`."""
        self._fields.advance(integrator == "verlet", count * EVALUATIONS[integrator], dt)

    def _set(self, name: str, faces: FloatArray) -> None:
        """Set a field of vectors to (faces, 3, a)."""
        getattr(self._fields, name).from_numpy(self._layout.pack(np.swapaxes(faces, 1, 2)))

    def _faces(self, name: str) -> FloatArray:
        """Return a field of vectors as (faces, 3, a)."""
        blocks: Float32Array = getattr(self._fields, name).to_numpy()
        return np.ascontiguousarray(np.swapaxes(self._layout.unpack(blocks), 1, 2))


@lru_cache(maxsize=1)
def _taichi() -> Any:
    """Return the package, started on one thread.

    It greets on standard output when it is imported and when it starts; that is not its own.
    """
    os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")
    with warnings.catch_warnings():
        # It asks Python for things that are on their way out.
        warnings.simplefilter("ignore", DeprecationWarning)
        ti = importlib.import_module("taichi")
    with redirect_stdout(io.StringIO()):
        ti.init(
            arch=ti.cpu,
            cpu_max_num_threads=1,
            default_fp=ti.f32,
            fast_math=True,
            log_level=ti.ERROR,
        )
    return ti
