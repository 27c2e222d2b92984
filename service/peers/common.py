"""What every peer shares: what it promises, the tables of a tissue, and the layout of faces.

All peers compute `engine.dynamics.static_forces` without plate and moving muscles, in float32: of
many faces it is the faster. They keep displacements from rest in place of positions, and add what a
difference is at rest: a float32 position of 100 mm is known to 8 nm, which the springs' stiffness
turns into 5e-5 of the net force, a displacement more than ten times better. Faces lie in blocks of
lanes, the lane innermost, so that one instruction serves as many faces. Each face has a skull side
of its own, as in a simulator.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from importlib import metadata, util
from typing import Literal, Protocol

import numpy as np
import numpy.typing as npt

from engine import InvalidValue
from engine.arrays import Float32Array, FloatArray, IntArray
from engine.dynamics import LEAST_VOLUME, MOST_VOLUME, Skull, Tissue

Integrator = Literal["rk2", "verlet"]
"""Midpoint Runge-Kutta, two force evaluations a step, or position Verlet, one."""

EVALUATIONS: dict[Integrator, int] = {"rk2": 2, "verlet": 1}
"""Force evaluations of a step."""

INTEGRATORS: tuple[Integrator, ...] = tuple(EVALUATIONS)

MOST_LANES = 16
"""Faces side by side: float32 numbers in the widest vector register, and in a cache line."""


class Peer(Protocol):
    """One way to write the forces, for faces that all have the same tissue.

    `prepare` comes first, and as often as wanted; it puts every face at rest. Contact is left out.
    A node whose inverse mass is 0 does not move.
    """

    @property
    def name(self) -> str:
        """What it is written with."""

    @property
    def version(self) -> str:
        """Version of what it is written with, or "" if that is not installed."""

    @property
    def unavailable(self) -> str | None:
        """Why it cannot run here, or None."""

    @property
    def integrators(self) -> tuple[Integrator, ...]:
        """Which steps it has."""

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """Build and compile what is needed for `faces` faces at rest.

        Raises:
            InvalidValue: If the tissue has a term that the peers lack, or for no faces.
        """

    def force(self, x: FloatArray) -> FloatArray:
        """Return the forces at positions `x`, mm; both have shape (faces, 3, nodes)."""

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """Put the faces at `x`, mm, with velocities `v`, mm/s, shapes (faces, 3, nodes)."""

    def where(self) -> tuple[FloatArray, FloatArray]:
        """Return positions and velocities, shapes (faces, 3, nodes)."""

    def evaluate(self, count: int) -> None:
        """Compute the forces of all faces where they stand, `count` times."""

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """Advance all faces by `count` steps of `dt` seconds."""


def installed_version(package: str) -> str:
    """Return the version of an installed package, "" of a missing one."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""


def missing(module: str, package: str) -> str | None:
    """Return why `module` cannot be used, or None if it can be found."""
    if util.find_spec(module) is None:
        return f"{package} is not installed: pip install 'risorius[bench]'"
    return None


@dataclass(frozen=True, eq=False)
class Springs:
    """Springs as a peer wants them, one a column.

    Attributes:
        first, second: Ends, shape (s,).
        along: From the first to the second at rest, mm, shape (3, s).
        law: Rest length, k_L, k_H - k_L, guard, and the stretches, mm, at which the second phase
            and the guard set in, shape (6, s).
    """

    first: IntArray
    second: IntArray
    along: FloatArray
    law: FloatArray


@dataclass(frozen=True, eq=False)
class Volumes:
    """Elements of volume V = ½ (p x r) · h: first the prisms, then the columns of fat.

    Attributes:
        prisms: Upper nodes of each prism, shape (3, prisms); p and r go from the first to the
            second and third half way between the layers, h is the mean of its columns.
        quads: Epidermis nodes of each column of fat, shape (4, quads); p and r are the diagonals of
            the mid-surface, h goes from the bone to its middle.
        p, r: At rest, mm, shape (3, elements).
        h: At rest, without what of fat is the skull's, mm, shape (3, elements).
        law: 1/V0, k/V0, order, least and most share of the volume, shape (5, elements).
        least: Share below which `order` counts.
    """

    prisms: IntArray
    quads: IntArray
    p: FloatArray
    r: FloatArray
    h: FloatArray
    law: FloatArray
    least: float


@dataclass(frozen=True, eq=False)
class Ties:
    """Anchors of the hypodermis.

    Attributes:
        law: Tangential stiffness, normal less tangential, of the excess, of the wall, shape (4, n).
        excess_distance, gap: Where the last two set in, mm.
    """

    law: FloatArray
    excess_distance: float
    gap: float


@dataclass(frozen=True, eq=False)
class Bones:
    """The skull side of one face.

    Attributes:
        targets: Of the anchors, from the hypodermis at rest, mm, shape (3, n).
        normals: Of the skull, shape (3, n).
        load: Dead load, shape (3, nodes).
        depth: h of each column of fat at rest, mm, shape (3, quads).
    """

    targets: FloatArray
    normals: FloatArray
    load: FloatArray
    depth: FloatArray


