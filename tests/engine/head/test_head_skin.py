"""The drawn skin at every level: closed but for three holes, symmetric, no slivers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.errors import UnknownName
from engine.head import Head, standard_head
from engine.head.geometry import smallest_angles, triangle_areas
from engine.head.hairline import AT_ONCE, HIDDEN_SCALP, distance_inside, inside_outline
from engine.head.topology import Topology, boundary_loops, components

ALL = ("low", "medium", "high", "paper")

# Triangles; least edge and area (mm, mm^2), least angle and that of the worst hundredth (degrees).
# The narrow ones sit in the nostril's front, the corners of lips and lids, and round the ear.
FIGURES = {
    "low": (3_660, 0.8, 0.05, 4.0, 10.0),
    "medium": (7_164, 0.2, 0.02, 4.0, 10.0),
    "high": (28_416, 0.1, 0.005, 4.0, 10.0),
    "paper": (1_568, 0.8, 1.0, 4.0, 7.0),
}


@pytest.mark.parametrize("level", ALL)
def test_manifold_with_three_holes(heads: dict[str, Head], level: str) -> None:
    drawn = heads[level].drawn
    seams = np.arange(len(drawn.vertices)) if drawn.seams is None else drawn.seams
    topology = Topology.of(seams[drawn.triangles], len(drawn.vertices))
    assert topology.face_count_of_edge.max() == 2
    assert len(boundary_loops(topology)) == 3  # both lid backs, and the cut of neck or mask
    euler = len(np.unique(seams)) - len(topology.edges) + len(drawn.triangles)
    assert euler == -1
    assert components(topology)[np.unique(seams)].max() == 0


@pytest.mark.parametrize("level", ALL)
def test_triangles_are_wound_alike(heads: dict[str, Head], level: str) -> None:
    triangles = heads[level].drawn.triangles
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    assert len(np.unique(sides, axis=0)) == len(sides)


@pytest.mark.parametrize("level", ALL)
def test_triangle_quality(heads: dict[str, Head], level: str) -> None:
    count, least_edge, least_area, least_angle, worst_hundredth = FIGURES[level]
    drawn = heads[level].drawn
    assert len(drawn.triangles) == count
    edges = Topology.of(drawn.triangles, len(drawn.vertices)).edges
    lengths = np.linalg.norm(np.diff(drawn.vertices[edges], axis=1)[:, 0], axis=1)
    assert lengths.min() > least_edge
    assert triangle_areas(drawn.vertices, drawn.triangles).min() > least_area
    angles = np.degrees(smallest_angles(drawn.vertices[drawn.triangles]))
    assert angles.min() > least_angle
    assert np.percentile(angles, 1) > worst_hundredth
    assert np.median(angles) > 33


@pytest.mark.parametrize("level", ALL)
def test_symmetric(heads: dict[str, Head], level: str) -> None:
    vertices = heads[level].drawn.vertices
    here = vertices[np.lexsort(vertices.T)]
    reflected = vertices * [-1, 1, 1]
    there = reflected[np.lexsort(reflected.T)]
    np.testing.assert_array_equal(here, there)


@pytest.mark.parametrize("level", ALL)
def test_normals_and_colors(heads: dict[str, Head], level: str) -> None:
    drawn = heads[level].drawn
    np.testing.assert_allclose(np.linalg.norm(drawn.normals, axis=1), 1, atol=1e-12)
    assert drawn.colors.min() >= 0
    assert drawn.colors.max() <= 1
    assert drawn.hair.min() >= 0
    assert drawn.hair.max() == pytest.approx(HIDDEN_SCALP)
    nose = heads[level].landmarks["prn"]
    assert drawn.normals[nose, 2] > 0.8


@pytest.mark.parametrize("level", ALL)
def test_regions_are_where_their_names_say(heads: dict[str, Head], level: str) -> None:
    drawn = heads[level].drawn
    place = {
        name: drawn.vertices[drawn.regions == index].mean(axis=0)
        for index, name in enumerate(drawn.region_names)
        if (drawn.regions == index).any()
    }
    assert place["forehead"][1] > place["nose"][1] > place["upper_lip"][1]
    assert place["upper_lip"][1] > place["lower_lip"][1] > place["chin"][1]
    assert place["nose_tip"][2] > place["cheek"][2]


def test_lips_are_redder_than_the_forehead(head: Head) -> None:
    drawn = head.drawn
    names = np.array(drawn.region_names)[drawn.regions]
    red = drawn.colors[:, 0] / drawn.colors[:, 1]
    assert red[names == "upper_lip"].mean() > 1.3 * red[names == "forehead"].mean()


def test_hair_grows_on_the_scalp_only(head: Head) -> None:
    drawn = head.drawn
    names = np.array(drawn.region_names)[drawn.regions]
    # The scalp reaches below the hairline at ear and nape: 0.72 to 0.75 of it, by level.
    assert drawn.hair[names == "scalp"].mean() > 0.71
    assert drawn.hair[np.isin(names, ["cheek", "nose", "chin", "brow"])].max() < 0.05


def test_inside_outline() -> None:
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    notched = np.insert(square, 2, [[2.0, 2.0]], axis=0)  # the side x = 4 caves in
    points = np.array([[1.0, 1.0], [3.5, 2.0], [5.0, 1.0], [-1.0, 2.0]])
    np.testing.assert_array_equal(inside_outline(points, square), [True, True, False, False])
    np.testing.assert_array_equal(inside_outline(points, notched), [True, False, False, False])
    np.testing.assert_allclose(distance_inside(points, square), [1, 0.5, -1, -1])


def test_distance_of_many_points_is_that_of_each() -> None:
    random = np.random.default_rng(3)
    outline = np.array([[0, 0], [3, 0.5], [2, 2.0], [1, 1.2], [0.2, 3]])
    points = random.uniform(-1, 4, (2 * AT_ONCE + 17, 2))
    along = np.linspace(0, 1, 2000)[:, None]
    border = np.concatenate(
        [a + along * (b - a) for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)]
    )
    to_border = cKDTree(border).query(points)[0]
    found = distance_inside(points, outline)
    np.testing.assert_allclose(np.abs(found), to_border, atol=2e-3)
    np.testing.assert_array_equal(found > 0, inside_outline(points, outline))


def test_unknown_level_names_the_known_ones() -> None:
    with pytest.raises(UnknownName, match="there is no level of detail named 'hihg'") as caught:
        standard_head("hihg")
    assert caught.value.known == ["high", "low", "medium"]
