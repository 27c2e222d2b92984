"""What the peers in array operations share: the laws of the terms, and the steps.

A block's arrays have shape (3, rows, lanes), float32. A row is a difference of displacements: first
one a spring, then p, r and h of the volumes. How rows come from nodes and forces from rows is the
peer's own. Operations write into arrays that are there already and go over `_CHUNK` numbers at a
time, which stay in the second level of the cache.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from engine.arrays import Float32Array, FloatArray
from engine.dynamics import Skull, Tissue

from .common import INTEGRATORS, MOST_LANES, Blocks, Integrator, Tables, blocks_of

_CHUNK = 16_384


class _Laws(NamedTuple):
    """Constants repeated for each lane: numbers that meet in memory as they meet in the law."""

    along: Float32Array
    springs: Float32Array
    at_rest: Float32Array
    volumes: Float32Array
    ties: Float32Array


class _Block(NamedTuple):
    """One block of faces: displacements, velocities, and the skull sides."""

    u: Float32Array
    v: Float32Array
    targets: Float32Array
    normals: Float32Array
    load: Float32Array
    depth: Float32Array


class ArrayPeer(ABC):
    """A peer in array operations, without the way between nodes and rows."""

    integrators = INTEGRATORS

    _tables: Tables
    _layout: Blocks
    _laws: _Laws
    _blocks: list[_Block]

    @property
    def unavailable(self) -> str | None:
        """None: what it takes, the engine takes too."""
        return None

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """See `Peer`."""
        tables = Tables(tissue)
        self._tables = tables
        self._layout = blocks_of(faces, widths=tuple(range(1, MOST_LANES + 1)))
        self._springs = len(tables.springs.first)
        self._elements = tables.volumes.p.shape[1]
        rows, lanes = self._springs + 3 * self._elements, self._layout.lanes
        self._laws = self._repeated()
        self._rows = np.zeros((3, rows, lanes), np.float32)
        self._force = np.zeros((3, tables.nodes, lanes), np.float32)
        self._mid_u, self._mid_v = np.zeros_like(self._force), np.zeros_like(self._force)
        self._scratch = np.zeros((4, max(rows, tables.nodes), lanes), np.float32)
        self._inverse_mass = np.repeat(
            tables.inverse_mass.astype(np.float32)[:, None], lanes, axis=1
        )
        bones, still = tables.bones(skull), np.zeros((3, tables.nodes))
        parts = still, still, bones.targets, bones.normals, bones.load, bones.depth
        self._blocks = [
            _Block(*arrays) for arrays in zip(*map(self._layout.spread, parts), strict=True)
        ]
        self._link()

    def force(self, x: FloatArray) -> FloatArray:
        """See `Peer`."""
        found = []
        for u, block in zip(self._layout.pack(x - self._tables.rest), self._blocks, strict=True):
            self._forces(u, block)
            found.append(self._force.copy())
        return self._layout.unpack(np.stack(found))

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """See `Peer`."""
        moving = v * (self._tables.inverse_mass > 0.0)
        us, vs = self._layout.pack(x - self._tables.rest), self._layout.pack(moving)
        self._blocks = [
            block._replace(u=u, v=v) for block, u, v in zip(self._blocks, us, vs, strict=True)
        ]

    def where(self) -> tuple[FloatArray, FloatArray]:
        """See `Peer`."""
        u = self._layout.unpack(np.stack([block.u for block in self._blocks]))
        v = self._layout.unpack(np.stack([block.v for block in self._blocks]))
        return u + self._tables.rest, v

    def evaluate(self, count: int) -> None:
        """See `Peer`."""
        for block in self._blocks:
            for _ in range(count):
                self._forces(block.u, block)

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """See `Peer`."""
        step = self._midpoint if integrator == "rk2" else self._verlet
        for block in self._blocks:
            for _ in range(count):
                step(block, np.float32(dt))

    @abstractmethod
    def _link(self) -> None:
        """Build what `_gather` and `_scatter` need."""

    @abstractmethod
    def _gather(self, u: Float32Array, rows: Float32Array) -> None:
        """Set `rows` to the differences of `u`, shape (3, nodes, lanes)."""

    @abstractmethod
    def _scatter(self, rows: Float32Array, force: Float32Array) -> None:
        """Set `force`, shape (3, nodes, lanes), to what `rows` do to the nodes.

        That is the transpose of `_gather`, but tensions with the other sign: a spring draws its
        first end along d.
        """

    def _repeated(self) -> _Laws:
        tables = self._tables
        springs, volumes = tables.springs, tables.volumes
        at_rest = np.concatenate([volumes.p, volumes.r, volumes.h], axis=1)
        return _Laws(
            *(
                np.repeat(a.astype(np.float32)[..., None], self._layout.lanes, axis=-1)
                for a in (springs.along, springs.law, at_rest, volumes.law, tables.ties.law)
            )
        )

    def _chunks(self, rows: int) -> Iterator[slice]:
        step = max(1, _CHUNK // self._layout.lanes)
        return (slice(start, min(start + step, rows)) for start in range(0, rows, step))

    def _forces(self, u: Float32Array, block: _Block) -> None:
        """Set the force of `block` at the displacements `u`."""
        rows, s, e = self._rows, self._springs, self._elements
        self._gather(u, rows)
        for chunk in self._chunks(s):
            self._spring_law(chunk)
        rows[:, s:] += self._laws.at_rest
        rows[:, rows.shape[1] - block.depth.shape[1] :] += block.depth
        for chunk in self._chunks(e):
            self._volume_law(chunk)
        self._scatter(rows, self._force)
        self._force += block.load
        self._tie(u, block)

    def _spring_law(self, chunk: slice) -> None:
        """Turn each d into its tension (Eqs. 19-20), in place."""
        d = self._rows[:, chunk]
        rest, low, rise, guard, threshold, guard_at = self._laws.springs[:, chunk]
        length, stretch, over, under = self._scratch[:, : len(rest)]
        d += self._laws.along[:, chunk]
        _norm(d, length, over)
        np.subtract(length, rest, out=stretch)
        np.subtract(stretch, threshold, out=over)
        np.maximum(over, 0.0, out=over)
        over *= rise
        np.subtract(stretch, guard_at, out=under)
        np.minimum(under, 0.0, out=under)
        under *= guard
        stretch *= low
        stretch += over
        stretch += under
        stretch /= length
        d *= stretch

    def _volume_law(self, chunk: slice) -> None:
        """Turn p, r and h of each element into -k (V/V0 - 1) ∂V/V0 by each of them, in place."""
        s, e = self._springs, self._elements
        p, r, h = (self._rows[:, s + k * e :][:, chunk] for k in range(3))
        inverse, stiffness, order, least, most = self._laws.volumes[:, chunk]
        gradients = np.empty((3, 3, *inverse.shape), np.float32)
        spare, share, pressed, _ = self._scratch[:, : len(inverse)]
        for out, (one, other) in zip(gradients, ((r, h), (h, p), (p, r)), strict=True):
            _cross(one, other, out, spare)
        np.multiply(gradients[2, 0], h[0], out=share)
        for c in (1, 2):
            np.multiply(gradients[2, c], h[c], out=spare)
            share += spare
        share *= inverse
        share *= 0.5
        np.maximum(share, least, out=share)
        np.minimum(share, most, out=share)
        np.subtract(share, self._tables.volumes.least, out=pressed)
        np.minimum(pressed, 0.0, out=pressed)
        pressed *= pressed
        pressed *= order
        np.subtract(1.0, share, out=share)
        share += pressed
        share *= stiffness
        share *= 0.5
        for gradient, out in zip(gradients, (p, r, h), strict=True):
            np.multiply(gradient, share, out=out)

    def _tie(self, u: Float32Array, block: _Block) -> None:
        """Add the skull's hold on the hypodermis to the force."""
        ties, n = self._tables.ties, self._tables.points
        along, across, excess, wall = self._laws.ties
        gap = block.targets - u[:, 2 * n :]
        distance, depth, hold, spare = self._scratch[:, :n]
        _norm(gap, distance, spare)
        np.multiply(gap[0], block.normals[0], out=depth)
        for c in (1, 2):
            np.multiply(gap[c], block.normals[c], out=spare)
            depth += spare
        # No farther than the excess sets in, its share is 0.
        np.maximum(distance, ties.excess_distance, out=distance)
        np.divide(ties.excess_distance, distance, out=hold)
        np.subtract(1.0, hold, out=hold)
        hold *= excess
        hold += along
        gap *= hold
        np.subtract(depth, ties.gap, out=spare)
        np.maximum(spare, 0.0, out=spare)
        spare *= wall
        depth *= across
        depth += spare
        force = self._force[:, 2 * n :]
        force += gap
        force += depth * block.normals

    def _acceleration(self, v: Float32Array) -> Float32Array:
        """Turn the force into ẍ = M⁻¹ f - c ẋ (Eqs. 21-22), in place."""
        self._force *= self._inverse_mass
        self._force -= np.float32(self._tables.damping) * v
        return self._force

    def _midpoint(self, block: _Block, dt: np.float32) -> None:
        self._forces(block.u, block)
        slope = self._acceleration(block.v)
        np.multiply(block.v, np.float32(0.5) * dt, out=self._mid_u)
        self._mid_u += block.u
        np.multiply(slope, np.float32(0.5) * dt, out=self._mid_v)
        self._mid_v += block.v
        self._forces(self._mid_u, block)
        slope = self._acceleration(self._mid_v)
        self._mid_v *= dt
        np.add(block.u, self._mid_v, out=block.u)
        slope *= dt
        np.add(block.v, slope, out=block.v)

    def _verlet(self, block: _Block, dt: np.float32) -> None:
        half = np.float32(0.5) * dt
        drag = np.float32(self._tables.damping) * half
        self._drift(block, half)
        self._forces(block.u, block)
        self._force *= self._inverse_mass
        self._force *= dt / (1 + drag)
        np.multiply(block.v, (1 - drag) / (1 + drag), out=block.v)
        np.add(block.v, self._force, out=block.v)
        self._drift(block, half)

    def _drift(self, block: _Block, time: np.float32) -> None:
        np.multiply(block.v, time, out=self._mid_u)
        np.add(block.u, self._mid_u, out=block.u)


def _norm(vectors: Float32Array, out: Float32Array, spare: Float32Array) -> None:
    """Set `out` to the lengths of `vectors`, components first."""
    np.multiply(vectors[0], vectors[0], out=out)
    for c in (1, 2):
        np.multiply(vectors[c], vectors[c], out=spare)
        out += spare
    np.sqrt(out, out=out)


def _cross(one: Float32Array, other: Float32Array, out: Float32Array, spare: Float32Array) -> None:
    """Set `out` to one x other, components first."""
    for c in range(3):
        a, b = (c + 1) % 3, (c + 2) % 3
        np.multiply(one[a], other[b], out=out[c])
        np.multiply(one[b], other[a], out=spare)
        out[c] -= spare
