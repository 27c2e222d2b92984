"""Where each piece of skin lies on the texture: islands flattened with little stretch, packed.

The islands meet where nobody looks: under the hair, inside lips and nostrils, down the nape. Each
is embedded on a disk (Tutte 1963), then relaxed to the least symmetric Dirichlet energy without a
flip (Rabinovich, Poranne, Panozzo, Sorkine-Hornung 2017, "Scalable Locally Injective Mappings").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ..arrays import BoolArray, FloatArray, IntArray
from .anatomy import smoothstep
from .cage import Cage
from .subdivision import Level, Limit
from .topology import next_corners

MOUTH = ("mouth_inner", "upper_lip_inner", "lower_lip_inner")
RELAXATIONS = 24
"""Steps of the relaxation; the energy then falls by less than a thousandth each."""
HOLE_WEIGHT = 0.08
"""How much a hole's shape counts beside the skin's."""
GUTTER = 4 / 1024
"""Room round each island, of the map's side."""


@dataclass(frozen=True)
class Island:
    """A piece of skin on the map.

    Attributes:
        name: "face", "scalp", "neck", "mouth", "nostril.L" …
        room: Left, top, right, bottom of the rectangle that it may fill, of the map's side.
        cut: Whether it is slit down the midline behind.
    """

    name: str
    room: tuple[float, float, float, float]
    cut: bool = False


ISLANDS = (
    Island("face", (0.0, 0.0, 0.84, 0.78)),
    Island("scalp", (0.48, 0.78, 0.72, 1.0)),
    Island("neck", (0.0, 0.78, 0.48, 1.0), cut=True),
    Island("mouth", (0.84, 0.0, 1.0, 0.22)),
    Island("nostril.L", (0.84, 0.22, 0.92, 0.32)),
    Island("nostril.R", (0.92, 0.22, 1.0, 0.32)),
    Island("ear.L", (0.84, 0.32, 1.0, 0.66)),
    Island("ear.R", (0.84, 0.66, 1.0, 1.0)),
)


@dataclass(frozen=True, eq=False)
class Unwrap:
    """Places on the map of the finest level's vertices, one a chart.

    A chart is an island, or one bank of its cut: 2 island + bank.

    Attributes:
        islands: Index into `ISLANDS` of each cage face, shape (f,).
        slit: Whether each vertex of the finest level lies where islands are cut, shape (v,).
        keys: Vertex times `CHARTS` plus chart, sorted, shape (k,).
        uvs: Place of each, origin top left, shape (k, 2).
    """

    islands: IntArray
    slit: BoolArray
    keys: IntArray
    uvs: FloatArray

    def charts(self, vertices: IntArray, faces: IntArray) -> IntArray:
        """Return the chart of each corner (t, c): `vertices` (t, c) of cage `faces` (t,)."""
        return _charts(self.islands, self.slit, vertices, faces)

    def at(self, vertices: IntArray, charts: IntArray) -> FloatArray:
        """Return the place on the map of vertices in their charts, shape (..., 2)."""
        return self.uvs[np.searchsorted(self.keys, vertices * CHARTS + charts)]


CHARTS = 2 * len(ISLANDS)


