"""The peer in Warp on the processor: one kernel thread a block of faces, its lanes in vectors.

A thread goes through springs, elements and fat one after another and adds to its own block's
forces, so nothing is atomic, and all steps of a call are one launch. Warp runs the threads of a
launch on one core, one after another.

Tried, for the springs of 16 faces: a thread a spring and face with atomics takes fourteen times as
long; tensions first, then sums by node, twice; eight lanes a quarter longer, and 32 gain nothing.
Springs as lanes serve one face alone, a fifth faster; that is not worth a second kernel.
"""

from __future__ import annotations

import importlib
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
from .warp_kernels import Kernels, kernels


class WarpPeer:
    """Warp on the processor, float32."""

    name = "warp"
    integrators = INTEGRATORS

    _tables: Tables
    _layout: Blocks
    _kernels: Kernels
    _shared: Any
    _own: Any

    @property
    def version(self) -> str:
        """See `Peer`."""
        return installed_version("warp-lang")

    @property
    def unavailable(self) -> str | None:
        """See `Peer`."""
        return missing("warp", "warp-lang")

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """See `Peer`."""
        tables = Tables(tissue)
        self._tables = tables
        self._layout = blocks_of(faces, widths=(1, MOST_LANES // 2, MOST_LANES))
        self._kernels = _kernels(self._layout.lanes)
        springs, volumes, ties = tables.springs, tables.volumes, tables.ties
        shared = self._kernels.shared()
        shared.n = tables.points
        shared.prisms, shared.quads = volumes.prisms.shape[1], volumes.quads.shape[1]
        shared.springs = len(springs.first)
        shared.least, shared.excess_distance = volumes.least, ties.excess_distance
        shared.gap, shared.damping = ties.gap, tables.damping
        shared.ends = _whole(np.stack([springs.first, springs.second], axis=1))
        shared.spring_law = _real(np.concatenate([springs.along, springs.law]).T)
        shared.corners, shared.fat = _whole(volumes.prisms.T), _whole(volumes.quads.T)
        at_rest = np.concatenate([volumes.p, volumes.r, volumes.h, volumes.law])
        shared.volume_law = _real(at_rest.T)
        shared.tie_law = _real(ties.law.T)
        shared.inverse_mass = _real(tables.inverse_mass)
        self._shared = shared
        bones, still = tables.bones(skull), np.zeros((3, tables.nodes))
        own = self._kernels.own()
        own.targets, own.normals = self._spread(bones.targets), self._spread(bones.normals)
        own.load, own.depth = self._spread(bones.load), self._spread(bones.depth)
        own.u, own.v, own.force = (self._spread(still) for _ in range(3))
        own.at, own.mid_v = (self._spread(still) for _ in range(2))
        self._own = own
        self.evaluate(1)

    def force(self, x: FloatArray) -> FloatArray:
        """See `Peer`."""
        kept, self._own.at = self._own.at, self._vectors(x - self._tables.rest)
        self.evaluate(1)
        self._own.at = kept
        return self._faces(self._own.force)

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """See `Peer`."""
        u = x - self._tables.rest
        self._own.u, self._own.at = self._vectors(u), self._vectors(u)
        self._own.v = self._vectors(v * (self._tables.inverse_mass > 0.0))

    def where(self) -> tuple[FloatArray, FloatArray]:
        """See `Peer`."""
        return self._faces(self._own.u) + self._tables.rest, self._faces(self._own.v)

    def evaluate(self, count: int) -> None:
        """See `Peer`."""
        self._launch(False, count, 0.0)

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """See `Peer`."""
        self._launch(integrator == "verlet", count * EVALUATIONS[integrator], dt)

    def _launch(self, verlet: bool, stages: int, dt: float) -> None:
        inputs = [self._shared, self._own, verlet, stages, dt]
        _warp().launch(self._kernels.advance, self._layout.count, inputs=inputs, device="cpu")

    def _spread(self, face: FloatArray) -> Any:
        """Return (3, a) for every face as vectors of lanes, shape (blocks, a, 3)."""
        return self._vectors(np.broadcast_to(face, (self._layout.faces, *face.shape)))

    def _vectors(self, faces: FloatArray) -> Any:
        """Return (faces, 3, a) as vectors of lanes, shape (blocks, a, 3)."""
        blocks = self._layout.pack(np.swapaxes(faces, 1, 2))
        return _warp().array(blocks, dtype=self._kernels.vector, device="cpu")

    def _faces(self, vectors: Any) -> FloatArray:
        """Return vectors of lanes, shape (blocks, a, 3), as (faces, 3, a)."""
        blocks: Float32Array = vectors.numpy()
        shape = *blocks.shape[:3], self._layout.lanes
        return np.ascontiguousarray(np.swapaxes(self._layout.unpack(blocks.reshape(shape)), 1, 2))


@lru_cache(maxsize=1)
def _warp() -> Any:
    """Return the package, quiet, without the gradients that nobody asks for."""
    wp = importlib.import_module("warp")
    wp.config.log_level = wp.LOG_ERROR
    wp.config.enable_backward = False
    wp.init()
    return wp


def _whole(array: Any) -> Any:
    wp = _warp()
    return wp.array(np.ascontiguousarray(array, np.int32), dtype=wp.int32, device="cpu")


def _real(array: FloatArray) -> Any:
    wp = _warp()
    return wp.array(np.ascontiguousarray(array, np.float32), dtype=wp.float32, device="cpu")


@lru_cache(maxsize=4)
def _kernels(lanes: int) -> Kernels:
    return kernels(_warp(), lanes)
