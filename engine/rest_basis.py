"""What each muscle does to each node at rest, made muscle by muscle and kept.

A row follows from its muscle and from the ground that it acts on, which most edits of tissue leave
as it is. Whoever drags a slider has the rows made that it changes, and no other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np

from .arrays import BoolArray, FloatArray
from .cache import content_key
from .force_basis import Samples, force_density, press_density
from .head import Head
from .muscle import AirPressure, LidMuscle, Muscle, gain_at
from .tissue import TissueModel
from .tissue.layers import Sheet

QUADRATURE = 4
"""Points along each side of a quad at which weights are integrated."""
ROWS_KEPT = 256
"""Rows kept in memory: five faces' and their edits', some 15 MB."""


@dataclass(frozen=True)
class Ground:
    """What of a face's tissue its muscles' forces follow from; equal where its content is.

    Attributes:
        key: Hash of all that follows.
        sheet: The surface.
        nodes: Its nodes.
        scale: Node area over reference area, shape (n,).
        held: Nodes that no muscle moves, shape (n,).
        quadrature: Whether weights are integrated over polygons; else they are taken at nodes.
        smoothing: Passes of smoothing.
    """

    key: str
    sheet: Sheet = field(compare=False)
    nodes: Samples = field(compare=False)
    scale: FloatArray = field(compare=False)
    held: BoolArray = field(compare=False)
    quadrature: bool = field(compare=False)
    smoothing: int = field(compare=False)

    @cached_property
    def grid(self) -> tuple[Samples, FloatArray, FloatArray]:
        """Sample points over every polygon, their bilinear weights, and the area of each."""
        sheet, nodes = self.sheet, self.nodes
        shape = _bilinear(QUADRATURE)
        corners = np.where(sheet.polygons >= 0, sheet.polygons, sheet.polygons[:, :1])
        points = np.einsum("gk,pkc->pgc", shape, nodes.points[corners]).reshape(-1, 3)
        normals = np.einsum("gk,pkc->pgc", shape, nodes.normals[corners]).reshape(-1, 3)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        jaw = np.einsum("gk,pk->pg", shape, nodes.jaw[corners]).ravel()
        reference = sheet.node_area.mean() / self.scale.mean()
        area = np.repeat(sheet.polygon_area / (reference * len(shape)), len(shape))
        return Samples(points, normals, jaw), shape, area

    @property
    def samples(self) -> Samples:
        """Where muscles are evaluated."""
        return self.grid[0] if self.quadrature else self.nodes

    def force(self, density: FloatArray) -> FloatArray:
        """Return the force on each node, shape (n, 3), of a density at `samples`, shape (k, 3)."""
        if self.quadrature:
            _, shape, area = self.grid
            return self._smooth(self._lump(shape, density * area[:, None]))
        return self._smooth(density * self.scale[:, None])

    def _lump(self, shape: FloatArray, density: FloatArray) -> FloatArray:
        polygons = self.sheet.polygons
        corners = np.where(polygons >= 0, polygons, polygons[:, :1])
        share = np.einsum("gk,pgc->pkc", shape, density.reshape(len(polygons), len(shape), 3))
        force = np.zeros((len(self.scale), 3))
        for k in range(4):
            np.add.at(force, corners[:, k], share[:, k])
        return force

    def _smooth(self, force: FloatArray) -> FloatArray:
        """Return `force` with its density smoothed over neighbours, its resultant restored."""
        area = np.maximum(self.scale, 0.05)[:, None]
        for _ in range(self.smoothing):
            density = force / area
            smoothed = (0.5 * density + 0.5 * (self.sheet.neighbor_mean @ density)) * area
            before = math.sqrt((force.sum(axis=0) ** 2).sum())
            after = math.sqrt((smoothed.sum(axis=0) ** 2).sum())
            force = smoothed * (before / after) if before > 1.0e-3 and after > 0.0 else smoothed
        return force


def ground_of(head: Head, tissue: TissueModel) -> Ground:
    """Return what `head`'s muscles act on.

    Args:
        head: The head; its jaw weights tell upper from lower lip.
        tissue: Its tissue.
    """
    sheet, parameters = tissue.sheet, tissue.parameters
    nodes = Samples(sheet.points, tissue.layers.normals, head.jaw_weight[: tissue.node_count])
    rest = (tissue.scale, tissue.held, parameters.force_quadrature, parameters.force_smoothing)
    key = content_key(nodes.points, nodes.normals, nodes.jaw, sheet.polygons, *rest)
    return Ground(key, sheet, nodes, *rest)


def rest_basis(
    ground: Ground,
    muscles: Sequence[Muscle],
    *,
    strength: float,
    ring: str,
    pressing_only: bool = False,
) -> FloatArray:
    """Return each muscle's force on the hypodermis at activation 1, shape (m, 3, n).

    Args:
        ground: From `ground_of`.
        muscles: In the rig's order; lid muscles give rows of zeros.
        strength: `muscle_strength` of the tissue.
        ring: Profile of sphincters, "ring" or "literal".
        pressing_only: Leave out what pulls, as mode "current" has it moving with the skin.
    """
    basis = np.zeros((len(muscles), 3, len(ground.scale)))
    for row, muscle in enumerate(muscles):
        if isinstance(muscle, LidMuscle):
            continue
        # How strong it is scales a row that is kept, and where it is from is nobody's business.
        plain = replace(muscle, force_scale=1.0, gain=(1.0, 1.0), source="")
        force = _row(ground, plain, ring, pressing_only)
        gain = gain_at(muscle, ground.nodes.points[:, 0])
        if not isinstance(muscle, AirPressure):  # Air is as strong in a weak face.
            gain = strength * gain
        basis[row] = gain * (muscle.force_scale * force.T)
    return basis


@lru_cache(maxsize=ROWS_KEPT)
def _row(ground: Ground, muscle: Muscle, ring: str, pressing_only: bool) -> FloatArray:
    """Return the force of one muscle on each node, but for its strength, shape (n, 3)."""
    samples = ground.samples
    force = ground.force(press_density(muscle, samples))
    if not pressing_only:
        force += ground.force(force_density(muscle, samples, ring=ring))
    force[ground.held] = 0.0
    force.flags.writeable = False
    return force


def _bilinear(count: int) -> FloatArray:
    grid = (np.arange(count) + 0.5) / count
    return np.array(
        [[(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v] for u in grid for v in grid]
    )
