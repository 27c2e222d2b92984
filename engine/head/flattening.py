"""A piece of surface laid flat with little stretch: embedded on a disk, then relaxed.

The embedding is Tutte's (1963); the relaxation lowers the symmetric Dirichlet energy without a flip
(Rabinovich, Poranne, Panozzo, Sorkine-Hornung 2017, "Scalable Locally Injective Mappings").
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ..arrays import FloatArray, IntArray
from .topology import next_corners

RELAXATIONS = 24
"""Steps of the relaxation; the energy then falls by less than a thousandth each."""
HOLE_WEIGHT = 0.08
"""How much a hole's shape counts beside the skin's."""


def flattened(vertices: FloatArray, quads: IntArray, scale: FloatArray) -> FloatArray:
    """Return a disk-like piece of surface flattened without flips, shape (v, 2).

    Args:
        vertices: Positions [mm], shape (v, 3).
        quads: Its faces, counter-clockwise from outside, shape (q, 4).
        scale: How much larger than life each vertex shall be, shape (v,).
    """
    # Every corner of a quad is held convex, so that its middle lies inside it.
    triangles = np.concatenate([np.roll(quads, -turn, axis=1)[:, :3] for turn in range(4)])
    loops = _boundary(quads)
    lengths = [np.linalg.norm(vertices[np.roll(p, -1)] - vertices[p], axis=1) for p in loops]
    outer = int(np.argmax([length.sum() for length in lengths]))
    flat = _embedded(vertices, quads, loops, lengths, outer)
    inverse, areas = _rest_frames(vertices, triangles, scale)
    # A hole is kept open by a fan about its middle: its two sides never cross.
    middle = len(vertices)
    for number, (loop, length) in enumerate(zip(loops, lengths, strict=True)):
        if number != outer:
            fan = np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), middle)])
            sides = _fan_sides(length * scale[loop])
            triangles = np.concatenate([triangles, fan])
            inverse = np.concatenate([inverse, np.linalg.inv(sides)])
            areas = np.concatenate([areas, HOLE_WEIGHT * np.linalg.det(sides) / 2])
            middle += 1
    return _relaxed(flat, triangles, inverse, areas)[: len(vertices)]


def _fan_sides(lengths: FloatArray) -> FloatArray:
    """Return the flat sides of triangles on a hole's edges (k,), as high as the hole is narrow."""
    sides = np.zeros((len(lengths), 2, 2))
    sides[:, 0, 0], sides[:, 0, 1] = lengths, lengths / 2
    sides[:, 1, 1] = lengths.sum() / (4 * np.pi)
    return sides


