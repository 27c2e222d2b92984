"""Fairing: the authored points pulled onto a smooth surface, the face's features held fast."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .cage import Cage
from .patches.ear import FLUSH
from .patches.side import STEPS, ear_rim
from .topology import Topology

REWEIGHTINGS = 2

# How far the author of a point is trusted; chosen by eye on renders of the bare surface. The face's
# rings are kept within a tenth of a millimetre, the skull is authored roughly and faired freely.
HELD = 50.0
TRUST_OF_POINT = {
    **dict.fromkeys((f"W{row}_{step}" for row in range(5, 12) for step in (1, 2)), 0.2),
    **dict.fromkeys((f"W{row}_{step}" for row in range(12, 16) for step in range(1, 8)), 1.0),
    **dict.fromkeys(ear_rim(), 3.0),
    **dict.fromkeys((f"P{ring}_{spoke}" for ring in (1, 2, 3, 4) for spoke in FLUSH), 3.0),
    **dict.fromkeys((f"E4_{spoke}" for spoke in range(7, 14)), 0.25),
    **dict.fromkeys(("E4_12", "E4_13"), 2.0),
    **dict.fromkeys((f"C{column}_{row}" for column in (4, 5) for row in (8, 9, 10)), 2.0),
    **dict.fromkeys((f"C4_{row}" for row in range(1, 6)), 2.0),
    **dict.fromkeys((f"C{column}_{row}" for column in (5, 6, 7) for row in range(1, 5)), 0.6),
    **dict.fromkeys(("E4_6", "G4_7", "G4_6", "G3_7", "G3_6", "G2_7"), 0.15),
    **dict.fromkeys((f"C8_{row}" for row in range(1, 6)), 0.15),
    **dict.fromkeys((f"W{row}_{STEPS}" for row in range(16)), 0.1),
    **dict.fromkeys((f"T{row}_0" for row in range(1, 7)), 0.1),
}
TRUST_OF_ROW = {
    **dict.fromkeys(("b1", "b2", "b3", "b4", "b5"), 6.0),
    "G1": 0.6,
    "G2": 0.6,
    "G3": 0.6,
    "G4": 0.3,
    "Q0": 0.15,
}
TRUST_OF_LETTER = {"W": 0.004, "T": 0.02, "C": 0.25, "Q": 0.4}


def trust(name: str) -> float:
    """Return the weight of a point's authored position against smoothness."""
    row = name.split("_")[0]
    if name in TRUST_OF_POINT:
        return TRUST_OF_POINT[name]
    return TRUST_OF_ROW.get(row, TRUST_OF_LETTER.get(row[0], HELD))


def fair(points: FloatArray, topology: Topology, trusts: Sequence[float]) -> FloatArray:
    """Return points (v, 3) that minimise a thin plate's bending plus the pull of the authored ones.

    The plate is |D L X|^2 with the Laplacian L weighted by inverse edge length, whose weights are
    taken anew from the last solution, and D zero on the boundary.
    """
    from scipy.sparse.linalg import splu  # Here: a start does without.

    weight = np.asarray(trusts)
    free = sp.diags_array((~topology.boundary_vertices).astype(float))
    identity = sp.eye_array(len(points))
    faired = points
    for _ in range(REWEIGHTINGS):
        span = faired[topology.edges[:, 0]] - faired[topology.edges[:, 1]]
        inverse_length = 1 / np.maximum(np.linalg.norm(span, axis=1), 1.0)
        laplacian = topology.neighbours(inverse_length) - identity
        plate = laplacian.T @ free @ laplacian + sp.diags_array(weight)
        faired = splu(plate.tocsc()).solve(weight[:, None] * points)
    return faired


def faired_points(cage: Cage) -> FloatArray:
    """Return the cage's points on a fair surface [mm], exactly symmetric, shape (v, 3)."""
    topology = Topology.of(cage.faces, len(cage.points))
    faired = fair(cage.points, topology, [trust(name) for name in cage.names])
    return symmetric(faired, cage.mirror)


def symmetric(points: FloatArray, mirror: IntArray) -> FloatArray:
    """Return points (v, 3) averaged with their mirror images: equal to the last bit, x = 0 between.

    A solver leaves the halves some 1e-13 apart, and a simulation would let that grow.
    """
    reflected = points[mirror] * [-1.0, 1.0, 1.0]
    return np.asarray((points + reflected) / 2)
