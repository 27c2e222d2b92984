"""The tissue of one head, assembled: layers, springs, terms, masses, contact (section 5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray
from ..dynamics import (
    Anchors,
    Plate,
    Pressure,
    Prisms,
    Pull,
    Skull,
    Springs,
    Tissue,
    volume_gradients,
)
from ..head import Head
from ..head.anatomy import smoothstep
from .contact import TARSAL_RINGS, Lids, contacts_of, lids_of, ring_and_spoke
from .fields import fields_of
from .layers import Layers, Sheet, prism_volumes, sheet_of, stack_layers
from .parameters import TissueParameters
from .places import LIGAMENT_POINTS, firmness, stubbornness
from .springs import build_springs, reference_area

NORMAL_ANCHOR_FLOOR = 0.25
"""Least regional weight of the normal tie: even loose skin does not lift off the skull."""
FAT_DEPTH_MM = (8.5, 11.5)
"""Skin depth over which the fat pressure fades in; on a thin forehead it does harm."""
PRESSURE_FREE_RINGS = ("EB", "E0", "E1", "E2", "S1", "M0")
"""Rings of lids and inner lips: their columns have no bone under them."""
SPARED_ELEMENTS = 0.1
"""The same for the elements between the layers, far stiffer when they are pressed flat."""
THIN_MM = 0.6
PRESSED, PRESSED_THIN = 0.3, -0.2
"""Least share of its volume that an element keeps in any expression, by the length of its columns:
what masses count."""
LEAST_ELEMENT_MM = 0.6
"""Thickness from which an element's stiffness is counted; a flat one would hardly resist."""
SPARED_SHARE = 2.1
"""How much stiffer than its mass says a node may be in every hard phase at once.

Few nodes feel the compression guard, the skull's wall or stretched ties at a time, and faces stay
within the stability bound as they are built in. Where an edit goes beyond, mass counts all of it.
"""
SPARED_COLUMNS = 0.9
"""The same for the fat columns alone, which many nodes feel when the jaw opens."""
THIN_SHARE = (0.15, 0.55)
"""Share of its depth below which a muscle takes hold of the whole column."""
LEAST_COLUMN_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class TissueModel:
    """One head's tissue as arrays.

    Attributes:
        parameters: The constants it was assembled from.
        sheet: Surface polygons, edges and areas.
        layers: Rest nodes, normals, bone.
        arrays: What the kernels read.
        dead_load: Force that balances the pre-tension at rest, shape (3, nodes).
        scale: Node area over reference area, shape (n,); muscle forces scale with it.
        held: Epidermis nodes that are moved and not simulated: outer ring and tarsal plates, (n,).
        lids: Nodes that turn with the lids.
        hardened: Whether masses had to count phases that a linear view of the rest leaves out.
    """

    parameters: TissueParameters
    sheet: Sheet
    layers: Layers
    arrays: Tissue
    dead_load: FloatArray
    scale: FloatArray
    held: BoolArray
    lids: Lids
    hardened: bool = False

    @property
    def node_count(self) -> int:
        """Nodes in one layer."""
        return len(self.sheet.points)


def assemble(head: Head, parameters: TissueParameters, *, literal_springs: bool) -> TissueModel:
    """Build the tissue of `head`.

    Args:
        head: Any head, built in or read from a file.
        parameters: Its constants and terms.
        literal_springs: Eq. 20 as printed.
    """
    sheet = sheet_of(head)
    fields = fields_of(head, sheet, parameters)
    layers = stack_layers(sheet, parameters, fields.depth, fields.dermis)
    scale = sheet.node_area / reference_area(sheet, parameters)
    springs = build_springs(sheet, layers, fields, parameters, literal=literal_springs)
    anchors = _anchors(head, parameters, scale * fields.ties)
    prisms = _prisms(head, sheet, layers, parameters)
    elements = prism_stiffness(layers, prisms)
    stubborn = stubbornness(head, sheet, prisms.corners.astype(int) % head.sheet_count)
    pressed = prism_stiffness(layers, prisms, stubborn)
    plate = _plate(sheet, parameters, scale)
    pressure = _pressure(head, sheet, layers, parameters)
    node_count = 3 * head.sheet_count
    stiffness = nodal_stiffness(springs, anchors, elements, plate, pressure, node_count)
    columns = column_stiffness(layers, pressure)
    hard = hardest_stiffness(springs, anchors, pressed, plate, columns, node_count)
    held = _held(head)
    hardened = (hard > SPARED_SHARE * stiffness) | (columns > SPARED_COLUMNS * stiffness)
    hardened |= elements > SPARED_ELEMENTS * stiffness
    mass = 2.0 * np.where(hardened, hard, stiffness) / parameters.mass_frequency**2
    inverse_mass = np.where(np.tile(held, 3), 0.0, 1.0 / mass)
    arrays = Tissue(
        rest=np.ascontiguousarray(layers.nodes.T),
        grip=_grip(layers, parameters),
        inverse_mass=inverse_mass,
        damping=parameters.damping,
        springs=springs,
        anchors=anchors,
        prisms=prisms,
        plate=plate,
        pressure=pressure,
        contacts=contacts_of(head),
    )
    return TissueModel(
        parameters,
        sheet,
        layers,
        arrays,
        dead_load(arrays),
        scale,
        held,
        lids_of(head),
        hardened=bool(hardened.any()),
    )


