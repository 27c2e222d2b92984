"""The kernels' slow twin: the same forces in plain NumPy, written from the formulas."""

from __future__ import annotations

import numpy as np

from engine.arrays import FloatArray
from engine.dynamics import LEAST_VOLUME, MOST_VOLUME, Skull, Tissue


def forces(x: FloatArray, tissue: Tissue, skull: Skull) -> FloatArray:
    """Return every static force but the moving muscles', shape (3, nodes)."""
    total = skull.load.copy()
    total += springs(x, tissue)
    total += anchors(x, tissue, skull)
    total += prisms(x, tissue)
    total += plate(x, tissue)
    total += pressure(x, tissue, skull)
    return total


def springs(x: FloatArray, tissue: Tissue) -> FloatArray:
    """Return Eqs. 19-20, both forms, with the compression guard."""
    s = tissue.springs
    d = x[:, s.second] - x[:, s.first]
    length = np.linalg.norm(d, axis=0)
    stretch = length - s.rest
    if s.literal:
        tension = np.where(stretch <= s.threshold * s.rest, s.low, s.high) * stretch
    else:
        over = np.maximum(stretch - s.threshold * s.rest, 0.0)
        tension = s.low * stretch + (s.high - s.low) * over
    tension += s.guard * np.minimum(stretch + s.guard_strain * s.rest, 0.0)
    pull = tension * d / length
    out = np.zeros_like(x)
    for c in range(3):
        np.add.at(out[c], s.first, pull[c])
        np.add.at(out[c], s.second, -pull[c])
    return out


def anchors(x: FloatArray, tissue: Tissue, skull: Skull) -> FloatArray:
    """Return the skull's hold on the hypodermis."""
    a, n = tissue.anchors, skull.targets.shape[1]
    u = skull.targets - x[:, -n:]
    depth = (u * skull.normals).sum(axis=0)
    distance = np.linalg.norm(u, axis=0)
    far = np.maximum(distance - a.excess_distance, 0.0) / np.maximum(distance, 1e-12)
    along = a.tangential * (1.0 + a.excess * far)
    across = (a.normal - a.tangential) * depth
    across += a.skull * a.normal * np.maximum(depth - a.skull_gap, 0.0)
    out = np.zeros_like(x)
    out[:, -n:] = along * u + across * skull.normals
    return out


def prism_energy(x: FloatArray, tissue: Tissue) -> FloatArray:
    """Return ½ k (r - 1)² + ⅓ k o max(s - r, 0)³ of each element, r = V/V0, shape (e,)."""
    p, n = tissue.prisms, x.shape[1] // 3
    upper, lower = x[:, p.corners], x[:, p.corners + n]
    middle = 0.5 * (upper + lower)
    area = 0.5 * np.cross(
        middle[:, :, 1] - middle[:, :, 0], middle[:, :, 2] - middle[:, :, 0], axis=0
    )
    share = (area * (upper - lower).mean(axis=2)).sum(axis=0) / p.volume
    held = np.clip(share, LEAST_VOLUME, MOST_VOLUME)
    flat = np.maximum(p.least - held, 0.0)
    energy = 0.5 * (held - 1.0) ** 2 + p.order * flat**3 / 3.0
    return np.asarray(p.stiffness * (energy + (share - held) * (held - 1.0 - p.order * flat**2)))


def prisms(x: FloatArray, tissue: Tissue) -> FloatArray:
    """Return minus the gradient of `prism_energy`, by central differences."""
    out, n, step = np.zeros_like(x), x.shape[1] // 3, 1.0e-5
    for node in np.unique(np.concatenate([tissue.prisms.corners, tissue.prisms.corners + n])):
        for c in range(3):
            moved = x.copy()
            moved[c, node] += step
            more = prism_energy(moved, tissue)
            moved[c, node] -= 2 * step
            out[c, node] = -(more - prism_energy(moved, tissue)).sum() / (2 * step)
    return out


def plate(x: FloatArray, tissue: Tissue) -> FloatArray:
    """Return the epidermis' bending force from the dense matrix."""
    out, p = np.zeros_like(x), tissue.plate
    n = len(p.start) - 1
    matrix = np.zeros((n, n))
    for row in range(n):
        for q in range(p.start[row], p.start[row + 1]):
            matrix[row, p.columns[q]] += p.values[q]
    out[:, :n] = -(x[:, :n] - tissue.rest[:, :n]) @ matrix.T
    return out


def pressure_energy(x: FloatArray, tissue: Tissue, skull: Skull) -> float:
    """Return Σ ½ k (V/V0 - 1)² over the fat columns."""
    p, n = tissue.pressure, skull.targets.shape[1]
    middle = (x[:, :n] + x[:, n : 2 * n] + x[:, 2 * n :]) / 3.0
    corner = middle[:, p.quads]
    diagonal = corner[:, :, 2] - corner[:, :, 0]
    other = corner[:, :, 3] - corner[:, :, 1]
    height = corner.mean(axis=2) - skull.bone[:, p.quads].mean(axis=2)
    volume = 0.5 * (np.cross(diagonal, other, axis=0) * height).sum(axis=0)
    return float((0.5 * p.stiffness * (volume / p.volume - 1.0) ** 2).sum())


def pressure(x: FloatArray, tissue: Tissue, skull: Skull) -> FloatArray:
    """Return minus the gradient of `pressure_energy`, by central differences."""
    out = np.zeros_like(x)
    if not len(tissue.pressure.quads):
        return out
    n, step = skull.targets.shape[1], 1.0e-4
    for node in np.unique(tissue.pressure.quads):
        for layer in range(3):
            for c in range(3):
                moved = x.copy()
                moved[c, node + layer * n] += step
                more = pressure_energy(moved, tissue, skull)
                moved[c, node + layer * n] -= 2 * step
                less = pressure_energy(moved, tissue, skull)
                out[c, node + layer * n] = -(more - less) / (2 * step)
    return out


def energy(x: FloatArray, tissue: Tissue, skull: Skull) -> float:
    """Return the potential energy of springs, anchors, elements, plate, fat and load."""
    s = tissue.springs
    length = np.linalg.norm(x[:, s.second] - x[:, s.first], axis=0)
    stretch = length - s.rest
    over = np.maximum(stretch - s.threshold * s.rest, 0.0)
    under = np.minimum(stretch + s.guard_strain * s.rest, 0.0)
    total = 0.5 * (s.low * stretch**2 + (s.high - s.low) * over**2 + s.guard * under**2).sum()
    a, n = tissue.anchors, skull.targets.shape[1]
    u = skull.targets - x[:, -n:]
    depth = (u * skull.normals).sum(axis=0)
    squared = (u**2).sum(axis=0)
    far = np.maximum(np.sqrt(squared) - a.excess_distance, 0.0)
    inside = np.maximum(depth - a.skull_gap, 0.0)
    total += 0.5 * (a.tangential * (squared - depth**2) + a.normal * depth**2).sum()
    total += 0.5 * (a.excess * a.tangential * far**2 + a.skull * a.normal * inside**2).sum()
    total += prism_energy(x, tissue).sum()
    total -= 0.5 * (plate(x, tissue) * (x - tissue.rest)).sum()
    return float(total + pressure_energy(x, tissue, skull) - (skull.load * x).sum())
