"""The finer cage: smaller cells where creases form, the face as it was."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.arrays import FloatArray, IntArray
from engine.head.cage import Cage
from engine.head.finer import LADDERS
from engine.head.geometry import smallest_angles, vertex_normals
from engine.head.standard import Sculpture, sculpt

TALLEST = {"forehead": 11.5, "glabella": 6.5}
"""Greatest height of a cell, mm; it was 19 and 11."""


@pytest.fixture(scope="module")
def coarse() -> Sculpture:
    return sculpt(fine=False)


@pytest.fixture(scope="module")
def fine() -> Sculpture:
    return sculpt()


def test_old_points_stay_where_they_are(coarse: Sculpture, fine: Sculpture) -> None:
    for name, index in coarse.cage.left.items():
        np.testing.assert_array_equal(fine.points[fine.cage.left[name]], coarse.points[index])
    added = sum(len(ladder.first) for ladder in LADDERS)
    assert len(fine.cage.left) == len(coarse.cage.left) + added


@pytest.mark.parametrize("region", TALLEST)
def test_cells_are_low_where_level_furrows_form(fine: Sculpture, region: str) -> None:
    heights = cell_heights(fine.cage, fine.points, region)
    assert heights.max() < TALLEST[region]


def test_cells_are_narrow_beside_the_eye(coarse: Sculpture, fine: Sculpture) -> None:
    def width(of: Sculpture, *names: str) -> float:
        ends = of.points[[of.cage.left[name] for name in names]]
        return float(np.linalg.norm(np.diff(ends, axis=0), axis=1).max())

    assert width(coarse, "E4_8", "W6_1") > 15.0
    assert width(fine, "E4_8", "X4_2", "W6_1") < 11.0


def test_no_new_face_is_a_sliver(fine: Sculpture) -> None:
    cage = fine.cage
    assert cage.fine is not None
    corners = cage.faces[cage.fine]
    triangles = corners[corners[:, 3] < 0][:, :3]
    assert np.degrees(smallest_angles(fine.points[triangles])).min() > 15.0


def test_the_face_keeps_its_form(coarse: Sculpture, fine: Sculpture) -> None:
    topology = fine.limit.levels[2].topology.faces
    triangles = np.vstack([topology[:, :3], topology[:, [0, 2, 3]]])
    away = distance_to(fine.finest, triangles, coarse.finest)
    assert away.max() < 0.5
    assert np.sqrt((away**2).mean()) < 0.05


def cell_heights(cage: Cage, points: FloatArray, region: str) -> FloatArray:
    faces = cage.faces[np.array(cage.regions) == region]
    steps = points[np.roll(faces[faces[:, 3] >= 0], -1, axis=1)] - points[faces[faces[:, 3] >= 0]]
    return np.abs(steps[:, :, 1]).max(axis=1)


def distance_to(vertices: FloatArray, triangles: IntArray, points: FloatArray) -> FloatArray:
    """Return the distance of points to the planes at the nearest vertices, the least of four."""
    normals = vertex_normals(vertices, triangles)
    nearest = np.asarray(cKDTree(vertices).query(points, k=4)[1])
    across = np.einsum("ikc,ikc->ik", points[:, None] - vertices[nearest], normals[nearest])
    return np.asarray(np.abs(across).min(axis=1))
