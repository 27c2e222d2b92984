"""A bank: the arrays of sixteen faces of one rig, stepped together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Float32Array, FloatArray
from ..timeline import TICKS_PER_SECOND
from ..top_speed import ALONG_AN_AXIS, held_back
from .advance import advance
from .network import NODE, Network, Order, arrange, order_columns
from .posing import Lidding, Posing, pose, posing_of, turn_lids
from .surface import Following, fare, following, remember, surface
from .sweep import Faces
from .touching import Touching, touching
from .vector import WIDTH, aligned

if TYPE_CHECKING:
    from ..assembly import Assembly


@dataclass(frozen=True, eq=False)
class Plan:
    """A compiled rig as the kernels of a bank read it; shared by all banks of the rig."""

    order: Order
    network: Network
    touching: Touching
    posing: Posing
    lidding: Lidding
    following: Following
    rest: Float32Array
    channels: int
    muscles: int
    substeps: int
    slide: float
    points: int


@lru_cache(maxsize=16)
def plan_of(assembly: Assembly) -> Plan:
    """Return what the banks of `assembly` share."""
    tissue, rig = assembly.tissue, assembly.rig
    order, n = order_columns(tissue.arrays), tissue.node_count
    lids, weight = tissue.lids, rig.head.jaw_weight[:n]
    posing = posing_of(tissue, rig.jaw, weight, assembly.basis, order)
    return Plan(
        order=order,
        network=arrange(tissue.arrays, order),
        touching=touching(tissue.arrays, order),
        posing=posing,
        lidding=Lidding(
            turns=assembly.lid_angles,
            pitch=rig.channels.index("gaze", "pitch"),
            skin=(NODE * order.nodes[lids.skin]).astype(np.int32),
            channel=lids.skin_channel,
            place=np.ascontiguousarray(lids.skin_place),
            center=np.ascontiguousarray(lids.skin_center),
            shares=assembly.lid_shares,
            opening=lids.opening,
        ),
        following=following(rig.head, rig.jaw.center, order),
        rest=posing.rest,
        channels=rig.channels.count,
        muscles=rig.channels.muscle_count,
        substeps=assembly.substeps,
        slide=rig.jaw.slide,
        points=len(rig.head.points),
    )


class Bank:
    """Up to sixteen faces of one rig; lanes that nobody has taken stay at rest.

    Attributes:
        faces: The arrays, as kernels take them.
        signals: Activations, jaw, gaze and head of each lane, shape (16, channels).
        speed: How fast a node of each lane went in the last tick, along one axis, mm/s.
        lost: How many components of each lane were too far from rest, or no numbers.
    """

    def __init__(self, plan: Plan, *, farthest: float) -> None:
        """Lay out sixteen faces at rest.

        Args:
            plan: Of their rig.
            farthest: Displacement from which a face counts as lost, mm.
        """
        self._plan, self._farthest = plan, farthest
        n = len(plan.order.columns)
        sizes = (*(9 * n,) * 4, *(3 * n,) * 4, 9 * len(plan.posing.held))
        self.faces = Faces(*(aligned(size * WIDTH) for size in sizes))
        self._targets = np.ascontiguousarray(plan.rest.reshape(n, 3, 3)[:, 2])
        self._before = aligned(9 * n * WIDTH)
        self._moved = aligned(3 * plan.points * WIDTH)
        self._jaw, self._lids = aligned(3 * WIDTH), aligned(4 * WIDTH)
        self._activations, self._fared = aligned(plan.muscles * WIDTH), aligned(2 * WIDTH)
        self.signals: FloatArray = np.zeros((WIDTH, plan.channels))
        for lane in range(WIDTH):
            self.clear(lane)

    @property
    def speed(self) -> Float32Array:
        """How fast a node of each lane went in the last tick, along one axis, mm/s, (16,)."""
        return np.float32(TICKS_PER_SECOND) * self._fared[:WIDTH]

    @property
    def lost(self) -> Float32Array:
        """How many components of each lane are too far from rest, or no numbers, shape (16,)."""
        return self._fared[WIDTH:]

    def seat(self, lane: int, x: FloatArray, v: FloatArray, targets: FloatArray | None) -> None:
        """Put a face into a lane.

        Args:
            lane: Which.
            x: Positions, mm, shape (3, nodes).
            v: Velocities, mm/s, shape (3, nodes).
            targets: Where its ties are held, mm, shape (3, n); where they are at rest if None.
        """
        order, faces = self._plan.order, self.faces
        self.clear(lane)
        _nodes(faces.x)[order.nodes, :, lane] = x.T
        _nodes(faces.v)[order.nodes, :, lane] = v.T
        _nodes(self._before)[order.nodes, :, lane] = x.T
        if targets is not None:
            _nodes(faces.target)[order.places, :, lane] = targets.T

    def read(self, lane: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return positions, velocities and the ties' targets of a lane, as `seat` takes them."""
        order, faces = self._plan.order, self.faces
        x, v = (_nodes(array)[order.nodes, :, lane] for array in (faces.x, faces.v))
        targets = _nodes(faces.target)[order.places, :, lane]
        return _rows(x), _rows(v), _rows(targets)

    def clear(self, lane: int) -> None:
        """Put a lane to rest."""
        _nodes(self.faces.x)[:, :, lane] = self._plan.rest.reshape(-1, 3)
        _nodes(self._before)[:, :, lane] = self._plan.rest.reshape(-1, 3)
        _nodes(self.faces.v)[:, :, lane] = 0.0
        _nodes(self.faces.target)[:, :, lane] = self._targets
        self.signals[lane] = 0.0

    def step(self) -> FloatArray:
        """Advance a tick with the signals as they are.

        Returns:
            Displacements from rest of every lane, mm, shape (16, s, 3).
        """
        self.pose()
        self.advance()
        return self.look()

    def advance(self) -> None:
        """Move the tissue by a tick, between skull and muscles as they are posed."""
        plan = self._plan
        advance(
            self.faces,
            plan.network,
            plan.touching,
            plan.posing,
            plan.substeps,
            1.0 / (TICKS_PER_SECOND * plan.substeps),
        )

    def look(self) -> FloatArray:
        """Note how the faces fare, and return what is seen of them, as `step` does."""
        plan, faces = self._plan, self.faces
        self._fare()
        remember(faces.x, self._before)
        seen = np.empty((WIDTH, plan.points, 3))
        surface(faces.x, plan.following, self._jaw, self._moved, seen)
        return seen

    def _fare(self) -> None:
        """See how the faces fare, and hold back those whose tissue goes faster than it may."""
        plan, faces = self._plan, self.faces
        fare(faces.x, self._before, plan.rest, self._farthest, self._fared)
        hasty = np.flatnonzero(self._fared[:WIDTH] > ALONG_AN_AXIS)
        if not len(hasty):
            return
        for lane in hasty:
            x, v, before = (_nodes(array)[:, :, lane] for array in (faces.x, faces.v, self._before))
            slower = held_back(x.T, v.T, before.T)
            x[:], v[:] = slower[0].T, slower[1].T
        fare(faces.x, self._before, plan.rest, self._farthest, self._fared)

    def pose(self) -> None:
        """Set jaw, lids and muscles to where the signals have them at the end of the tick."""
        plan, signals, m = self._plan, self.signals, self._plan.muscles
        pitch, yaw, thrust = signals[:, m], signals[:, m + 1], signals[:, m + 2]
        self._jaw.reshape(3, WIDTH)[:] = (
            np.radians(pitch),
            -np.radians(yaw),
            plan.slide * pitch + thrust,
        )
        self._activations.reshape(-1, WIDTH)[:] = signals[:, :m].T
        turn_lids(self.faces.x, signals, plan.lidding, self._lids)
        pose(
            self.faces,
            plan.posing,
            self._jaw,
            self._lids,
            self._activations,
            float(TICKS_PER_SECOND),
        )


def _nodes(array: Float32Array) -> Float32Array:
    """Return a flat array by node, component and lane."""
    return array.reshape(-1, 3, WIDTH)


def _rows(values: Float32Array) -> FloatArray:
    """Return one lane's nodes, shape (k, 3), as components, shape (3, k)."""
    return np.ascontiguousarray(values.T, dtype=np.float64)
