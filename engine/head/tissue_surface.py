"""Which part of the cage carries tissue, and what follows it: the surface that is streamed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import BoolArray, FloatArray, IntArray
from .anatomy import anchor_weight, jaw_share, tissue_depth
from .cage import Cage, mirrored_faces
from .topology import Topology, boundary_loops

HIDDEN = ("nostril", "mouth_inner", "upper_lid_inner", "lower_lid_inner")
BEYOND = ("scalp", "neck")
EAR = "ear"
NECK_RINGS = 2
"""Rings of the neck that carry tissue beyond the first, so that the open jaw finds room."""

SMOOTHED_SHARE = 0.4
"""Part of each jaw weight that is taken from the neighbours, outside the lips."""
LIP_ROWS = ("M0", "M1", "M2", "M3")


@dataclass(frozen=True)
class Follower:
    """How a hidden row follows the sheet: `leader`'s displacement times `share`, the rest jaw."""

    row: str
    leader: str
    share: float
    jaw: float


FOLLOWERS = (
    Follower("EB", "E0", 1.0, 0.0),
    Follower("S2", "M0", 0.6, 0.4),
    Follower("S3", "M0", 0.3, 0.7),
    Follower("S4", "M0", 0.0, 1.0),
    Follower("H2", "H1", 1.0, 0.0),
    Follower("H3", "H1", 0.7, 0.0),
)


@dataclass(frozen=True, eq=False)
class TissueSurface:
    """The simulated sheet and its followers, as a selection of the cage.

    Attributes:
        cage_points: Cage index of each point, the sheet's first, shape (s,).
        sheet_count: Simulated points, n.
        polygons: Sheet faces over 0..n-1, -1 in the last column of a triangle, shape (p, 4).
        polygon_regions: Their regions.
        triangles: Of sheet and followers, shape (t, 3).
        triangle_faces: Cage face of each triangle, shape (t,).
        mirror: Mirror image of each point, shape (s,).
        fixed: The sheet's outer ring, shape (n,).
        jaw_weight: Share of the jaw's rotation, shape (s,).
        depth: Skin-to-bone depth [mm], shape (n,).
        anchor_weight: Strength of the hold on the skull, shape (n,).
        follow: Followers from the sheet, sparse (s - n, n).
        follow_jaw: Followers' share of the rigid jaw's displacement, shape (s - n,).
    """

    cage_points: IntArray
    sheet_count: int
    polygons: IntArray
    polygon_regions: tuple[str, ...]
    triangles: IntArray
    triangle_faces: IntArray
    mirror: IntArray
    fixed: BoolArray
    jaw_weight: FloatArray
    depth: FloatArray
    anchor_weight: FloatArray
    follow: sp.csr_array
    follow_jaw: FloatArray


def face_sheet(cage: Cage) -> BoolArray:
    """Return which faces carry tissue, shape (f,): the face, a ring of scalp, three of neck."""
    regions = np.array(cage.regions)
    of_face = ~np.isin(regions, (*HIDDEN, *BEYOND, EAR))
    face_points = np.zeros(len(cage.points), dtype=bool)
    face_points[corners_of(cage.faces[of_face])] = True
    grown = face_points
    for beyond in (BEYOND, *[("neck",)] * NECK_RINGS):
        touching = np.isin(regions, beyond) & _any_corner(cage.faces, grown)
        grown = grown.copy()
        grown[corners_of(cage.faces[touching])] = True
    enclosed = ~_any_corner(cage.faces, ~grown)
    return np.asarray(enclosed & ~np.isin(regions, (*HIDDEN, EAR)))