def no_pull(node_count: int) -> Pull:
    """Return the empty set of moving muscles, for mode "rest"."""
    return Pull(np.zeros(0, np.int32), np.zeros((0, 21)), np.zeros(0), np.zeros((0, node_count)))


def rest_skull(arrays: Tissue, layers: Layers, load: FloatArray) -> Skull:
    """Return the skull side with the jaw closed and `load` on the nodes, shape (3, nodes)."""
    n = len(layers.normals)
    return Skull(
        targets=np.ascontiguousarray(arrays.rest[:, 2 * n :]),
        bone=np.ascontiguousarray(layers.bone.T),
        normals=np.ascontiguousarray(layers.normals.T),
        load=load,
        travel=np.zeros((3, n)),
    )


def nodal_stiffness(
    springs: Springs,
    anchors: Anchors,
    elements: FloatArray,
    plate: Plate,
    pressure: Pressure,
    node_count: int,
) -> FloatArray:
    """Return D_i of the mass m_i = 2 D_i / ω², shape (nodes,): all the stiffness at each node.

    Every term counts but the compression guard, which few springs feel at once.
    """
    n = node_count // 3
    total: FloatArray = np.zeros(node_count)
    np.add.at(total, springs.first, springs.high)
    np.add.at(total, springs.second, springs.high)
    total[2 * n :] += 0.5 * np.maximum(anchors.tangential, anchors.normal)
    total += elements
    if len(plate.values):
        total[:n] += 0.5 * np.add.reduceat(np.abs(plate.values), plate.start[:-1])
    if len(pressure.quads):
        corner = np.repeat(0.5 * pressure.stiffness / pressure.height**2, 4)
        columns: FloatArray = np.zeros(n)
        np.add.at(columns, pressure.quads.ravel(), corner)
        total += np.tile(columns, 3)
    return total


COLUMN_GROWTH = 3.0
"""How much a column of fat stiffens as a wide jaw stretches it; found at 25 degrees."""


def hardest_stiffness(
    springs: Springs,
    anchors: Anchors,
    pressed: FloatArray,
    plate: Plate,
    columns: FloatArray,
    node_count: int,
) -> FloatArray:
    """Return D_i with every phase of every term at its stiffest, shape (nodes,).

    Half of Gershgorin's bound on the rows of the stiffness matrix: the compression guard, the
    stretched ties and the wall of the skull count too, and the elements as if pressed flat.

    `columns` is from `column_stiffness`.
    """
    n = node_count // 3
    total = columns.copy()
    hardest = np.maximum(springs.high, springs.low + springs.guard)
    np.add.at(total, springs.first, hardest)
    np.add.at(total, springs.second, hardest)
    total[2 * n :] += 0.5 * np.maximum(
        anchors.tangential * (1.0 + anchors.excess), anchors.normal * (1.0 + anchors.skull)
    )
    total += pressed
    if len(plate.values):
        total[:n] += 0.5 * np.add.reduceat(np.abs(plate.values), plate.start[:-1])
    return total


