"""The cage: a whole head of about 1,200 named surface points, authored as one half and mirrored."""

from __future__ import annotations

import json
from collections import defaultdict, deque
from dataclasses import dataclass
from functools import cached_property
from importlib import resources

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .patches import (
    HalfCage,
    add_cheek,
    add_crown,
    add_ear,
    add_eye,
    add_forehead,
    add_mouth,
    add_neck,
    add_nose,
    add_side,
)


@dataclass(frozen=True, eq=False)
class Cage:
    """Points that the skin passes through and the faces between them.

    The left half's faces come first; face `f + face_count / 2` is the mirror image of face `f`,
    with its corners reversed but the same first corner.

    Attributes:
        names: Point names without side, length v; both mirror images carry the same name.
        points: Positions [mm], shape (v, 3).
        faces: Counter-clockwise from outside, -1 in the last column of a triangle, shape (f, 4).
        regions: Region of each face, length f.
        mirror: Mirror image of each point, shape (v,).
        fine: Which faces have been cut from larger ones, shape (f,), none if None.
    """

    names: tuple[str, ...]
    points: FloatArray
    faces: IntArray
    regions: tuple[str, ...]
    mirror: IntArray
    fine: BoolArray | None = None

    @cached_property
    def left(self) -> dict[str, int]:
        """Index of each name's point on the left half or the midline."""
        found: dict[str, int] = {}
        for index, name in enumerate(self.names):
            found.setdefault(name, index)
        return found

    @property
    def sided_names(self) -> tuple[str, ...]:
        """Names that tell the halves apart: "M1_5.L", "M1_5.R", and "M0_0" on the midline."""
        sides = np.where(self.points[:, 0] > 0, ".L", ".R")
        sides[self.mirror == np.arange(len(self.mirror))] = ""
        return tuple(name + str(side) for name, side in zip(self.names, sides, strict=True))


def authored_cage() -> bytes:
    """Return the authored points as they are stored (JSON, with a note on their source)."""
    return resources.files(__package__).joinpath("data", "cage.json").read_bytes()


def build_cage() -> Cage:
    """Return the head's cage as authored, before fairing."""
    return mirrored(build_half())


def build_half() -> HalfCage:
    """Return the left half: the authored points, everything derived from them, and the faces."""
    authored = json.loads(authored_cage())
    half = HalfCage()
    for name, row in authored["rows"].items():
        for index, position in enumerate(row["points"], start=row["first"]):
            half.place(f"{name}_{index}", position)
    for name, position in authored["points"].items():
        half.place(name, position)
    add_eye(half)
    add_mouth(half)
    add_cheek(half)
    add_nose(half)
    add_forehead(half)
    add_side(half, authored["side"])
    add_ear(half, authored["ear"])
    add_crown(half)
    add_neck(half)
    return half


def mirrored(half: HalfCage) -> Cage:
    """Return the whole head of `half`: midline points shared, all others doubled."""
    names = list(half.points)
    points = np.array([half.points[name] for name in names])
    on_midline = np.abs(points[:, 0]) < 1e-9
    points[on_midline, 0] = 0.0
    doubled = np.flatnonzero(~on_midline)
    mirror = np.arange(len(names) + len(doubled))
    mirror[doubled] = np.arange(len(names), len(mirror))
    mirror[mirror[doubled]] = doubled
    left = _oriented(half, {name: index for index, name in enumerate(names)}, points)
    return Cage(
        names=(*names, *(names[index] for index in doubled)),
        points=np.vstack([points, points[doubled] * [-1, 1, 1]]),
        faces=np.vstack([left, mirrored_faces(left, mirror)]),
        regions=(*half.regions, *half.regions),
        mirror=mirror,
    )


def mirrored_faces(faces: IntArray, mirror: IntArray) -> IntArray:
    """Return the mirror images of quads and triangles, wound so that they too face outwards.

    The first corner stays first, so that whatever is decided by corner order is decided alike on
    both halves.

    Args:
        faces: Shape (f, 4), -1 in the last column of a triangle, or (f, 3).
        mirror: Mirror image of each point.
    """
    images = np.where(faces >= 0, mirror[faces], -1)
    reversed_quads = images[:, [0, *range(faces.shape[1] - 1, 0, -1)]]
    if faces.shape[1] == 4:
        triangle = faces[:, 3] < 0
        reversed_quads[triangle] = images[triangle][:, [0, 2, 1, 3]]
    return reversed_quads


def _oriented(half: HalfCage, index: dict[str, int], points: FloatArray) -> IntArray:
    """Return the half's faces wound alike, the forehead facing forward, shape (f, 4)."""
    faces = [[index[name] for name in corners] for corners in half.faces]
    neighbours = defaultdict(list)
    for number, face in enumerate(faces):
        for start, end in zip(face, face[1:] + face[:1], strict=True):
            neighbours[frozenset((start, end))].append(number)
    seed = half.regions.index("forehead")
    a, b, c = points[faces[seed][:3]]
    if np.cross(b - a, c - a)[2] < 0:
        faces[seed].reverse()
    reached, waiting = {seed}, deque([seed])
    while waiting:
        face = faces[waiting.popleft()]
        for start, end in zip(face, face[1:] + face[:1], strict=True):
            for number in neighbours[frozenset((start, end))]:
                if number in reached:
                    continue
                other = faces[number]
                if other[(other.index(start) + 1) % len(other)] == end:
                    other.reverse()
                reached.add(number)
                waiting.append(number)
    return np.array([face + [-1] * (4 - len(face)) for face in faces])
