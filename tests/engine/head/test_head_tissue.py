"""The tissue surface: the sheet, its fixed ring, its fields and its followers."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import UnknownName
from engine.head import Head
from engine.head.anatomy import jaw_share, smoothstep
from engine.head.topology import Topology, boundary_loops

BOTH = ("high", "paper")


def rows(head: Head) -> np.ndarray:
    """Return the cage row of each point ("M0" for "M0_5.L")."""
    return np.array([name.split("_")[0].split(".")[0] for name in head.names])


def test_standard_sheet(head: Head) -> None:
    assert head.sheet_count == 786
    assert (head.polygons[:, 3] >= 0).sum() == 698
    assert (head.polygons[:, 3] < 0).sum() == 38
    assert head.points.shape == (910, 3)
    assert len(head.polygon_regions) == len(head.polygons)


def test_tissue_is_the_same_at_every_level(heads: dict[str, Head]) -> None:
    for level in ("low", "medium"):
        np.testing.assert_array_equal(heads[level].points, heads["high"].points)
        np.testing.assert_array_equal(heads[level].polygons, heads["high"].polygons)


def test_paper_sheet_has_the_papers_size(heads: dict[str, Head]) -> None:
    paper = heads["paper"]
    assert 1_200 <= len(paper.polygons) <= 1_350
    assert (paper.polygons[:, 3] == -1).all()
    assert len(paper.polygon_regions) == len(paper.polygons)


@pytest.mark.parametrize("which", BOTH)
def test_exactly_symmetric(heads: dict[str, Head], which: str) -> None:
    head = heads[which]
    mirror = head.mirror
    np.testing.assert_array_equal(mirror[mirror], np.arange(len(mirror)))
    np.testing.assert_array_equal(head.points[mirror], head.points * [-1, 1, 1])
    assert (head.points[mirror == np.arange(len(mirror)), 0] == 0).all()
    count = head.sheet_count
    assert (mirror[:count] < count).all()
    np.testing.assert_array_equal(head.fixed[mirror[:count]], head.fixed)
    np.testing.assert_allclose(head.jaw_weight[mirror], head.jaw_weight, atol=1e-12)
    np.testing.assert_array_equal(head.depth[mirror[:count]], head.depth)
    np.testing.assert_array_equal(head.anchor_weight[mirror[:count]], head.anchor_weight)


@pytest.mark.parametrize("which", BOTH)
def test_polygons_and_triangles_mirror(heads: dict[str, Head], which: str) -> None:
    head = heads[which]
    for table in (head.polygons, head.triangles):
        faces = {frozenset(int(i) for i in face if i >= 0) for face in table}
        images = {frozenset(int(head.mirror[i]) for i in face if i >= 0) for face in table}
        assert faces == images


@pytest.mark.parametrize("which", BOTH)
def test_only_the_outer_ring_is_fixed(heads: dict[str, Head], which: str) -> None:
    head = heads[which]
    loops = boundary_loops(Topology.of(head.polygons, head.sheet_count))
    assert len(loops) == 6  # outer ring, lips, two lids, two nostrils
    np.testing.assert_array_equal(np.flatnonzero(head.fixed), loops[0])
    assert not set(rows(head)[: head.sheet_count][head.fixed]) & {"E0", "E1", "M0", "S1", "H1"}


def test_triangles_cover_sheet_and_followers(head: Head) -> None:
    quads = int((head.polygons[:, 3] >= 0).sum())
    inside = (head.triangles < head.sheet_count).all(axis=1)
    assert inside.sum() == quads + len(head.polygons)
    assert np.unique(head.triangles).size == len(head.points)


def test_followers_follow(head: Head) -> None:
    count = head.sheet_count
    sheet = np.random.default_rng(0).normal(size=(count, 3))
    followed = head.follow @ sheet

    for share, follower, leader in (
        (1.0, "EB_3.R", "E0_3.R"),
        (0.6, "S2_7.L", "M0_7.L"),
        (1.0, "H2_1.L", "H1_1.L"),
        (0.7, "H3_5.R", "H1_5.R"),
        (0.6, "S2_0", "M0_0"),
    ):
        expected = share * sheet[head.point(leader)]
        np.testing.assert_allclose(followed[head.point(follower) - count], expected)
    assert set(rows(head)[count:]) == {"EB", "S2", "S3", "S4", "H2", "H3"}


def test_only_the_lower_sock_rides_the_jaw(head: Head) -> None:
    jaw = {name: head.follow_jaw[i] for i, name in enumerate(head.names[head.sheet_count :])}
    assert jaw["S4_10"] == 1.0
    assert jaw["S2_10"] == pytest.approx(0.4)
    assert jaw["S4_0"] == 0.0
    assert all(value == 0 for name, value in jaw.items() if name[0] in "EH")


def test_jaw_weight(head: Head) -> None:
    weight = {name: head.jaw_weight[head.point(name)] for name in ("M0_0", "M0_10", "b7_0")}
    assert weight == {"M0_0": 0.0, "M0_10": 1.0, "b7_0": 0.0}
    corner = head.jaw_weight[head.point("M1_5.L")]
    assert corner == pytest.approx(0.48)
    assert head.jaw_weight.min() >= 0
    assert head.jaw_weight.max() <= 1
    assert head.jaw_weight[head.points[:, 1] > 0].max() == 0


def test_every_row_of_the_cage_has_a_jaw_share() -> None:
    assert jaw_share("C8_10") == 0.1
    assert jaw_share("W15_3") == 0.4
    assert jaw_share("Q0_9") == 0.0
    assert jaw_share("A6") == 0.0
    assert jaw_share("G1_3") == 0.0


def test_depth_and_anchors_by_region(head: Head) -> None:
    regions = np.array(head.polygon_regions)

    def mean(field: np.ndarray, region: str) -> float:
        corners = head.polygons[regions == region]
        return float(field[corners[corners >= 0]].mean())

    assert mean(head.depth, "cheek") > mean(head.depth, "forehead") + 2
    assert mean(head.depth, "upper_eyelid") < 5
    assert mean(head.anchor_weight, "upper_lip") < 0.2 < mean(head.anchor_weight, "nose")
    assert (head.depth >= 3).all()
    assert (head.depth <= 14).all()
    assert head.anchor_weight[head.point("E2_4.L")] == 3.0
    assert head.anchor_weight[head.point("S1_0")] == 1.0


def test_point_names_the_nearest_when_unknown(head: Head) -> None:
    assert head.names[head.point("M1_5.L")] == "M1_5.L"
    with pytest.raises(UnknownName, match="no point named 'M1_5'") as caught:
        head.point("M1_5")
    assert "M1_5.L" in caught.value.nearest


def test_smoothstep_goes_both_ways() -> None:
    value = np.array([0.0, 1.0, 1.5, 2.0, 3.0])
    np.testing.assert_allclose(smoothstep(1, 2, value), [0, 0, 0.5, 1, 1])
    np.testing.assert_allclose(smoothstep(2, 1, value), [1, 1, 0.5, 0, 0])
