"""Parts that a clip's file draws with fewer vertices, where it is not of the level "high".

Hair is most of a head's vertices, and brows and lashes have morph targets. A file at a lower level
has fewer and coarser strands, each wider, so that as much is covered; and what is seen of gums,
palate and the backs of teeth needs no more corners than the skin has.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_array

from ..arrays import BoolArray, FloatArray, IntArray
from ..head.head import Part
from .drawn import unit_normals

FULL_LEVEL = "high"


@dataclass(frozen=True)
class Thinning:
    """How strands are made fewer.

    Attributes:
        kept: One strand of so many is kept.
        points: One point of so many along each is kept; the root and the tip always are.
        width: Factor on the width of those that are kept.
    """

    kept: int = 1
    points: int = 1
    width: float = 1.0


THINNINGS = {
    "hair": Thinning(kept=4, points=2, width=2.7),
    "hairline": Thinning(points=2),
    "flyaways": Thinning(kept=8, points=2),
    "baby_hairs": Thinning(kept=8, points=2, width=1.3),
    "brows": Thinning(kept=3, points=2, width=2.7),
    "lashes": Thinning(kept=3, points=3, width=2.2),
}
"""By the name of the part."""
CELLS = {"caruncle": 1.5, "teeth": 2.2, "gum": 2.5, "palate": 3.0, "mouth_floor": 3.0}
"""Side of the cells whose vertices become one [mm], by the name of the part without its side."""
IN_FRONT, TOWARDS = 78.0, -0.1
"""Of teeth, vertices farther forward [mm] whose normals point forward at all, z, stay as they are:
the faces of incisors and canines are what a smile shows."""


@lru_cache(maxsize=32)
def lighter(part: Part, level: str) -> Part:
    """Return a part as a file at some level draws it: thinned, or coarser, or as it is."""
    if level == FULL_LEVEL:
        return part
    if part.name in THINNINGS:
        return _thinned(part, THINNINGS[part.name])
    kind = part.name.partition(".")[0]
    if kind not in CELLS:
        return part
    shown = (part.vertices[:, 2] > IN_FRONT) & (part.normals[:, 2] > TOWARDS)
    return _coarser(part, CELLS[kind], shown if kind == "teeth" else np.zeros_like(shown))


def _thinned(part: Part, thinning: Thinning) -> Part:
    """Return fewer strands, with fewer points.

    Strands are ribbons: two vertices a point, in order from the root, and one or two at the tip.
    """
    chosen: list[IntArray] = []
    partners: list[IntArray] = []
    triangles: list[IntArray] = []
    count = 0
    for strand in _strands(part)[:: thinning.kept]:
        pairs, tip = divmod(len(strand), 2)
        rows = np.unique([*range(0, pairs, thinning.points), *(() if tip else (pairs - 1,))])
        own = np.concatenate([strand[2 * rows[:, None] + [0, 1]].ravel(), strand[2 * pairs :]])
        other = np.concatenate([strand[2 * rows[:, None] + [1, 0]].ravel(), strand[2 * pairs :]])
        chosen.append(own)
        partners.append(other)
        triangles.append(_strip(len(own)) + count)
        count += len(own)
    return _only(part, np.concatenate(chosen), np.concatenate(partners), triangles, thinning.width)


def _strands(part: Part) -> list[IntArray]:
    """Return the vertices of each strand, in order."""
    from scipy.sparse.csgraph import connected_components  # Here: a start does without.

    edges = part.triangles[:, [0, 1, 1, 2]].reshape(-1, 2)
    count = len(part.vertices)
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    order = np.argsort(labels, kind="stable")
    starts = np.flatnonzero(np.diff(labels[order])) + 1
    return sorted(np.split(order, starts), key=lambda strand: int(strand[0]))


def _strip(count: int) -> IntArray:
    """Return the triangles of a ribbon of some vertices."""
    return np.array(
        [[i, i + 1, i + 2] if i % 2 == 0 else [i + 1, i, i + 2] for i in range(count - 2)],
        dtype=np.int64,
    ).reshape(-1, 3)


def _only(
    part: Part, chosen: IntArray, partners: IntArray, triangles: list[IntArray], width: float
) -> Part:
    middle = (part.vertices[chosen] + part.vertices[partners]) / 2
    vertices: FloatArray = middle + width * (part.vertices[chosen] - middle)
    return replace(
        part,
        vertices=vertices,
        normals=part.normals[chosen],
        triangles=np.concatenate(triangles),
        colors=part.colors[chosen],
        roots=None if part.roots is None else part.roots[chosen],
        hair=None if part.hair is None else part.hair[chosen],
        uvs=None if part.uvs is None else part.uvs[chosen],
    )


def _coarser(part: Part, cell: float, kept: BoolArray) -> Part:
    """Return a part in which all vertices of a cell that face the same way are one: their mean.

    Those that are `kept`, shape (v,), stay as they are.
    """
    facing = (part.normals > 0).astype(np.int64) @ np.array([1, 2, 4])
    alone = np.where(kept, np.arange(1, len(kept) + 1), 0)
    cells = np.column_stack([np.floor(part.vertices / cell).astype(np.int64), facing, alone])
    labels = np.unique(cells, axis=0, return_inverse=True)[1].ravel()
    triangles = labels[part.triangles]
    flat = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    whole = triangles[~flat]
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    used, renamed = np.unique(whole[np.sort(first)], return_inverse=True)
    return replace(
        part,
        vertices=_means(part.vertices, labels)[used],
        normals=unit_normals(_means(part.normals, labels))[used],
        triangles=renamed.reshape(-1, 3),
        colors=_means(part.colors, labels)[used],
    )


def _means(values: FloatArray, labels: IntArray) -> FloatArray:
    """Return the mean of the rows of each label, shape (labels, 3)."""
    sums = [np.bincount(labels, values[:, column]) for column in range(values.shape[1])]
    return np.asarray(np.stack(sums, axis=1) / np.bincount(labels)[:, None])
