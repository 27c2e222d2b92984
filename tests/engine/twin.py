"""The kernels' slow twin: the same forces in plain NumPy, written from the formulas."""

from __future__ import annotations

import numpy as np

from engine.arrays import FloatArray
from engine.dynamics import Skull, Tissue


def forces(x: FloatArray, tissue: Tissue, skull: Skull) -> FloatArray:
    """Return every static force but the moving muscles', shape (3, nodes)."""
    total = skull.load.copy()
    total += springs(x, tissue)
    total += anchors(x, tissue, skull)
    total += barrier(x, tissue, skull)
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


def barrier(x: FloatArray, tissue: Tissue, skull: Skull) -> FloatArray:
    """Return the push between layers that come too close."""
    out, n = np.zeros_like(x), skull.targets.shape[1]
    if not len(tissue.barrier.stiffness):
        return out
    for layer in range(2):
        upper, lower = slice(layer * n, (layer + 1) * n), slice((layer + 1) * n, (layer + 2) * n)
        gap = ((x[:, upper] - x[:, lower]) * skull.normals).sum(axis=0)
        push = tissue.barrier.stiffness * np.maximum(tissue.barrier.gap[layer] - gap, 0.0)
        out[:, upper] += push * skull.normals
        out[:, lower] -= push * skull.normals
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
    """Return the potential energy of springs, anchors, barrier, plate, fat and load."""
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
    if len(tissue.barrier.stiffness):
        for layer in range(2):
            upper, lower = (
                x[:, layer * n : (layer + 1) * n],
                x[:, (layer + 1) * n : (layer + 2) * n],
            )
            gap = ((upper - lower) * skull.normals).sum(axis=0)
            short = np.maximum(tissue.barrier.gap[layer] - gap, 0.0)
            total += 0.5 * (tissue.barrier.stiffness * short**2).sum()
    total -= 0.5 * (plate(x, tissue) * (x - tissue.rest)).sum()
    return float(total + pressure_energy(x, tissue, skull) - (skull.load * x).sum())