def unwrap(cage: Cage, limit: Limit, points: FloatArray) -> Unwrap:
    """Return the map of the skin.

    Args:
        cage: The cage.
        limit: Its limit surface.
        points: The cage's points [mm], shape (v, 3).
    """
    islands = face_islands(cage)
    level = limit.levels[1]
    vertices = limit.positions(points, 1)
    slit = _behind(level, vertices)
    charts = _charts(islands, slit, level.topology.faces, level.parents)
    keys, corner = np.unique(level.topology.faces * CHARTS + charts, return_inverse=True)
    corner = corner.reshape(charts.shape)
    uvs = np.zeros((len(keys), 2))
    for number, island in enumerate(ISLANDS):
        quads = corner[islands[level.parents] == number]
        if len(quads) and not island.name.endswith(".R"):
            used, local = np.unique(quads, return_inverse=True)
            rest = vertices[keys[used] // CHARTS]
            flat = flattened(rest, local.reshape(quads.shape), importance(island.name, rest))
            image = _mirrored_keys(keys, used, level.mirror)
            if island.name.endswith(".L"):
                uvs[used] = _packed(flat, island)
                right = ISLANDS[number + 1]
                uvs[image] = _packed(flat * [-1.0, 1.0], right)
            else:
                place = np.searchsorted(used, image)
                uvs[used] = _packed((flat + flat[place] * [-1.0, 1.0]) / 2, island)
    fine = limit.levels[2]
    return _refined(islands, level, fine, corner, uvs, _behind(fine, limit.positions(points, 2)))


def face_islands(cage: Cage) -> IntArray:
    """Return the island of each cage face as an index into `ISLANDS`, shape (f,)."""
    regions = np.array(cage.regions)
    place = {island.name: index for index, island in enumerate(ISLANDS)}
    right = np.arange(len(regions)) >= len(regions) // 2
    islands = np.full(len(regions), place["face"])
    for name in ("scalp", "neck"):
        islands[regions == name] = place[name]
    islands[np.isin(regions, MOUTH)] = place["mouth"]
    for name in ("nostril", "ear"):
        islands[regions == name] = place[f"{name}.L"]
        islands[(regions == name) & right] = place[f"{name}.R"]
    return islands


def importance(island: str, vertices: FloatArray) -> FloatArray:
    """Return how much larger than life each vertex is laid out, shape (v,)."""
    if island != "face":
        return np.ones(len(vertices))
    x, y, z = np.abs(vertices[:, 0]), vertices[:, 1], vertices[:, 2]
    front = smoothstep(15, 75, z)
    eyes = np.exp(-(((x - 31) / 22) ** 2) - (y / 14) ** 2)
    lips = np.exp(-((x / 30) ** 2) - ((y + 72) / 14) ** 2)
    return np.asarray((0.72 + 0.28 * front) * (1 + 0.25 * eyes + 0.2 * lips))


def _behind(level: Level, vertices: FloatArray) -> BoolArray:
    midline = level.mirror == np.arange(len(level.mirror))
    return np.asarray(midline & (vertices[:, 2] < 0))


def _charts(islands: IntArray, slit: BoolArray, vertices: IntArray, faces: IntArray) -> IntArray:
    is_cut = np.array([island.cut for island in ISLANDS])[islands[faces]]
    right = faces >= len(islands) // 2
    bank = slit[vertices] & (is_cut & right)[:, None]
    return np.asarray(2 * islands[faces][:, None] + bank)


def _mirrored_keys(keys: IntArray, used: IntArray, mirror: IntArray) -> IntArray:
    """Return the place among `keys` of the mirror image of each used one."""
    vertex, chart = keys[used] // CHARTS, keys[used] % CHARTS
    image = mirror[vertex]
    island = chart // 2
    names = [island_.name for island_ in ISLANDS]
    is_left = np.array([name.endswith(".L") for name in names])[island]
    # The banks of a cut lie opposite each other.
    cut = np.array([isl.cut for isl in ISLANDS])[island] & (image == vertex)
    both = np.isin(vertex * CHARTS + (chart ^ 1), keys)
    other = np.where(is_left, chart + 2, np.where(cut & both, chart ^ 1, chart))
    return np.searchsorted(keys, image * CHARTS + other)


def _packed(flat: FloatArray, island: Island) -> FloatArray:
    """Return an island in its room, as large as it fits, the y axis pointing down."""
    placed = flat * [1.0, -1.0]
    low, high = placed.min(axis=0), placed.max(axis=0)
    left, top, right, bottom = island.room
    room = np.array([right - left, bottom - top]) - 2 * GUTTER
    scale = (room / (high - low)).min()
    middle = np.array([left + right, top + bottom]) / 2
    return np.asarray((placed - (low + high) / 2) * scale + middle)


def _refined(
    islands: IntArray,
    coarse: Level,
    fine: Level,
    corner: IntArray,
    uvs: FloatArray,
    slit: BoolArray,
) -> Unwrap:
    """Return the map of the next level: edges halved, each quad's middle its corners' mean."""
    children = fine.topology.faces.reshape(len(corner), 4, 4)
    own = uvs[corner]
    after, before = np.roll(own, -1, axis=1), np.roll(own, 1, axis=1)
    middle = np.broadcast_to(own.mean(axis=1, keepdims=True), own.shape)
    placed = np.stack([own, (own + after) / 2, middle, (own + before) / 2], axis=2)
    vertices = children.reshape(-1, 4)
    charts = _charts(islands, slit, vertices, fine.parents)
    keys, first = np.unique(vertices * CHARTS + charts, return_index=True)
    return Unwrap(islands, slit, keys, placed.reshape(-1, 2)[first])


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
