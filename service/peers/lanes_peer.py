"""The kernel that moves live faces in the form of a peer: sixteen faces a bank, float32.

Its sweep takes the forces and moves the nodes in one pass, column by column, so that its forces
alone are measured with a step that goes nowhere. A bank is always stepped whole: one face costs
what sixteen cost. It has Verlet only. The loops around the sweep are compiled at each start: kept
on disk, they would go on as they were when the sweep changes.
"""

from __future__ import annotations

import numba
import numpy as np

from engine.arrays import Float32Array, FloatArray, IntArray
from engine.dynamics import Skull, Tissue
from engine.lanes import WIDTH
from engine.lanes.network import Network, Order, arrange, order_columns
from engine.lanes.sweep import Faces, sweep
from engine.lanes.vector import aligned, load, splat, store

from .common import Blocks, Integrator, Tables, blocks_of, installed_version

F = np.float32
_entry = numba.njit(error_model="numpy")
"""Unlike parts of a kernel, these are called from outside."""


class LanesPeer:
    """The engine's kernel for many faces, float32, Verlet."""

    name = "lanes (float32)"
    unavailable: str | None = None
    integrators: tuple[Integrator, ...] = ("verlet",)

    _tables: Tables
    _layout: Blocks
    _order: Order
    _network: Network
    _banks: list[Faces]

    @property
    def version(self) -> str:
        """Version of numba, which compiles the kernels."""
        return f"numba {installed_version('numba')}"

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """See `Peer`."""
        self._tables = Tables(tissue)
        self._layout = blocks_of(faces, widths=(WIDTH,))
        self._order = order_columns(tissue)
        self._network = arrange(tissue, self._order)
        nodes, places = self._order.nodes, self._order.places
        at_rest = self._lay(self._crowd(tissue.rest), nodes)
        load, target, normal, bone = (
            self._lay(self._crowd(array), where)
            for array, where in (
                (skull.load, nodes),
                (skull.targets, places),
                (skull.normals, places),
                (skull.bone, places),
            )
        )
        self._banks = [
            Faces(
                x=at_rest[i],
                v=aligned(at_rest[i].size),
                force=load[i].copy(),
                load=load[i],
                target=target[i],
                travel=aligned(target[i].size),
                normal=normal[i],
                bone=bone[i],
                places=aligned(0),
            )
            for i in range(self._layout.count)
        ]
        self.evaluate(1)
        self.substeps(0, 1.0, "verlet")

    def force(self, x: FloatArray) -> FloatArray:
        """See `Peer`."""
        # With unit masses a step of one second gives every node its force as a velocity.
        unit = self._network._replace(inverse_mass=np.ones_like(self._network.inverse_mass))
        found = []
        for bank, place in zip(self._banks, self._lay(x, self._order.nodes), strict=True):
            trial = bank._replace(x=place, v=aligned(place.size), force=bank.load.copy())
            sweep_often(trial, unit, 1, F(0.0), F(1.0), F(0.0))
            found.append(trial.v)
        return self._faces(found)

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """See `Peer`."""
        nodes = self._order.nodes
        moving = v * (self._tables.inverse_mass > 0.0)
        for bank, at, speed in zip(
            self._banks, self._lay(x, nodes), self._lay(moving, nodes), strict=True
        ):
            bank.x[:], bank.v[:], bank.force[:] = at, speed, bank.load

    def where(self) -> tuple[FloatArray, FloatArray]:
        """See `Peer`."""
        return self._faces([b.x for b in self._banks]), self._faces([b.v for b in self._banks])

    def evaluate(self, count: int) -> None:
        """See `Peer`; the step that comes along changes nothing."""
        for bank in self._banks:
            sweep_often(bank, self._network, count, F(1.0), F(0.0), F(0.0))

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """See `Peer`."""
        half = 0.5 * dt * self._tables.damping
        keep, gain = F((1.0 - half) / (1.0 + half)), F(dt / (1.0 + half))
        for bank in self._banks:
            drift(bank.x, bank.v, F(0.5 * dt))
            if count:
                sweep_often(bank, self._network, count - 1, keep, gain, F(dt))
                sweep_often(bank, self._network, 1, keep, gain, F(0.5 * dt))

    def _crowd(self, face: FloatArray) -> FloatArray:
        """Return (3, a) for every face, shape (faces, 3, a)."""
        return np.broadcast_to(face, (self._layout.faces, *face.shape))

    def _lay(self, faces: FloatArray, places: IntArray) -> list[Float32Array]:
        """Return (faces, 3, a) as each bank's flat array, entry i at `places[i]`."""
        banks = []
        for block in self._layout.pack(np.swapaxes(faces, 1, 2)):
            flat = aligned(block.size)
            flat.reshape(-1, 3, WIDTH)[places] = block
            banks.append(flat)
        return banks

    def _faces(self, banks: list[Float32Array]) -> FloatArray:
        """Return the banks' flat arrays of nodes as (faces, 3, nodes)."""
        nodes = np.stack([bank.reshape(-1, 3, WIDTH)[self._order.nodes] for bank in banks])
        return np.ascontiguousarray(np.swapaxes(self._layout.unpack(nodes), 1, 2))


@_entry
def sweep_often(
    faces: Faces,
    net: Network,
    count: int,
    keep: np.float32,
    gain: np.float32,
    drift: np.float32,
) -> None:
    """Sweep a bank `count` times, without contact: see `engine.lanes.sweep`."""
    for _ in range(count):
        sweep(faces, net, F(0.0), keep, gain, drift)


@_entry
def drift(x: Float32Array, v: Float32Array, time: np.float32) -> None:
    """Move every node as its velocity says."""
    for i in range(0, x.shape[0], WIDTH):
        store(x, i, load(x, i) + splat(time) * load(v, i))