class Tables:
    """A tissue taken apart: everything that does not change while faces move."""

    def __init__(self, tissue: Tissue) -> None:
        """Take `tissue` apart.

        Raises:
            InvalidValue: If it has a term that the peers lack.
        """
        if tissue.springs.literal or len(tissue.plate.values):
            raise InvalidValue("peers have continuous springs and no plate; take such a rig")
        self.rest = tissue.rest
        self.nodes = tissue.rest.shape[1]
        self.points = self.nodes // 3
        self.inverse_mass = tissue.inverse_mass
        self.damping = tissue.damping
        self._tissue = tissue

    @cached_property
    def springs(self) -> Springs:
        """The springs."""
        s = self._tissue.springs
        phases = s.threshold * s.rest, -s.guard_strain * s.rest
        return Springs(
            s.first.astype(np.int64),
            s.second.astype(np.int64),
            self.rest[:, s.second] - self.rest[:, s.first],
            np.stack([s.rest, s.low, s.high - s.low, s.guard, *phases]),
        )

    @cached_property
    def volumes(self) -> Volumes:
        """The elements and the columns of fat."""
        prisms, fat, n = self._tissue.prisms, self._tissue.pressure, self.points
        corners, quads = prisms.corners.T, fat.quads.T
        upper, lower = self.rest[:, corners], self.rest[:, corners + n]
        middle = 0.5 * (upper + lower)
        diagonal = self.middle[:, quads]
        nothing, open_ended = np.zeros(quads.shape[1]), np.full(quads.shape[1], math.inf)
        limits = np.ones((2, corners.shape[1])) * [[LEAST_VOLUME], [MOST_VOLUME]]
        volume = np.concatenate([prisms.volume, fat.volume])
        law = [
            1.0 / volume,
            np.concatenate([prisms.stiffness, fat.stiffness]) / volume,
            np.concatenate([prisms.order, nothing]),
            np.concatenate([limits[0], -open_ended]),
            np.concatenate([limits[1], open_ended]),
        ]
        return Volumes(
            np.ascontiguousarray(corners, np.int64),
            np.ascontiguousarray(quads, np.int64),
            _beside(middle[:, 1] - middle[:, 0], diagonal[:, 2] - diagonal[:, 0]),
            _beside(middle[:, 2] - middle[:, 0], diagonal[:, 3] - diagonal[:, 1]),
            _beside((upper - lower).mean(axis=1), np.zeros((3, quads.shape[1]))),
            np.stack(law),
            prisms.least,
        )

    @cached_property
    def ties(self) -> Ties:
        """The anchors."""
        a = self._tissue.anchors
        stiffness = (
            a.tangential,
            a.normal - a.tangential,
            a.excess * a.tangential,
            a.skull * a.normal,
        )
        return Ties(np.stack(stiffness), a.excess_distance, a.skull_gap)

    @cached_property
    def middle(self) -> FloatArray:
        """The mid-surface at rest, mm, shape (3, n)."""
        return np.asarray(self.rest.reshape(3, 3, -1).mean(axis=1))

    def bones(self, skull: Skull) -> Bones:
        """Return the skull side as a peer wants it."""
        depth = (self.middle - skull.bone)[:, self.volumes.quads].mean(axis=1)
        hypodermis = self.rest[:, 2 * self.points :]
        return Bones(skull.targets - hypodermis, skull.normals, skull.load, depth)


def _beside(prisms: FloatArray, fat: FloatArray) -> FloatArray:
    return np.concatenate([prisms, fat], axis=1)


@dataclass(frozen=True)
class Blocks:
    """How many faces lie in blocks of lanes: shape (blocks, nodes, 3, lanes) or the like.

    Lanes that no face has are copies of the last one.
    """

    faces: int
    lanes: int

    @property
    def count(self) -> int:
        """How many blocks there are."""
        return -(-self.faces // self.lanes)

    def pack(self, faces: FloatArray) -> Float32Array:
        """Return (faces, a, b) as (blocks, a, b, lanes), in float32."""
        last = np.full(self.count * self.lanes - self.faces, self.faces - 1)
        padded = faces[np.concatenate([np.arange(self.faces), last])]
        split = padded.reshape(self.count, self.lanes, *faces.shape[1:])
        return np.ascontiguousarray(np.moveaxis(split, 1, -1), dtype=np.float32)

    def spread(self, face: FloatArray) -> Float32Array:
        """Return (a, b), the same for every face, as (blocks, a, b, lanes), in float32."""
        return self.pack(np.broadcast_to(face, (self.faces, *face.shape)))

    def unpack(self, blocks: npt.NDArray[np.float32]) -> FloatArray:
        """Return (blocks, a, b, lanes) as (faces, a, b), in float64."""
        lanes_first = np.moveaxis(blocks.astype(np.float64), -1, 1)
        return np.ascontiguousarray(lanes_first.reshape(-1, *blocks.shape[1:3])[: self.faces])


def blocks_of(faces: int, *, widths: tuple[int, ...]) -> Blocks:
    """Return blocks for `faces` faces, of the least of `widths` that holds them, or of the most.

    Raises:
        InvalidValue: For no faces.
    """
    if faces < 1:
        raise InvalidValue(f"a peer moves at least one face, not {faces}")
    return Blocks(faces, next((width for width in widths if width >= faces), widths[-1]))
