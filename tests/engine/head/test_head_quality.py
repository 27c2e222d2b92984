"""The skin's triangles at every level: no slivers in the face, no folds but the authored ones."""

from __future__ import annotations

import numpy as np
import pytest

from engine.head.geometry import smallest_angles
from engine.head.skin import LEVELS, SkinMesh, skin_mesh
from engine.head.standard import Sculpture
from engine.head.topology import Topology

# Where skin turns over on purpose: the lids' edges, and the lips where they touch and go inwards.
FOLDED = (
    {"upper_lid_inner", "upper_lid_margin", "upper_eyelid"},
    {"lower_lid_inner", "lower_lid_margin", "lower_eyelid"},
    {"upper_lip", "lower_lip", "upper_lip_inner", "lower_lip_inner", "mouth_inner"},
    {"ear"},
)


@pytest.fixture(scope="module")
def meshes(sculpture: Sculpture) -> dict[str, SkinMesh]:
    return {
        name: skin_mesh(sculpture.cage, sculpture.limit, sculpture.points, level)
        for name, level in LEVELS.items()
    }


@pytest.mark.parametrize("level", LEVELS)
def test_no_slivers(meshes: dict[str, SkinMesh], level: str) -> None:
    mesh = meshes[level]
    angles = np.degrees(smallest_angles(mesh.vertices[mesh.triangles]))
    assert angles.min() > 4
    assert np.percentile(angles, 1) > 10


@pytest.mark.parametrize("level", LEVELS)
def test_only_authored_folds(sculpture: Sculpture, meshes: dict[str, SkinMesh], level: str) -> None:
    mesh = meshes[level]
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    topology = Topology.of(mesh.triangles, len(mesh.vertices))
    edges = topology.face_edges[:, :3].ravel()
    order = np.argsort(edges, kind="stable")
    triangle = order // 3
    paired = np.flatnonzero(edges[order][1:] == edges[order][:-1])
    first, second = triangle[paired], triangle[paired + 1]
    folded = (normals[first] * normals[second]).sum(axis=1) < np.cos(np.radians(120))
    regions = np.array(sculpture.cage.regions)[mesh.cage_faces]
    beside = zip(regions[first[folded]], regions[second[folded]], strict=True)
    found = {frozenset((str(one), str(other))) for one, other in beside}
    assert all(any(pair <= place for place in FOLDED) for pair in found), found


def test_levels_nest(sculpture: Sculpture, meshes: dict[str, SkinMesh]) -> None:
    """A coarser level's vertices are the first of the finer one's, but for rounding."""
    np.testing.assert_array_equal(meshes["low"].vertices, sculpture.points)
    medium, high = meshes["medium"], meshes["high"]
    shared, of_medium, of_high = np.intersect1d(medium.indices, high.indices, return_indices=True)
    assert len(shared) == len(medium.indices)
    np.testing.assert_allclose(medium.vertices[of_medium], high.vertices[of_high], atol=1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_exactly_symmetric(meshes: dict[str, SkinMesh], level: str) -> None:
    vertices = meshes[level].vertices
    reflected = vertices * [-1, 1, 1]
    np.testing.assert_array_equal(
        vertices[np.lexsort(vertices.T)], reflected[np.lexsort(reflected.T)]
    )
