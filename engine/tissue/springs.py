"""Structural and shear springs over the three layers, scaled by element size (section 5.2)."""

from __future__ import annotations

import math

import numpy as np

from ..arrays import FloatArray, IntArray
from ..dynamics import Springs
from .fields import TissueFields
from .layers import Layers, Sheet
from .parameters import TissueParameters

EDGE_SCALE_LIMITS = (0.2, 4.0)
DIAGONAL_SCALE_LIMITS = (0.1, 2.0)


def reference_area(sheet: Sheet, parameters: TissueParameters) -> float:
    """Return A0, mm²: one node's area in a regular lattice of edges L0.

    A square lattice's for a sheet of quads, L0²; an equilateral one's, √3/2 L0², for triangles.
    """
    return _lattice_factor(sheet) * parameters.reference_length**2


def build_springs(
    sheet: Sheet,
    layers: Layers,
    fields: TissueFields,
    parameters: TissueParameters,
    *,
    literal: bool,
) -> Springs:
    """Join the nodes: along the layers, straight down, and across.

    The paper says that stiffness is scaled by element size and gives no formula. Here an in-layer
    spring has the stiffness of the strip of skin beside it, area over length squared, which makes
    the sheet as stiff on any mesh; springs between layers and shear springs carry their area.

    Args:
        sheet: The surface.
        layers: Node positions.
        fields: What goes by region or by point.
        parameters: Stiffnesses and switches.
        literal: Eq. 20 as printed in place of the continuous biphasic law.
    """
    p, n = parameters, len(sheet.points)
    parts: list[tuple[IntArray, IntArray, FloatArray, FloatArray, FloatArray]] = []

    def add(first: IntArray, second: IntArray, layer: int, scale: FloatArray) -> None:
        low, high = p.stiffness_low[layer], p.stiffness_high[layer]
        parts.append((first, second, low * scale, high * scale, np.zeros(len(first))))

    def add_along(pairs: IntArray, layer: int, scale: FloatArray) -> None:
        if layer < 2:
            scale = scale * fields.skin[pairs].mean(axis=1)
        low = p.stiffness_low[layer] * fields.slack[pairs].mean(axis=1)
        first, second = pairs[:, 0] + layer * n, pairs[:, 1] + layer * n
        short = fields.pretension[pairs].mean(axis=1)
        parts.append((first, second, low * scale, p.stiffness_high[layer] * scale, short))

    edges, region = sheet.edges, fields.stiffness
    edge_scale = _edge_scale(sheet) * region[edges].mean(axis=1)
    diagonals, diagonal_scale = _diagonals(sheet)
    diagonal_scale = (
        diagonal_scale * region[diagonals].mean(axis=1) if len(diagonals) else diagonal_scale
    )
    for layer in range(3):
        add_along(edges, layer, edge_scale)
        if p.cross_diagonals and len(diagonals):
            add_along(diagonals, layer, diagonal_scale)
    area0 = reference_area(sheet, p)
    down = sheet.node_area / area0
    # The two shear springs of an edge share its skin on a square lattice; on triangles each
    # carries it whole, as the paper's element draws them.
    shear = sheet.edge_area / (area0 * (2.0 if _lattice_factor(sheet) == 1.0 else 1.0))
    node = np.arange(n)
    for layer in range(2):
        upper, lower = layer * n, (layer + 1) * n
        add(node + upper, node + lower, layer + 1, down)
        add(edges[:, 0] + upper, edges[:, 1] + lower, layer + 1, shear)
        add(edges[:, 1] + upper, edges[:, 0] + lower, layer + 1, shear)
    first = np.concatenate([part[0] for part in parts])
    second = np.concatenate([part[1] for part in parts])
    length = np.linalg.norm(layers.nodes[first] - layers.nodes[second], axis=1)
    short = np.concatenate([part[4] for part in parts])
    high = np.concatenate([part[3] for part in parts])
    return Springs(
        first=first.astype(np.int32),
        second=second.astype(np.int32),
        rest=length * (1.0 - short),
        low=np.concatenate([part[2] for part in parts]),
        high=high,
        guard=p.compression_guard * high,
        threshold=p.strain_threshold,
        guard_strain=p.guard_strain,
        literal=literal,
    )


def _lattice_factor(sheet: Sheet) -> float:
    return 1.0 if sheet.is_quad.mean() > 0.5 else math.sqrt(3.0) / 2.0


def _edge_scale(sheet: Sheet) -> FloatArray:
    a, b = sheet.points[sheet.edges[:, 0]], sheet.points[sheet.edges[:, 1]]
    squared = ((a - b) ** 2).sum(axis=1)
    # A square lattice has 2 L² of polygons at an edge, an equilateral one √3/2 L².
    strip = 2.0 if _lattice_factor(sheet) == 1.0 else math.sqrt(3.0) / 2.0
    return np.asarray(np.clip(sheet.edge_area / (strip * squared), *EDGE_SCALE_LIMITS))


def _diagonals(sheet: Sheet) -> tuple[IntArray, FloatArray]:
    quads, area = sheet.quads, sheet.polygon_area[sheet.is_quad]
    # Interleaved, so that a quad's two diagonals are neighbours in the list.
    pairs = np.stack([quads[:, [0, 2]], quads[:, [1, 3]]], axis=1).reshape(-1, 2)
    squared = ((sheet.points[pairs[:, 0]] - sheet.points[pairs[:, 1]]) ** 2).sum(axis=1)
    # Area over squared diagonal is a half on squares: with it a square lattice is isotropic.
    return pairs, np.clip(np.repeat(area, 2) / squared, *DIAGONAL_SCALE_LIMITS)
