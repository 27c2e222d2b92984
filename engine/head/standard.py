"""The heads that come with the engine: the standard one and people, and the paper's mask."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray
from ..cache import cached_arrays
from ..errors import UnknownName
from .cage import Cage, build_cage
from .fairing import faired_points
from .finer import finer
from .groom import groomed
from .head import DrawnSurface, Eye, Head, Part
from .identity import moved_arrays, person_from, with_moved
from .landmarks import landmark_vertices
from .layout import unwrapped
from .paint import painted
from .parts import brows_part, eyes_of, hair_parts, head_parts, lashes_part
from .patches import EYE_CENTER, EYE_RADIUS
from .recipe import STANDARD, Recipe
from .skin import LEVELS, SkinMesh, drawn_surface, skin_mesh, textured, tissue_as_drawn
from .storage import head_from_arrays, head_to_arrays, source_key
from .subdivision import Limit, cage_level, limit_surface
from .tissue_surface import TissueSurface, face_sheet, symmetric_triangles, tissue_surface
from .topology import Topology

# Semi-sharp creases along rows of the cage; chosen by eye.
CREASES = (
    ([f"E2_{spoke}" for spoke in range(2, 7)], 0.85),  # crease of the upper lid
    (["E2_1", "E2_2"], 0.4),  # its ends run out softly
    (["E2_6", "E2_7"], 0.4),
    ([f"E1_{spoke % 16}" for spoke in range(17)], 0.6),  # front edge of the lids
    ([f"M2_{spoke}" for spoke in range(11)], 0.35),  # border of the lips
    (["b5_3", "b6_3", "M4_3", "M4_2"], 0.5),  # crease round the wing of the nose
)

PAPER_NECK_ROWS = ("Q1", "Q2")
PAPER_NECK_POINTS = 10
"""Points of each neck row, from the midline, that the paper's mask takes in."""


@dataclass(frozen=True, eq=False)
class Sculpture:
    """The built-in head before it becomes tissue and skin.

    Attributes:
        cage: The authored cage.
        points: Its faired points [mm], shape (v, 3).
        limit: The smooth surface through them.
        finest: Positions of the finest level [mm], shape (d, 3).
        eyes: Left and right eyeball.
    """

    cage: Cage
    points: FloatArray
    limit: Limit
    finest: FloatArray
    eyes: tuple[Eye, Eye]


def standard_head(level: str = "high") -> Head:
    """Return the built-in head.

    Args:
        level: Detail of the drawn skin: "low" (3,660 triangles), "medium" (7,164) or "high"
            (28,416). The tissue is the same at all levels.

    Raises:
        UnknownName: There is no such level.
    """
    return person_head(STANDARD, level)


def person_head(recipe: Recipe, level: str = "high") -> Head:
    """Return the head of the person that a recipe describes; its tissue is the same at all levels.

    Raises:
        UnknownName: There is no such level.
    """
    if level not in LEVELS:
        raise UnknownName("level of detail", level, LEVELS)
    reference = groomed(reference_head(level), level, recipe)
    arrays = cached_arrays(
        "person",
        source_key(f"{level}-{recipe!r}"),
        lambda: moved_arrays(person_from(_in_colors(reference, recipe), recipe)),
    )
    person = with_moved(reference, arrays)
    return replace(person, parts=eyes_of(person.parts, recipe))


def _in_colors(head: Head, recipe: Recipe) -> Head:
    return replace(head, drawn=painted(head.drawn, recipe))


@lru_cache(maxsize=len(LEVELS))
def reference_head(level: str) -> Head:
    """Return the head that all people are made from; what a warp leaves as it is, they share.

    It has no hair, and neither skin nor eyes are painted: each person's are their own.
    """
    return _cached(f"standard-{level}", lambda: _standard(level))


def paper_head() -> Head:
    """Return the head at the size of Zhang, Prakash, Sung 2001: a mask of about 1,280 triangles.

    It is drawn as it is simulated, triangle by triangle.
    """
    return _cached("paper", _paper)


def sculpt(*, fine: bool = True) -> Sculpture:
    """Return the built-in head's cage, surface, colours and eyes; `fine` where creases form."""
    cage = build_cage()
    points = faired_points(cage)
    limit = limit_surface(cage_level(*_creased(cage)))
    if fine:
        cage = finer(cage, points, limit)
        points = cage.points
        limit = limit_surface(cage_level(*_creased(cage)))
    left = Eye(EYE_CENTER.copy(), EYE_RADIUS)
    right = Eye(EYE_CENTER * [-1.0, 1.0, 1.0], EYE_RADIUS)
    finest = limit.positions(points, 2)
    return Sculpture(cage, points, limit, finest, (left, right))


def _cached(name: str, build: Callable[[], Head]) -> Head:
    arrays = cached_arrays("head", source_key(name), lambda: head_to_arrays(build()))
    return head_from_arrays(arrays)


def _standard(level: str) -> Head:
    sculpture = sculpt()
    cage, limit = sculpture.cage, sculpture.limit
    tissue = tissue_surface(cage, sculpture.points, face_sheet(cage))
    mesh = skin_mesh(cage, limit, sculpture.points, LEVELS[level])
    mesh = textured(mesh, unwrapped(cage, limit, sculpture.points))
    drawn = drawn_surface(cage, limit, mesh, sculpture.finest, tissue.cage_points, sculpture.eyes)
    return _assembled("standard", sculpture, tissue, mesh, drawn, ())


