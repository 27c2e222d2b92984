"""A patch of curved skin with few nodes, for laws that must hold on any tissue."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray
from engine.dynamics import Pull, Skull, advance, scratch_for, static_forces, workspace
from engine.head import Head, head_from_mesh
from engine.tissue import TissueModel, TissueParameters, assemble, no_pull, rest_skull

FAT = TissueParameters(regional_depth=False, uniform_depth=14.0)
"""Skin as deep as the cheek's, so that the fat's pressure acts."""


def patch_head(count: int = 9, spacing: float = 13.0) -> Head:
    """Return a dome of `count` by `count` points, `spacing` mm apart, symmetric in x, open rim."""
    line = (np.arange(count) - (count - 1) / 2) * spacing
    x, y = np.meshgrid(line, line, indexing="ij")
    z = 20.0 - (x**2 + y**2) / 160.0
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    triangles, quads = [], []
    for i in range(count - 1):
        for j in range(count - 1):
            a, b = i * count + j, (i + 1) * count + j
            quads.append((a, b, b + 1, a + 1))
            triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    head = head_from_mesh(vertices, np.array(triangles), name="patch")
    return replace(head, polygons=np.array(quads), polygon_regions=tuple("cheek" for _ in quads))


@dataclass(frozen=True, eq=False)
class SmallTissue:
    """A patch's arrays, and the calls that tests make on them."""

    model: TissueModel
    skull: Skull
    pull: Pull

    def forces(self, x: FloatArray) -> FloatArray:
        """Return all static forces, shape (3, nodes)."""
        out = np.zeros_like(x)
        arrays = self.model.arrays
        static_forces(x, arrays, self.skull, self.pull, scratch_for(arrays), out)
        return out

    def loaded(self, load: FloatArray) -> SmallTissue:
        """Return the patch with `load`, shape (3, nodes), added to its dead load."""
        return replace(self, skull=self.skull._replace(load=self.skull.load + load))

    def run(
        self, x: FloatArray, v: FloatArray, steps: int, dt: float, tableau: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return positions and velocities after `steps` of `dt` seconds."""
        x, v = x.copy(), v.copy()
        work = workspace(self.model.arrays)
        advance(x, v, steps, dt, tableau, self.model.arrays, self.skull, self.pull, work)
        return x, v


def small_tissue(
    parameters: TissueParameters | None = None, *, literal: bool = False, anchored: bool = True
) -> SmallTissue:
    """Return a patch of tissue; not `anchored` it floats free, with no rim held."""
    head = patch_head()
    parameters = parameters or FAT
    model = assemble(head, parameters, literal_springs=literal)
    arrays = model.arrays
    if not anchored:
        n = model.node_count
        arrays = arrays._replace(
            anchors=arrays.anchors._replace(tangential=np.zeros(n), normal=np.zeros(n)),
            plate=arrays.plate._replace(
                start=np.zeros(1, np.int32), columns=np.zeros(0, np.int32), values=np.zeros(0)
            ),
            inverse_mass=np.full(3 * n, 1.0e-2),
            damping=0.0,
        )
        model = replace(model, arrays=arrays)
    skull = rest_skull(
        arrays, model.layers, model.dead_load if anchored else np.zeros_like(arrays.rest)
    )
    return SmallTissue(model, skull, no_pull(model.node_count))
