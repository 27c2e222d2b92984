"""The tissue file: all that lies under the skin, at rest, as sheets of nodes and springs as lines.

Four sheets of the same nodes lie under each other: epidermis, dermis, hypodermis and the skull's
side. Every node of the file has one of them, or one kind of spring over all of them; its extras say
which, so that a viewer can peel them (the paper's Fig. 8).
"""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..rig import Rig
from ..tissue import TissueModel, assemble
from .accessors import metres
from .builder import GlbBuilder
from .scene import file_extras

SHEETS = ("epidermis", "dermis", "hypodermis", "bone")
"""What lies under each other, outermost first; the points of springs come sheet by sheet."""


def tissue_to_glb(rig: Rig) -> bytes:
    """Return the tissue file of `rig` as GLB, in metres, in the head's frame.

    Nodes `epidermis` … `bone` are triangles, their extras `{"role": "sheet", "sheet": 0..3}`;
    `_JAW` of the bone is by how much of the jaw's turn each of its points rides. The others are
    lines over the points of all four sheets, one after the other, with the extras
    `{"role": "springs", "kind": "structural" | "shear" | "tie", "from": 0..2, "to": 0..3}`.
    """
    model = assemble(rig.head, rig.parameters, literal_springs=rig.model.springs == "literal")
    extras = file_extras(rig_id=rig.id, rig_name=rig.name)
    builder = GlbBuilder({**extras, "nodes": model.node_count})
    points = rest_points(model)
    for sheet, name in enumerate(SHEETS):
        attributes = {"POSITION": metres(points[sheet])}
        if name == "bone":
            attributes["_JAW"] = rig.head.jaw_weight[: model.node_count].astype(np.float32)
        primitive = builder.primitive(attributes, model.sheet.elements, material="skin")
        mesh = builder.mesh(name, [primitive])
        builder.node(name, mesh=mesh, extras={"role": "sheet", "sheet": sheet})
    for (kind, outer, inner), pairs in springs_of(model).items():
        title = f"{kind} {SHEETS[outer]}" + ("" if outer == inner else f" to {SHEETS[inner]}")
        line = builder.lines(metres(points.reshape(-1, 3)), pairs)
        said = {"role": "springs", "kind": kind, "from": outer, "to": inner}
        builder.node(title, mesh=builder.mesh(title, [line]), extras=said)
    return builder.to_bytes()


def rest_points(model: TissueModel) -> FloatArray:
    """Return the nodes of the four sheets at rest, mm, shape (4, n, 3)."""
    n = model.node_count
    layers = model.layers.nodes.reshape(3, n, 3)
    return np.concatenate([layers, model.layers.bone[None]])


def springs_of(model: TissueModel) -> dict[tuple[str, int, int], IntArray]:
    """Return the springs by kind and the sheets that they join, as pairs of points, shape (k, 2).

    Structural springs go along the edges of a sheet and straight down; shear springs across its
    polygons and from one sheet to another. A tie holds a node of the hypodermis over its bone.
    """
    n, springs = model.node_count, model.arrays.springs
    ends = np.stack([springs.first, springs.second], axis=1).astype(np.int64)
    sheets, nodes = ends // n, ends % n
    along = sheets[:, 0] == sheets[:, 1]
    structural = np.where(along, _are_edges(model, nodes), nodes[:, 0] == nodes[:, 1])
    found: dict[tuple[str, int, int], IntArray] = {}
    for outer, inner in ((0, 0), (0, 1), (1, 1), (1, 2), (2, 2)):
        here = (sheets == (outer, inner)).all(axis=1)
        for kind, chosen in (("structural", here & structural), ("shear", here & ~structural)):
            if chosen.any():
                found[kind, outer, inner] = ends[chosen]
    node = np.arange(n)
    found["tie", 2, 3] = np.stack([node + 2 * n, node + 3 * n], axis=1)
    return found


def _are_edges(model: TissueModel, nodes: IntArray) -> BoolArray:
    """Return which pairs of nodes of a sheet, shape (k, 2), are edges of its polygons, (k,)."""
    n = model.node_count
    edges = np.sort(model.sheet.edges.astype(np.int64), axis=1)
    pairs = np.sort(nodes, axis=1)
    return np.isin(pairs[:, 0] * n + pairs[:, 1], edges[:, 0] * n + edges[:, 1])