def _embedded(
    vertices: FloatArray,
    quads: IntArray,
    loops: list[IntArray],
    lengths: list[FloatArray],
    outer: int,
) -> FloatArray:
    """Return Tutte's embedding on a circle; each hole inside is filled by one vertex more."""
    from scipy.sparse.linalg import splu  # Here: a start does without.

    # The highest point of the front of the midline goes to the top.
    loop = loops[outer]
    top = np.argmin(np.abs(vertices[loop, 0]) * 1e6 - vertices[loop, 1] - vertices[loop, 2])
    loop, length = np.roll(loop, -top), np.roll(lengths[outer], -top)
    angle = np.pi / 2 + 2 * np.pi * (np.cumsum(length) - length) / length.sum()
    size = len(vertices) + len(loops) - 1
    starts, ends = [quads.ravel()], [np.roll(quads, -1, axis=1).ravel()]
    center = len(vertices)
    for number, hole in enumerate(loops):
        if number != outer:
            starts.append(hole)
            ends.append(np.full(len(hole), center))
            center += 1
    pairs = np.column_stack([np.concatenate(starts), np.concatenate(ends)])
    i, j = np.unique(np.sort(pairs, axis=1), axis=0).T
    graph = sp.csr_array((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(size, size))
    laplacian = sp.csr_array(sp.diags_array(np.asarray(graph.sum(axis=1))) - graph)
    inside = np.setdiff1d(np.arange(size), loop)
    flat = np.zeros((size, 2))
    flat[loop] = np.column_stack([np.cos(angle), np.sin(angle)])
    known = laplacian[inside][:, loop] @ flat[loop]
    flat[inside] = splu(laplacian[inside][:, inside].tocsc()).solve(-known)
    return flat


def _boundary(quads: IntArray) -> list[IntArray]:
    """Return the boundary loops, each in the order of the faces' sides."""
    starts, ends = quads.ravel(), next_corners(quads).ravel()
    size = int(quads.max()) + 1
    open_sides = ~np.isin(starts * size + ends, ends * size + starts)
    follows = dict(zip(starts[open_sides].tolist(), ends[open_sides].tolist(), strict=True))
    loops = []
    while follows:
        first = min(follows)
        loop, here = [first], follows.pop(first)
        while here != first:
            loop.append(here)
            here = follows.pop(here)
        loops.append(np.array(loop))
    return loops


def _rest_frames(
    vertices: FloatArray, triangles: IntArray, scale: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return each triangle's map from its flat sides to its Jacobian (t, 2, 2), and its area."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    u, v = b - a, c - a
    length = np.linalg.norm(u, axis=1)
    along = (u * v).sum(axis=1) / length
    across = np.linalg.norm(np.cross(u, v), axis=1) / length
    larger = scale[triangles].mean(axis=1)
    sides = np.zeros((len(triangles), 2, 2))
    sides[:, 0, 0], sides[:, 0, 1], sides[:, 1, 1] = length, along, across
    sides *= larger[:, None, None]
    return np.asarray(np.linalg.inv(sides)), np.asarray(np.linalg.det(sides) / 2)


def _jacobians(flat: FloatArray, triangles: IntArray, inverse: FloatArray) -> FloatArray:
    a, b, c = (flat[triangles[:, corner]] for corner in range(3))
    return np.asarray(np.stack([b - a, c - a], axis=2) @ inverse)


def _energy(jacobians: FloatArray, areas: FloatArray) -> float:
    """Return the symmetric Dirichlet energy, infinite where a triangle is flipped."""
    determinant = np.linalg.det(jacobians)
    if determinant.min() <= 0:
        return float("inf")
    square = (jacobians**2).sum(axis=(1, 2))
    return float((areas * (square + square / determinant**2)).sum())


def _relaxed(
    flat: FloatArray, triangles: IntArray, inverse: FloatArray, areas: FloatArray
) -> FloatArray:
    own = _jacobians(flat, triangles, inverse)
    flat = flat / np.sqrt((np.linalg.det(own) * areas).sum() / areas.sum())
    gradient = _gradient(triangles, inverse, len(flat))
    for _ in range(RELAXATIONS):
        jacobians = _jacobians(flat, triangles, inverse)
        target = _proxy_minimum(jacobians, gradient, areas, flat)
        flat = _step(flat, target - flat, triangles, inverse, areas)
    return flat


def _gradient(triangles: IntArray, inverse: FloatArray, size: int) -> list[sp.csr_array]:
    """Return for each of the two rest axes the map from flat coordinate to its derivative."""
    rows = np.repeat(np.arange(len(triangles)), 3)
    matrices = []
    for axis in range(2):
        b, c = inverse[:, 0, axis], inverse[:, 1, axis]
        values = np.column_stack([-b - c, b, c]).ravel()
        shape = (len(triangles), size)
        matrices.append(sp.csr_array((values, (rows, triangles.ravel())), shape=shape))
    return matrices


def _proxy_minimum(
    jacobians: FloatArray, gradient: list[sp.csr_array], areas: FloatArray, flat: FloatArray
) -> FloatArray:
    """Return where the weighted distance of all Jacobians to their rotations is least."""
    from scipy.sparse.linalg import splu  # Here: a start does without.

    u, sigma, vt = np.linalg.svd(jacobians)
    rotation = u @ vt
    near_one = np.abs(sigma - 1) < 1e-6
    ratio = (sigma - sigma**-3.0) / np.where(near_one, 1.0, sigma - 1)
    weight = np.where(near_one, 4.0, ratio)
    squared = areas[:, None, None] * (u @ (weight[:, :, None] * np.swapaxes(u, 1, 2)))
    du, dv = gradient
    blocks, right = [], []
    for i in range(2):
        row = []
        for j in range(2):
            diagonal = sp.diags_array(squared[:, i, j])
            row.append(du.T @ diagonal @ du + dv.T @ diagonal @ dv)
        blocks.append(row)
        wanted = squared[:, i, :] @ np.eye(2)
        right.append(
            du.T @ (wanted * rotation[:, :, 0]).sum(axis=1)
            + dv.T @ (wanted * rotation[:, :, 1]).sum(axis=1)
        )
    matrix = sp.csc_array(sp.block_array(blocks))
    # The pull to where it is now is weak: it only takes away the freedom to shift.
    pull = 1e-5 * matrix.diagonal().mean()
    matrix = sp.csc_array(matrix + pull * sp.eye_array(matrix.shape[0]))
    solution = splu(matrix).solve(np.concatenate(right) + pull * flat.T.ravel())
    return np.asarray(solution.reshape(2, -1).T)


def _step(
    flat: FloatArray,
    move: FloatArray,
    triangles: IntArray,
    inverse: FloatArray,
    areas: FloatArray,
) -> FloatArray:
    """Return the longest of ever shorter steps that lowers the energy and flips nothing."""
    before = _energy(_jacobians(flat, triangles, inverse), areas)
    step = 1.0
    while step > 1e-4:
        tried = flat + step * move
        if _energy(_jacobians(tried, triangles, inverse), areas) < before:
            return tried
        step *= 0.6
    return flat