def tissue_surface(cage: Cage, points: FloatArray, sheet_faces: BoolArray) -> TissueSurface:
    """Return the tissue surface over the cage's chosen faces.

    Args:
        cage: The cage.
        points: Its faired points [mm], shape (v, 3).
        sheet_faces: Faces that carry tissue, shape (f,).
    """
    sheet_points = np.unique(corners_of(cage.faces[sheet_faces]))
    follower_points = _follower_points(cage)
    chosen = np.concatenate([sheet_points, follower_points])
    place = np.full(len(cage.points), -1)
    place[chosen] = np.arange(len(chosen))
    count = len(sheet_points)

    polygons = _renumbered(cage.faces[sheet_faces], place)
    topology = Topology.of(polygons, count)
    names = [cage.names[index] for index in sheet_points]
    jaw = np.array([jaw_share(cage.names[index]) for index in chosen])
    jaw[:count] = _smoothed_jaw(jaw[:count], names, topology)
    follow, follow_jaw = _following(cage, place, follower_points, count)
    fixed = np.zeros(count, dtype=bool)
    fixed[boundary_loops(topology)[0]] = True

    hidden = np.isin(np.array(cage.regions), HIDDEN)
    surface_faces = (sheet_faces | hidden) & ~_any_corner(cage.faces, place < 0)
    return TissueSurface(
        cage_points=chosen,
        sheet_count=count,
        polygons=polygons,
        polygon_regions=tuple(np.array(cage.regions)[sheet_faces].tolist()),
        triangles=symmetric_triangles(
            _renumbered(cage.faces[surface_faces], place),
            points[chosen],
            place[cage.mirror[chosen]],
        ),
        triangle_faces=np.repeat(
            np.flatnonzero(surface_faces), (cage.faces[surface_faces] >= 0).sum(axis=1) - 2
        ),
        mirror=place[cage.mirror[chosen]],
        fixed=fixed,
        jaw_weight=jaw,
        depth=tissue_depth(points[sheet_points]),
        anchor_weight=anchor_weight(points[sheet_points], names),
        follow=follow,
        follow_jaw=follow_jaw,
    )


def corners_of(faces: IntArray) -> IntArray:
    """Return all corners of padded faces in a row, without the padding."""
    return faces[faces >= 0]


def symmetric_triangles(faces: IntArray, points: FloatArray, mirror: IntArray) -> IntArray:
    """Return triangles (t, 3) of padded faces whose second half mirrors the first.

    Only the left half is split; the right half takes the mirror images.
    """
    left = triangulated(faces[: len(faces) // 2], points)
    return np.vstack([left, mirrored_faces(left, mirror)])


def triangulated(faces: IntArray, points: FloatArray) -> IntArray:
    """Return the triangles (t, 3) of padded faces (f, 4), quads split along their shorter diagonal.

    Triangles come in the order of their faces.
    """
    is_quad = faces[:, 3] >= 0
    a, b, c, d = faces.T
    first = np.linalg.norm(points[a] - points[c], axis=1)
    second = np.linalg.norm(points[b] - points[d], axis=1)
    along_first = ~is_quad | (first <= second * (1 + 1e-6))
    opening = np.where(along_first[:, None], np.c_[a, b, c], np.c_[a, b, d])
    closing = np.where(along_first[:, None], np.c_[a, c, d], np.c_[b, c, d])
    pairs = np.stack([opening, closing], axis=1).reshape(-1, 3)
    return pairs[np.column_stack([np.ones_like(is_quad), is_quad]).ravel()]


def _any_corner(faces: IntArray, marked: BoolArray) -> BoolArray:
    return np.asarray((marked[faces] & (faces >= 0)).any(axis=1))


def _renumbered(faces: IntArray, place: IntArray) -> IntArray:
    return np.where(faces >= 0, place[faces], -1)


def _follower_points(cage: Cage) -> IntArray:
    rows = [follower.row for follower in FOLLOWERS]
    return np.array([i for i, name in enumerate(cage.names) if name.split("_")[0] in rows])


def _following(
    cage: Cage, place: IntArray, followers: IntArray, count: int
) -> tuple[sp.csr_array, FloatArray]:
    rule_of_row = {follower.row: follower for follower in FOLLOWERS}
    matrix = sp.lil_array((len(followers), count))
    jaw = np.zeros(len(followers))
    for index, point in enumerate(followers):
        row, _, spoke = cage.names[point].partition("_")
        rule = rule_of_row[row]
        leader = cage.left[f"{rule.leader}_{spoke}"]
        if cage.left[cage.names[point]] != point:
            leader = int(cage.mirror[leader])
        if rule.share:
            matrix[index, place[leader]] = rule.share
        # A rigid jaw moves only what hangs on it: the upper half of the sock stays.
        jaw[index] = rule.jaw * jaw_share(cage.names[point])
    return sp.csr_array(matrix), jaw


def _smoothed_jaw(jaw: FloatArray, names: list[str], topology: Topology) -> FloatArray:
    of_lips = np.array([name.split("_")[0] in LIP_ROWS for name in names])
    neighbours = topology.neighbours() @ jaw
    smooth = jaw + SMOOTHED_SHARE * (neighbours - jaw)
    return np.where(of_lips, jaw, smooth)
