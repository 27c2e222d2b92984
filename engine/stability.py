"""How many substeps a rig needs: its fastest mode against the integrators' stability bounds."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from .arrays import FloatArray
from .dynamics import Tissue, volume_gradients

IndexArray = npt.NDArray[np.int32] | npt.NDArray[np.int64]

LONGEST = {"rk4": 0.9 * 2.0 * math.sqrt(2.0), "symplectic_euler": 0.9 * 2.0, "verlet": 0.95 * 2.0}
"""ω dt that an integrator's step may reach."""
SAFETY = 1.05
"""Margin on the estimated frequency: springs turn as the face moves."""


def stiffness_matrix(tissue: Tissue, normals: FloatArray) -> sp.csr_array:
    """Return a stiff linearisation of a face at rest, shape (3 nodes, 3 nodes).

    Every spring at k_H, the anchors, the elements' volume, the plate. Left out, as in
    the masses, is what only few nodes feel at a time: the compression guard and the skull's wall;
    the fat's pressure is soft beside the springs. Where an edit makes them strong, masses count
    them (`tissue.model`) and their own bound, the mass frequency, is taken instead. Degrees of
    freedom run node by node, x, y, z.

    Args:
        tissue: The rig's arrays.
        normals: Of the skull, shape (n, 3).
    """
    springs = tissue.springs
    x = tissue.rest.T
    n = len(normals)
    along = x[springs.second] - x[springs.first]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    blocks = springs.high[:, None, None] * along[:, :, None] * along[:, None, :]
    matrix = _pair_blocks(springs.first, springs.second, blocks, len(x))
    outer = normals[:, :, None] * normals[:, None, :]
    anchors = tissue.anchors
    tie = anchors.tangential
    hold = tie[:, None, None] * np.eye(3) + (anchors.normal - tie)[:, None, None] * outer
    matrix = matrix + _node_blocks(np.arange(n) + 2 * n, hold, len(x))
    if len(tissue.prisms.corners):
        matrix = matrix + _prism_matrix(tissue)
    if len(tissue.plate.values):
        plate = sp.csr_array((tissue.plate.values, tissue.plate.columns, tissue.plate.start))
        onto = sp.eye_array(len(x), n, format="csr")
        matrix = matrix + sp.kron(onto @ plate @ onto.T, sp.eye_array(3), format="csr")
    return sp.csr_array(matrix)


def _prism_matrix(tissue: Tissue) -> sp.csr_array:
    """Return Σ k ∇V ∇Vᵀ / V0² over the elements, shape (3 nodes, 3 nodes)."""
    prisms, nodes = tissue.prisms, tissue.rest.shape[1]
    corners = np.concatenate([prisms.corners, prisms.corners + nodes // 3], axis=1)
    columns = 3 * corners[:, :, None] + np.arange(3)
    rows = np.broadcast_to(np.arange(len(corners))[:, None, None], columns.shape)
    gradient = volume_gradients(np.ascontiguousarray(tissue.rest.T), prisms.corners)
    slopes = sp.csr_array(
        (gradient.ravel(), (rows.ravel(), columns.ravel())), shape=(len(corners), 3 * nodes)
    )
    return sp.csr_array(slopes.T @ sp.diags_array(prisms.stiffness / prisms.volume**2) @ slopes)


def largest_frequency(tissue: Tissue, normals: FloatArray) -> float:
    """Return ω_max, rad/s, of the free nodes by Lanczos iteration from a fixed start."""
    from scipy.sparse.linalg import eigsh  # Here: a start does without.

    free = np.repeat(tissue.inverse_mass > 0.0, 3)
    root = np.sqrt(np.repeat(tissue.inverse_mass, 3)[free])
    matrix = stiffness_matrix(tissue, normals)[free][:, free]
    scaled = sp.diags_array(root) @ matrix @ sp.diags_array(root)
    start = np.sin(1.0 + np.arange(len(root)))
    values = eigsh(scaled, k=1, which="LA", v0=start, tol=1.0e-3, return_eigenvectors=False)
    return math.sqrt(float(values[-1]))


def longest_step(omega: float, damping: float, integrator: str) -> float:
    """Return the longest stable step, s, for modes up to `omega`, rad/s, damped by `damping`, 1/s.

    Second-order Runge-Kutta amplifies a mode by about (ω dt)⁴/8 a step while damping takes
    c dt/2: stable below (4 c/ω⁴)^(1/3). Fourth order is stable to ω dt = 2.8, symplectic Euler
    and Verlet to 2; the first two are kept at 0.9 of that, Verlet at 0.95.
    """
    if integrator in ("rk2", "heun"):
        return math.exp(math.log(4.0 * damping / omega**4) / 3.0)
    return LONGEST[integrator] / omega


def least_substeps(omega: float, damping: float, integrator: str, tick: float) -> int:
    """Return the least whole number of substeps of one `tick`, s, within the bound."""
    return math.ceil(tick / longest_step(SAFETY * omega, damping, integrator))


def _pair_blocks(
    first: IndexArray,
    second: IndexArray,
    blocks: FloatArray,
    nodes: int,
) -> sp.csr_array:
    same = _blocks(first, first, blocks, nodes) + _blocks(second, second, blocks, nodes)
    cross = _blocks(first, second, blocks, nodes) + _blocks(second, first, blocks, nodes)
    return sp.csr_array(same - cross)


def _node_blocks(index: IndexArray, blocks: FloatArray, nodes: int) -> sp.csr_array:
    return _blocks(index, index, blocks, nodes)


def _blocks(
    rows: IndexArray,
    columns: IndexArray,
    blocks: FloatArray,
    nodes: int,
) -> sp.csr_array:
    axis = np.arange(3)
    r = np.broadcast_to(3 * rows[:, None, None] + axis[:, None], blocks.shape)
    c = np.broadcast_to(3 * columns[:, None, None] + axis[None, :], blocks.shape)
    return sp.csr_array((blocks.ravel(), (r.ravel(), c.ravel())), shape=(3 * nodes, 3 * nodes))
