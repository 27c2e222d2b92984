"""Elastic energy of the tissue: what each term stores at each node, above the face at rest.

The energy whose gradient is minus the forces of `engine.dynamics`. At rest it is zero: what the
pre-tension stores then is held by the dead load, whose work counts as a term of its own.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..dynamics import (
    LEAST_VOLUME,
    MOST_VOLUME,
    Anchors,
    IndexArray,
    Plate,
    Pressure,
    Prisms,
    Skull,
    Springs,
    Tissue,
)

TERMS = ("springs", "dead_load", "anchors", "skin_volume", "plate", "fat_pressure")


def node_energy(x: FloatArray, tissue: Tissue, skull: Skull, rest: Skull) -> dict[str, FloatArray]:
    """Return the energy of each term by node, paper stiffness units x mm², each shape (n,).

    A column of the three layers' nodes counts as one node; a spring's energy is halved between
    its ends, an element's and a fat column's shared by their corners.

    Args:
        x: Node positions, mm, shape (3, nodes).
        tissue: The rig's arrays.
        skull: The skull side as it stands, its load without the muscles' forces.
        rest: The same with jaw and lids at rest.
    """
    n = skull.targets.shape[1]
    energies = {}
    for name, here, there in zip(
        TERMS, _terms(x, tissue, skull), _terms(tissue.rest, tissue, rest), strict=True
    ):
        difference = here - there
        energies[name] = (
            difference.reshape(3, n).sum(axis=0) if len(difference) == 3 * n else difference
        )
    return energies


def _terms(x: FloatArray, tissue: Tissue, skull: Skull) -> tuple[FloatArray, ...]:
    n = skull.targets.shape[1]
    return (
        spring_energy(x, tissue.springs),
        -((x - tissue.rest) * skull.load).sum(axis=0),
        anchor_energy(x[:, 2 * n :], tissue.anchors, skull),
        prism_energy(x, tissue.prisms),
        plate_energy(x[:, :n] - tissue.rest[:, :n], tissue.plate),
        pressure_energy(x, tissue.pressure, skull.bone),
    )


def spring_energy(x: FloatArray, springs: Springs) -> FloatArray:
    """Return the work of Eqs. 19-20 from each spring's own length, shape (nodes,).

    Continuous: ½ k_L s² + ½ (k_H - k_L) (s - ε_c d0)₊² + ½ k_g (s + ε_k d0)₋² at stretch s. As
    printed, the stiffness jumps and the energy has a kink.
    """
    length = np.linalg.norm(x[:, springs.second] - x[:, springs.first], axis=0)
    stretch = length - springs.rest
    knee = springs.threshold * springs.rest
    if springs.literal:
        over = np.where(stretch > knee, springs.high - springs.low, 0.0)
        energy = 0.5 * springs.low * stretch**2 + 0.5 * over * (stretch**2 - knee**2)
    else:
        energy = 0.5 * springs.low * stretch**2
        energy += 0.5 * (springs.high - springs.low) * np.maximum(stretch - knee, 0.0) ** 2
    pressed = np.minimum(stretch + springs.guard_strain * springs.rest, 0.0)
    energy += 0.5 * springs.guard * pressed**2
    nodes = x.shape[1]
    return np.asarray(
        0.5 * np.bincount(springs.first, energy, nodes)
        + 0.5 * np.bincount(springs.second, energy, nodes)
    )


def anchor_energy(x: FloatArray, anchors: Anchors, skull: Skull) -> FloatArray:
    """Return the energy of the ties to the skull and of its wall, shape (n,).

    Args:
        x: Hypodermis nodes, mm, shape (3, n).
        anchors: The ties.
        skull: Where they are tied.
    """
    offset = skull.targets - x
    depth = (offset * skull.normals).sum(axis=0)
    distance = np.linalg.norm(offset, axis=0)
    far = np.maximum(distance - anchors.excess_distance, 0.0)
    inside = np.maximum(depth - anchors.skull_gap, 0.0)
    energy = 0.5 * anchors.tangential * (distance**2 + anchors.excess * far**2)
    energy += 0.5 * (anchors.normal - anchors.tangential) * depth**2
    return np.asarray(energy + 0.5 * anchors.skull * anchors.normal * inside**2)


def prism_energy(x: FloatArray, prisms: Prisms) -> FloatArray:
    """Return the energy of the elements' volume, a sixth at each of their nodes, shape (nodes,).

    ½ k (r - 1)² + ⅓ k o (s - r)₊³ at r = V/V0, linear beyond `LEAST_VOLUME` and `MOST_VOLUME`.
    """
    nodes, corners = x.shape[1], prisms.corners
    if not len(corners):
        return np.zeros(nodes)
    share = element_volumes(x, corners) / prisms.volume
    held = np.clip(share, LEAST_VOLUME, MOST_VOLUME)
    flat = np.maximum(prisms.least - held, 0.0)
    energy = 0.5 * (held - 1.0) ** 2 + prisms.order * flat**3 / 3.0
    energy += (share - held) * (held - 1.0 - prisms.order * flat**2)
    each = np.repeat(prisms.stiffness * energy / 6.0, 6)
    both = np.concatenate([corners, corners + nodes // 3], axis=1)
    return np.asarray(np.bincount(both.ravel(), each, nodes), dtype=np.float64)


def element_volumes(x: FloatArray, corners: IndexArray) -> FloatArray:
    """Return the volume of each element between two layers, mm³, shape (e,)."""
    upper, lower = x[:, corners], x[:, corners + x.shape[1] // 3]
    middle = 0.5 * (upper + lower)
    p, r = middle[:, :, 1] - middle[:, :, 0], middle[:, :, 2] - middle[:, :, 0]
    height = (upper - lower).mean(axis=2)
    return np.asarray(0.5 * (np.cross(p, r, axis=0) * height).sum(axis=0))


def plate_energy(moved: FloatArray, plate: Plate) -> FloatArray:
    """Return ½ uᵀ K u of the epidermis by node, shape (n,); `moved` is u, mm, shape (3, n)."""
    n = moved.shape[1]
    if not len(plate.values):
        return np.zeros(n)
    row = np.repeat(np.arange(n), np.diff(plate.start))
    products = plate.values * (moved[:, row] * moved[:, plate.columns]).sum(axis=0)
    return np.asarray(0.5 * np.bincount(row, products, n))


def pressure_energy(x: FloatArray, pressure: Pressure, bone: FloatArray) -> FloatArray:
    """Return ½ k (V/V0 - 1)² of the fat columns, a quarter at each corner, shape (n,)."""
    n = bone.shape[1]
    quads = pressure.quads
    if not len(quads):
        return np.zeros(n)
    middle = x.reshape(3, 3, n).mean(axis=1)
    p = middle[:, quads[:, 2]] - middle[:, quads[:, 0]]
    r = middle[:, quads[:, 3]] - middle[:, quads[:, 1]]
    d = (middle[:, quads] - bone[:, quads]).mean(axis=2)
    volume = 0.5 * (np.cross(p, r, axis=0) * d).sum(axis=0)
    energy = 0.5 * pressure.stiffness * (volume / pressure.volume - 1.0) ** 2
    return np.asarray(np.bincount(quads.ravel(), np.repeat(0.25 * energy, 4), n), dtype=np.float64)
