"""A finer cage where creases form: forehead, glabella, the outer corner of the eye.

Cells of the cage are 8 to 15 mm, those of the forehead up to 19 mm tall: a furrow is narrower.
Ladders of edges are cut in two; a face between two cut edges becomes two, one at a ladder's end
a fan of triangles. New points lie on the smooth surface through the old ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from .cage import Cage, mirrored
from .geometry import best_fan
from .patches import HalfCage
from .subdivision import Limit

NEW_ROW = "X"
"""Row of the new points' names, followed by the number of their ladder."""


@dataclass(frozen=True)
class Ladder:
    """Edges to cut, one after the other across a strip of faces.

    Attributes:
        first: Points on one side of the strip.
        second: Their partners on the other, same length.
    """

    first: tuple[str, ...]
    second: tuple[str, ...]


def _row(row: str, last: int) -> tuple[str, ...]:
    return tuple(f"{row}_{place}" for place in range(last + 1))


BROW = ("b1_0", "b1_1", "b1_2", "E4_2", "E4_3", "E4_4", "E4_5", "E4_6")
LADDERS = (
    Ladder(BROW[:7], _row("G1", 6)),
    Ladder((*_row("G1", 7), "W3_1"), (*_row("G2", 7), "W2_1")),
    Ladder((*_row("G2", 7), "W2_1"), (*_row("G3", 7), "W1_1")),
    Ladder(_row("G3", 7), _row("G4", 7)),
    Ladder(
        tuple(f"E4_{spoke}" for spoke in (6, 7, 8, 9, 10)),
        tuple(f"W{row}_1" for row in (4, 5, 6, 7, 8)),
    ),
)


def finer(cage: Cage, points: FloatArray, limit: Limit) -> Cage:
    """Return the cage with its ladders cut, its points on the smooth surface.

    Args:
        cage: The authored cage.
        points: Its faired points [mm], shape (v, 3).
        limit: The smooth surface through them, with one refinement at least.

    Returns:
        The finer cage: the points of the old one keep their names.
    """
    topology = limit.levels[0].topology
    smooth = limit.positions(points, 1)
    half = HalfCage()
    count = len(points)
    own = [index for index in range(count) if cage.left[cage.names[index]] == index]
    for index in own:
        half.place(cage.names[index], points[index])
    middles: dict[frozenset[str], str] = {}
    for number, ladder in enumerate(LADDERS):
        for place, ends in enumerate(zip(ladder.first, ladder.second, strict=True)):
            edge = topology.edge_index(*(np.array([cage.left[end]]) for end in ends))
            name = f"{NEW_ROW}{number}_{place}"
            half.place(name, smooth[count + int(edge[0])])
            middles[frozenset(ends)] = name
    fresh = []
    for face, region in zip(cage.faces[: len(cage.faces) // 2], cage.regions, strict=False):
        corners = [cage.names[index] for index in face if index >= 0]
        pieces = _cut(corners, middles, half)
        for piece in pieces:
            half.face(region, *piece)
        fresh += [len(pieces) > 1] * len(pieces)
    return replace(mirrored(half), fine=np.array([*fresh, *fresh]))


def _cut(
    corners: list[str], middles: dict[frozenset[str], str], half: HalfCage
) -> list[tuple[str, ...]]:
    """Return the pieces of a face whose edges are cut at `middles`."""
    outline: list[str] = []
    for start, end in pairwise([*corners, corners[0]]):
        outline.append(start)
        middle = middles.get(frozenset((start, end)))
        if middle:
            outline.append(middle)
    if len(outline) == len(corners):
        return [tuple(corners)]
    places = [place for place, name in enumerate(outline) if name not in corners]
    if len(corners) == 4 and len(places) == 2 and places[1] - places[0] == 3:
        low, high = places
        return [tuple(outline[low : high + 1]), tuple(outline[high:] + outline[: low + 1])]
    is_middle = np.isin(np.arange(len(outline)), places)
    points = np.array([half.points[name] for name in outline])
    fan = best_fan(np.arange(len(outline)), is_middle, points)
    return [tuple(outline[place] for place in piece) for piece in fan]