def column_stiffness(layers: Layers, pressure: Pressure) -> FloatArray:
    """Return each node's share D_i of the fat columns at rest, shape (nodes,).

    Half of the row sum of k ∇V ∇Vᵀ / V0²; a tall column resists shear far more than pressing.
    """
    n = len(layers.normals)
    total = np.zeros(3 * n)
    quads = pressure.quads
    if not len(quads):
        return total
    middle = layers.nodes.reshape(3, n, 3).mean(axis=0)
    p = middle[quads[:, 2]] - middle[quads[:, 0]]
    r = middle[quads[:, 3]] - middle[quads[:, 1]]
    d = middle[quads].mean(axis=1) - layers.bone[quads].mean(axis=1)
    area, by_p, by_r = 0.5 * np.cross(p, r), 0.5 * np.cross(r, d), 0.5 * np.cross(d, p)
    corners = np.stack(
        [0.25 * area - by_p, 0.25 * area - by_r, 0.25 * area + by_p, 0.25 * area + by_r], axis=1
    )
    gradient = np.linalg.norm(corners, axis=2) / 3.0
    rows = (pressure.stiffness / pressure.volume**2)[:, None] * gradient
    rows = 0.5 * COLUMN_GROWTH * rows * 3.0 * gradient.sum(axis=1, keepdims=True)
    for layer in range(3):
        np.add.at(total, quads.ravel() + layer * n, rows.ravel())
    return total


def dead_load(arrays: Tissue) -> FloatArray:
    """Return the force that keeps the pre-tensioned tissue at rest, shape (3, nodes).

    That of its springs (Eqs. 19-20) turned round: all else has its own form at rest, and no force.
    By NumPy, since compiling every force for this one sum would hold up a first start by seconds.
    """
    springs, nodes = arrays.springs, arrays.rest.shape[1]
    along = arrays.rest[:, springs.second] - arrays.rest[:, springs.first]
    length = np.linalg.norm(along, axis=0)
    stretch = length - springs.rest
    over = stretch - springs.threshold * springs.rest
    hard = springs.high - springs.low
    pull = springs.low * stretch
    pull += hard * (np.where(over > 0.0, stretch, 0.0) if springs.literal else over.clip(0.0))
    pull += springs.guard * np.minimum(stretch + springs.guard_strain * springs.rest, 0.0)
    forces = along * (pull / length)
    return np.stack(
        [
            np.bincount(springs.second, row, nodes) - np.bincount(springs.first, row, nodes)
            for row in forces
        ]
    )


def _grip(layers: Layers, p: TissueParameters) -> FloatArray:
    n = len(layers.normals)
    deep = np.ones(n)
    if p.thin_skin_grip:
        deep = (1.0 + 2.0 * smoothstep(*THIN_SHARE, layers.share)) / 3.0
    return np.stack([0.5 * (1.0 - deep), 0.5 * (1.0 - deep), deep])


def _anchors(head: Head, p: TissueParameters, scale: FloatArray) -> Anchors:
    tangential = p.anchor_tangential * head.anchor_weight * scale
    normal = p.anchor_normal * np.maximum(head.anchor_weight, NORMAL_ANCHOR_FLOOR) * scale
    for node, name in enumerate(head.names[: head.sheet_count]):
        if name.partition(".")[0] in LIGAMENT_POINTS:
            normal[node] *= p.ligament
    return Anchors(
        tangential,
        normal,
        p.anchor_excess,
        p.anchor_excess_distance,
        p.skull_stiffness,
        p.skull_gap,
    )


def _prisms(head: Head, sheet: Sheet, layers: Layers, p: TissueParameters) -> Prisms:
    n, upper, area0 = head.sheet_count, sheet.elements, reference_area(sheet, p)
    corners = np.concatenate([upper, upper + n])
    stack = layers.nodes.reshape(3, n, 3)
    volume = np.concatenate([prism_volumes(stack[k], stack[k + 1], upper) for k in range(2)])
    middle = 0.5 * (layers.nodes[corners] + layers.nodes[corners + n])
    size = 0.5 * np.linalg.norm(
        np.cross(middle[:, 1] - middle[:, 0], middle[:, 2] - middle[:, 0]), axis=1
    )
    firm = firmness(sheet, corners % n)
    stubborn = stubbornness(head, sheet, corners % n)
    thickness = np.maximum(volume / size, LEAST_ELEMENT_MM)
    # Of a lid's plate all corners are moved: it cannot lose volume.
    keep = np.tile(~_held(head)[upper].all(axis=1), 2) & (volume > 0.0) & (p.skin_volume > 0.0)
    return Prisms(
        np.asfortranarray(corners[keep].astype(np.int32)),
        (p.skin_volume * firm * size / area0 * thickness**2)[keep],
        volume[keep],
        (p.layer_order * stubborn / firm)[keep],
        p.layer_gap,
    )


