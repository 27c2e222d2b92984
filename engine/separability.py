"""How alike action units look: cosine similarity of their settled displacement fields.

Two units that move the skin alike cannot be told apart on a face, by people or by programs. 1 is
the same look at another size, 0 has nothing in common, -1 is the opposite.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray
from .frame import Pose
from .gltf.pose import motions
from .gltf.tongue import TONGUE, posed_tongue
from .head import Part
from .measure import Face, settle
from .rig import Rig
from .timeline import Keyframe
from .tissue.layers import sheet_of

RIGID = ("gaze", "head")
"""Regions whose units move no skin: codes 51 to 66."""
HIDDEN = ("S", "EB")
"""First letters of points inside the mouth and behind the lids, which nobody sees."""
ALIKE: tuple[frozenset[str], ...] = (
    frozenset({"AU25", "AU26", "AU27"}),
    frozenset({"AU41", "AU42", "AU43", "AU45", "AU46"}),
)
"""Groups of one motion in more or less of it: FACS itself tells them by extent or by time."""
MOST_ALIKE = 0.9
"""Similarity that no other pair may reach."""


@dataclass(frozen=True, eq=False)
class Separability:
    """Pairwise similarity of units.

    Attributes:
        units: Their names, in the rig's order.
        cosines: Similarity of each two, shape (units, units), symmetric, 1 on the diagonal.
    """

    units: tuple[str, ...]
    cosines: FloatArray

    def pairs(self) -> list[tuple[str, str, float]]:
        """Return each two units once with their similarity, the most alike first."""
        rows, columns = np.triu_indices(len(self.units), 1)
        found = [
            (self.units[row], self.units[column], float(self.cosines[row, column]))
            for row, column in zip(rows, columns, strict=True)
        ]
        return sorted(found, key=lambda pair: -pair[2])

    def too_alike(self, most: float = MOST_ALIKE) -> list[tuple[str, str, float]]:
        """Return the pairs whose similarity reaches `most`, but for those within `ALIKE`."""
        return [pair for pair in self.pairs() if pair[2] >= most and not excused(*pair[:2])]


def excused(one: str, other: str) -> bool:
    """Return whether two units are more or less of one motion."""
    return any({one, other} <= group for group in ALIKE)


def separability(rig: Rig, units: Sequence[str] | None = None) -> Separability:
    """Return how alike the units of `rig` look at intensity 1, settled, weighted by area.

    Args:
        rig: Whose units.
        units: Some of them; None takes all that move skin or jaw. A unit that FACS scores on one
            side is taken on both, as two units at once, so that side alone tells nothing apart.
    """
    if units is None:
        units = [name for name, unit in rig.action_units.items() if unit.region not in RIGID]
    faces = settle(rig, [Keyframe(action_units=_both_sides(rig, name)) for name in units])
    return similarity(units, fields_of(rig, faces))


def similarity(units: Sequence[str], fields: FloatArray) -> Separability:
    """Return the similarity of weighted `fields`, shape (units, k)."""
    sizes = np.linalg.norm(fields, axis=1)
    unit = fields / np.maximum(sizes, 1e-9)[:, None]
    return Separability(tuple(units), np.asarray(unit @ unit.T))


def fields_of(rig: Rig, faces: Sequence[Face]) -> FloatArray:
    """Return what moves on `faces` as rows in which a point counts by its area, shape (faces, k).

    That is the skin, and the tongue, by which alone AU19 differs from an open mouth.
    """
    n = rig.head.sheet_count
    seen = np.array([not name.startswith(HIDDEN) for name in rig.head.names[:n]])
    weight = np.sqrt(sheet_of(rig.head).node_area * seen)[:, None]
    tongues = [part for part in rig.head.parts if part.name == TONGUE]
    return np.stack(
        [
            np.concatenate(
                [
                    (weight * face.displacements[:n]).ravel(),
                    *(_moved_part(rig, part, face.pose).ravel() for part in tongues),
                ]
            )
            for face in faces
        ]
    )


def _moved_part(rig: Rig, part: Part, pose: Pose) -> FloatArray:
    """Return how far each vertex of the tongue has moved, times the root of its area, (v, 3)."""
    vertices, _ = posed_tongue(part, pose)
    moved = motions(rig.head, rig.jaw, pose)["jaw"].move(vertices) - part.vertices
    a, b, c = (part.vertices[part.triangles[:, corner]] for corner in range(3))
    share = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0
    area = np.bincount(part.triangles.ravel(), np.repeat(share, 3), minlength=len(vertices))
    return np.asarray(np.sqrt(area)[:, None] * moved)


def _both_sides(rig: Rig, name: str) -> dict[str, float]:
    unit = rig.action_units[name]
    if unit.one_sided and unit.muscles:
        number = name.removeprefix("AU")
        return {f"L{number}": 1.0, f"R{number}": 1.0}
    return {name: 1.0}
