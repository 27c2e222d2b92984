"""Where each piece of skin lies on the texture: islands flattened with little stretch, packed.

The islands meet where nobody looks: under the hair, inside lips and nostrils, down the nape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .anatomy import smoothstep
from .cage import Cage
from .flattening import flattened
from .subdivision import Level, Limit

MOUTH = ("mouth_inner", "upper_lip_inner", "lower_lip_inner")
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


@dataclass(frozen=True, eq=False)
class Pieces:
    """The skin cut into islands at its first level, not yet flat.

    Attributes:
        islands: Index into `ISLANDS` of each cage face, shape (f,).
        level: The level.
        fine: The next one.
        vertices: Positions [mm], shape (v, 3).
        slit: Whether each vertex of the next level lies where islands are cut.
        keys: Vertex times `CHARTS` plus chart, sorted, shape (k,).
        corners: Place among `keys` of each quad's corners, shape (q, 4).
    """

    islands: IntArray
    level: Level
    fine: Level
    vertices: FloatArray
    slit: BoolArray
    keys: IntArray
    corners: IntArray

    @classmethod
    def of(cls, cage: Cage, limit: Limit, points: FloatArray) -> Pieces:
        """Return the pieces of the skin.

        Args:
            cage: The cage.
            limit: Its limit surface.
            points: The cage's points [mm], shape (v, 3).
        """
        islands = face_islands(cage)
        level, fine = limit.levels[1], limit.levels[2]
        vertices = limit.positions(points, 1)
        quads = level.topology.faces
        charts = _charts(islands, _behind(level, vertices), quads, level.parents)
        keys, corners = np.unique(quads * CHARTS + charts, return_inverse=True)
        slit = _behind(fine, limit.positions(points, 2))
        return cls(islands, level, fine, vertices, slit, keys, corners.reshape(charts.shape))

    def authored(self) -> list[tuple[int, IntArray, IntArray]]:
        """Return the islands that are flattened; those on the right are their mirror images.

        Each is its index into `ISLANDS`, the place among `keys` of its vertices, shape (i,), and
        its quads by place among those, shape (p, 4).
        """
        found = []
        for number, island in enumerate(ISLANDS):
            quads = self.corners[self.islands[self.level.parents] == number]
            if len(quads) and not island.name.endswith(".R"):
                used, local = np.unique(quads, return_inverse=True)
                found.append((number, used, local.reshape(quads.shape)))
        return found

    def image(self, used: IntArray) -> IntArray:
        """Return the place among `keys` of the mirror image of each used one."""
        return _mirrored_keys(self.keys, used, self.level.mirror)


def unwrap(cage: Cage, limit: Limit, points: FloatArray) -> Unwrap:
    """Return the map of the skin, its islands flattened anew.

    Args:
        cage: The cage.
        limit: Its limit surface.
        points: The cage's points [mm], shape (v, 3).
    """
    pieces = Pieces.of(cage, limit, points)
    return laid_out(pieces, flattened_islands(pieces))


def flattened_islands(pieces: Pieces) -> FloatArray:
    """Return the authored islands laid flat [mm], one after another, shape (n, 2)."""
    found = []
    for number, used, quads in pieces.authored():
        name = ISLANDS[number].name
        rest = pieces.vertices[pieces.keys[used] // CHARTS]
        flat = flattened(rest, quads, importance(name, rest))
        if not name.endswith(".L"):
            image = np.searchsorted(used, pieces.image(used))
            flat = (flat + flat[image] * [-1.0, 1.0]) / 2
        found.append(flat)
    return np.concatenate(found)


def laid_out(pieces: Pieces, flat: FloatArray) -> Unwrap:
    """Return the map of the skin.

    Args:
        pieces: Its islands.
        flat: As `flattened_islands` returns them.
    """
    uvs = np.zeros((len(pieces.keys), 2))
    start = 0
    for number, used, _ in pieces.authored():
        own = flat[start : start + len(used)]
        start += len(used)
        uvs[used] = _packed(own, ISLANDS[number])
        if ISLANDS[number].name.endswith(".L"):
            uvs[pieces.image(used)] = _packed(own * [-1.0, 1.0], ISLANDS[number + 1])
    return _refined(pieces, uvs)


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


def _refined(pieces: Pieces, uvs: FloatArray) -> Unwrap:
    """Return the map of the next level: edges halved, each quad's middle its corners' mean."""
    fine = pieces.fine
    children = fine.topology.faces.reshape(len(pieces.corners), 4, 4)
    own = uvs[pieces.corners]
    after, before = np.roll(own, -1, axis=1), np.roll(own, 1, axis=1)
    middle = np.broadcast_to(own.mean(axis=1, keepdims=True), own.shape)
    placed = np.stack([own, (own + after) / 2, middle, (own + before) / 2], axis=2)
    vertices = children.reshape(-1, 4)
    charts = _charts(pieces.islands, pieces.slit, vertices, fine.parents)
    keys, first = np.unique(vertices * CHARTS + charts, return_index=True)
    return Unwrap(pieces.islands, pieces.slit, keys, placed.reshape(-1, 2)[first])