def prism_stiffness(
    layers: Layers, prisms: Prisms, stubborn: FloatArray | None = None
) -> FloatArray:
    """Return each node's share D_i of the elements' stiffness, shape (nodes,).

    Half of the row sum of k ∇V ∇Vᵀ / V0², at rest or, where it is told how `stubborn` each element
    is, shape (e,), pressed as far as faces press it: thick ones to `PRESSED`, thin ones, in the
    corners of the lips, through, and stubborn ones less deep. What resists grows with the square
    of the depth, so that the same force presses an element s times as stubborn 1/√s as deep.
    """
    total = np.zeros(len(layers.nodes))
    if not len(prisms.corners):
        return total
    size = np.linalg.norm(volume_gradients(layers.nodes, prisms.corners), axis=2)
    stiffness = prisms.stiffness / prisms.volume**2
    if stubborn is not None:
        corners = prisms.corners
        n = len(layers.normals)
        height = np.linalg.norm(layers.nodes[corners] - layers.nodes[corners + n], axis=2).mean(1)
        share = np.where(height < THIN_MM, PRESSED_THIN, PRESSED)
        deep = np.maximum(prisms.least - share, 0.0) / np.sqrt(stubborn)
        stiffness = stiffness * (1.0 + 2.0 * prisms.order * deep)
    stiff = stiffness[:, None] * size * size.sum(axis=1, keepdims=True)
    nodes = np.concatenate([prisms.corners, prisms.corners + len(layers.normals)], axis=1)
    np.add.at(total, nodes.ravel(), 0.5 * stiff.ravel())
    return total


def _plate(sheet: Sheet, p: TissueParameters, scale: FloatArray) -> Plate:
    if p.plate == 0.0:
        return Plate(np.zeros(1, np.int32), np.zeros(0, np.int32), np.zeros(0))
    n = len(sheet.points)
    laplacian = sp.csr_array(sheet.neighbor_mean - sp.eye_array(n))
    matrix = sp.csr_array(p.plate * (laplacian.T @ sp.diags_array(scale) @ laplacian))
    matrix.sum_duplicates()
    return Plate(matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32), matrix.data)


def _pressure(head: Head, sheet: Sheet, layers: Layers, p: TissueParameters) -> Pressure:
    quads = sheet.quads
    empty = Pressure(np.zeros((0, 4), np.int32), np.zeros(0), np.zeros(0), np.zeros(0))
    if p.fat_pressure == 0.0 or not len(quads):
        return empty
    n = len(sheet.points)
    middle = layers.nodes.reshape(3, n, 3).mean(axis=0)
    volume = column_volumes(middle, layers.bone, quads)
    area = sheet.polygon_area[sheet.is_quad]
    quad_depth = layers.depth[quads].mean(axis=1)
    fat = smoothstep(*FAT_DEPTH_MM, quad_depth)
    held = np.array([ring_and_spoke(name)[0] in PRESSURE_FREE_RINGS for name in head.names[:n]])
    sound = (volume > LEAST_COLUMN_SHARE * area * quad_depth) & ~held[quads].any(axis=1)
    modulus = p.fat_pressure * fat * area / p.reference_length**2
    height = np.maximum(volume / area, 1.0)
    keep = sound & (modulus > 0.0)
    return Pressure(
        quads[keep].astype(np.int32), (modulus * height**2)[keep], volume[keep], height[keep]
    )


def column_volumes(middle: FloatArray, bone: FloatArray, quads: IntArray) -> FloatArray:
    """Return the signed volume between mid-surface and bone of each quad, mm³, shape (q,)."""
    p = middle[quads[:, 2]] - middle[quads[:, 0]]
    r = middle[quads[:, 3]] - middle[quads[:, 1]]
    d = middle[quads].mean(axis=1) - bone[quads].mean(axis=1)
    return np.asarray(0.5 * np.einsum("qc,qc->q", np.cross(p, r), d))


def _held(head: Head) -> BoolArray:
    tarsal = np.array(
        [ring_and_spoke(name)[0] in TARSAL_RINGS for name in head.names[: head.sheet_count]]
    )
    return head.fixed | tarsal if head.eyes else head.fixed.copy()
