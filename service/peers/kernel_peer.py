"""The reference kernels in the form of a peer, so that they do the same work to be measured.

One face after another in float64, as a simulator steps faces alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine import InvalidValue
from engine.arrays import FloatArray
from engine.dynamics import (
    TABLEAUS,
    Pull,
    Skull,
    Tissue,
    Workspace,
    advance,
    static_forces,
    workspace,
)

from .common import INTEGRATORS, Integrator, installed_version


class _Face(NamedTuple):
    """What a simulator keeps of a face."""

    x: FloatArray
    v: FloatArray
    skull: Skull
    work: Workspace


class KernelPeer:
    """The engine's kernels for one face, float64."""

    name = "alone (float64)"
    unavailable: str | None = None
    integrators = INTEGRATORS

    _tissue: Tissue
    _pull: Pull
    _faces: list[_Face]

    @property
    def version(self) -> str:
        """Version of numba, which compiles the kernels."""
        return f"numba {installed_version('numba')}"

    def prepare(self, tissue: Tissue, skull: Skull, faces: int) -> None:
        """See `Peer`."""
        if faces < 1:
            raise InvalidValue(f"a peer moves at least one face, not {faces}")
        self._tissue = without_contact(tissue)
        self._pull = nobody_pulls(tissue)
        still = np.zeros_like(tissue.rest)
        self._faces = [
            _Face(
                tissue.rest.copy(),
                still.copy(),
                Skull(*(array.copy() for array in skull)),
                workspace(tissue),
            )
            for _ in range(faces)
        ]
        self.evaluate(1)
        self.substeps(0, 1.0, "rk2")

    def force(self, x: FloatArray) -> FloatArray:
        """See `Peer`."""
        return np.stack(
            [self._force(face, place).copy() for face, place in zip(self._faces, x, strict=True)]
        )

    def place(self, x: FloatArray, v: FloatArray) -> None:
        """See `Peer`."""
        for face, place, speed in zip(self._faces, x, v, strict=True):
            face.x[:] = place
            face.v[:] = speed * (self._tissue.inverse_mass > 0.0)

    def where(self) -> tuple[FloatArray, FloatArray]:
        """See `Peer`."""
        return np.stack([f.x for f in self._faces]), np.stack([f.v for f in self._faces])

    def evaluate(self, count: int) -> None:
        """See `Peer`."""
        for face in self._faces:
            for _ in range(count):
                self._force(face, face.x)

    def substeps(self, count: int, dt: float, integrator: Integrator) -> None:
        """See `Peer`."""
        for face in self._faces:
            tableau, tissue = TABLEAUS[integrator], self._tissue
            advance(face.x, face.v, count, dt, tableau, tissue, face.skull, self._pull, face.work)

    def _force(self, face: _Face, x: FloatArray) -> FloatArray:
        force = face.work.force
        static_forces(x, self._tissue, face.skull, self._pull, face.work.scratch, force)
        return force


def without_contact(tissue: Tissue) -> Tissue:
    """Return `tissue` without lips, teeth and eyeballs to meet."""
    none = tissue.contacts._replace(
        upper_lip=np.zeros(0, np.int32),
        lower_lip=np.zeros(0, np.int32),
        tooth_nodes=np.zeros(0, np.int32),
        eye_nodes=np.zeros(0, np.int32),
    )
    return tissue._replace(contacts=none)


def nobody_pulls(tissue: Tissue) -> Pull:
    """Return no muscle of mode "current"."""
    points = tissue.rest.shape[1] // 3
    return Pull(np.zeros(0, np.int32), np.zeros((0, 21)), np.zeros(0), np.zeros((0, points)))