def _paper() -> Head:
    sculpture = sculpt(fine=False)
    cage = sculpture.cage
    quads = tissue_surface(cage, sculpture.points, _mask(cage))
    tissue = _in_triangles(quads, sculpture.points[quads.cage_points])
    mesh = SkinMesh(
        level=0,
        indices=tissue.cage_points,
        vertices=sculpture.points[tissue.cage_points],
        triangles=tissue.triangles,
        cage_faces=tissue.triangle_faces,
    )
    drawn = painted(tissue_as_drawn(cage, mesh, sculpture.eyes))
    grown = [
        brows_part(drawn),
        lashes_part(drawn, _lid_edge(sculpture)),
        *_skullcap(sculpture, tissue),
    ]
    bare = _assembled("paper", sculpture, tissue, mesh, drawn, grown)
    return replace(bare, parts=eyes_of(bare.parts, STANDARD))


def _skullcap(sculpture: Sculpture, tissue: TissueSurface) -> list[Part]:
    """Return what the paper's mask leaves out, as rigid parts: back of the head, neck, hair."""
    cage = sculpture.cage
    mesh = skin_mesh(cage, sculpture.limit, sculpture.points, 0)
    whole = painted(
        drawn_surface(
            cage, sculpture.limit, mesh, sculpture.finest, tissue.cage_points, sculpture.eyes
        )
    )
    left_out = whole.triangles[~np.isin(mesh.cage_faces, tissue.triangle_faces)]
    used, renumbered = np.unique(left_out, return_inverse=True)
    back = Part(
        name="scalp",
        vertices=whole.vertices[used],
        normals=whole.normals[used],
        triangles=renumbered.reshape(-1, 3),
        colors=whole.colors[used],
        material="skin",
        follows="skull",
        hair=whole.hair[used],
    )
    still = replace(whole, map=sp.csr_array((len(whole.vertices), len(tissue.cage_points))))
    # The mask does not reach the hairline, so all hair keeps still with the skull.
    hair = [replace(part, follows="skull", roots=None) for part in hair_parts(still)]
    return [back, *hair]


def _assembled(
    name: str,
    sculpture: Sculpture,
    tissue: TissueSurface,
    mesh: SkinMesh,
    drawn: DrawnSurface,
    hair: Sequence[Part],
) -> Head:
    cage = sculpture.cage
    sided = cage.sided_names
    return Head(
        name=name,
        points=sculpture.points[tissue.cage_points],
        names=tuple(sided[index] for index in tissue.cage_points),
        sheet_count=tissue.sheet_count,
        polygons=tissue.polygons,
        polygon_regions=tissue.polygon_regions,
        triangles=tissue.triangles,
        mirror=tissue.mirror,
        fixed=tissue.fixed,
        jaw_weight=tissue.jaw_weight,
        depth=tissue.depth,
        anchor_weight=tissue.anchor_weight,
        follow=tissue.follow,
        follow_jaw=tissue.follow_jaw,
        drawn=drawn,
        parts=(*head_parts(drawn, _lid_edge(sculpture)), *hair),
        eyes=sculpture.eyes,
        landmarks=landmark_vertices(cage, mesh.indices),
    )


def _lid_edge(sculpture: Sculpture) -> FloatArray:
    """Return the front edge of the left lids by spoke [mm], shape (16, 3)."""
    left = sculpture.cage.left
    return np.asarray(sculpture.points[[left[f"E1_{spoke}"] for spoke in range(16)]])


def _creased(cage: Cage) -> tuple[Topology, IntArray, FloatArray]:
    """Return the cage's topology, mirror and crease of each edge."""
    topology = Topology.of(cage.faces, len(cage.points))
    sharpness = np.zeros(len(topology.edges))
    for names, value in CREASES:
        left = np.array([cage.left[name] for name in names])
        for side in (left, cage.mirror[left]):
            sharpness[topology.edge_index(side[:-1], side[1:])] = value
    return topology, cage.mirror, sharpness


def _mask(cage: Cage) -> BoolArray:
    """Return the cage faces of the paper's mask, sheet and front of the neck, shape (f,)."""
    chosen = face_sheet(cage)
    inside = np.zeros(len(cage.points), dtype=bool)
    inside[np.unique(cage.faces[chosen])] = True
    for row in PAPER_NECK_ROWS:
        for index in range(PAPER_NECK_POINTS):
            left = cage.left[f"{row}_{index}"]
            inside[[left, cage.mirror[left]]] = True
    neck = np.array(cage.regions) == "neck"
    return np.asarray(chosen | (neck & (inside[cage.faces] | (cage.faces < 0)).all(axis=1)))


def _in_triangles(tissue: TissueSurface, points: FloatArray) -> TissueSurface:
    """Return the same tissue with its sheet's quads split in two."""
    triangles = symmetric_triangles(tissue.polygons, points, tissue.mirror)
    pieces = (tissue.polygons >= 0).sum(axis=1) - 2
    return replace(
        tissue,
        polygons=np.column_stack([triangles, np.full(len(triangles), -1)]),
        polygon_regions=tuple(np.repeat(tissue.polygon_regions, pieces).tolist()),
    )
