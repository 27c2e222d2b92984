"""The map from tissue to drawn skin: as good as exact subdivision, and small."""

from __future__ import annotations

import numpy as np
import pytest
from displaced import lowered_jaw, smile

from engine.arrays import FloatArray
from engine.head import LEVELS, Head
from engine.head.skin import skin_mesh, textured
from engine.head.standard import Sculpture
from engine.head.surface_map import LOST_WEIGHT, exact_map, pruned, surface_map
from engine.head.tissue_surface import face_sheet, tissue_surface
from engine.head.uv import unwrap

SMILE_ERROR = 0.02
JAW_ERROR = 0.04


@pytest.fixture(scope="module", params=["medium", "high"])
def exact(request: pytest.FixtureRequest, sculpture: Sculpture) -> tuple[str, FloatArray]:
    cage, points = sculpture.cage, sculpture.points
    mesh = skin_mesh(cage, sculpture.limit, points, LEVELS[request.param])
    tissue = tissue_surface(cage, points, face_sheet(cage))
    whole = exact_map(sculpture.limit, mesh.level, mesh.indices, tissue.cage_points)
    seams = textured(mesh, unwrap(cage, sculpture.limit, points)).seams
    return request.param, whole[seams]


def test_smile_and_jaw(heads: dict[str, Head], exact: tuple[str, FloatArray]) -> None:
    level, whole = exact
    head = heads[level]
    moved = smile(head.points)
    assert 6 < np.linalg.norm(moved, axis=1).max() < 12
    assert np.abs(head.drawn.map @ moved - whole @ moved).max() < SMILE_ERROR
    jaw = lowered_jaw(head, 15.0)
    assert np.abs(head.drawn.map @ jaw - whole @ jaw).max() < JAW_ERROR


def test_common_translation_is_kept(heads: dict[str, Head], exact: tuple[str, FloatArray]) -> None:
    level, whole = exact
    carried = heads[level].drawn.map
    kept = np.diff(carried.indptr) > 0
    np.testing.assert_allclose(carried.sum(axis=1)[kept], whole.sum(axis=1)[kept], atol=1e-12)
    assert np.abs(whole[~kept]).sum(axis=1).max() <= LOST_WEIGHT  # far behind the tissue


def test_half_the_rows_are_pruned_and_the_others_are_their_images(sculpture: Sculpture) -> None:
    cage, limit = sculpture.cage, sculpture.limit
    tissue = tissue_surface(cage, sculpture.points, face_sheet(cage))
    rows = np.arange(len(limit.levels[1].mirror))
    made = surface_map(limit, 1, rows, tissue.cage_points).toarray()
    whole = pruned(exact_map(limit, 1, rows, tissue.cage_points)).toarray()
    mirror = limit.levels[1].mirror
    firsts = rows < mirror
    np.testing.assert_allclose(made[firsts], whole[firsts], atol=1e-12)
    np.testing.assert_array_equal(made[mirror], made[:, tissue.mirror])


def test_rows_are_short(head: Head) -> None:
    sizes = np.diff(head.drawn.map.indptr)
    assert sizes.mean() < 40
    assert sizes.max() <= 128


@pytest.mark.parametrize("level", LEVELS)
def test_cage_points_move_with_their_tissue(heads: dict[str, Head], level: str) -> None:
    head = heads[level]
    moved = smile(head.points)
    drawn = head.drawn.map @ moved
    for name, point in (("ch.L", "M1_5.L"), ("prn", "b7_0"), ("al.R", "A7.R")):
        np.testing.assert_allclose(drawn[head.landmarks[name]], moved[head.point(point)], atol=1e-9)


def test_symmetric_displacement_moves_the_skin_symmetrically(head: Head) -> None:
    vertices = head.drawn.vertices
    moved = head.drawn.deform(smile(head.points), head.eyes)
    order = np.lexsort(np.round(vertices, 9).T)
    mirrored = np.lexsort(np.round(vertices * [-1, 1, 1], 9).T)
    np.testing.assert_allclose(moved[order], moved[mirrored] * [-1, 1, 1], atol=1e-9)


def test_scalp_and_neck_stay(head: Head) -> None:
    moved = head.drawn.map @ np.full_like(head.points, 5.0)
    still = (head.drawn.vertices[:, 2] < -60) | (head.drawn.vertices[:, 1] < -170)
    assert still.sum() > 200
    assert np.abs(moved[still]).max() < 0.25


def test_paper_is_drawn_as_it_is_simulated(heads: dict[str, Head]) -> None:
    paper = heads["paper"]
    moved = smile(paper.points)
    np.testing.assert_array_equal(paper.drawn.map @ moved, moved)
    np.testing.assert_array_equal(paper.drawn.vertices, paper.points)
    np.testing.assert_array_equal(paper.drawn.triangles, paper.triangles)


def test_pruning_keeps_small_maps_whole() -> None:
    exact = np.array([[0.5, 0.5, 0.0], [1.2, -0.1, -0.1], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(pruned(exact).toarray(), exact, atol=1e-15)


def test_pruning_drops_the_tail_and_keeps_the_sum() -> None:
    tail = np.full(10, 0.0004)
    exact = np.concatenate([[0.7, 0.296], tail])[None]
    short = pruned(exact).toarray()[0]
    assert np.count_nonzero(short) == 2
    assert short.sum() == pytest.approx(exact.sum())
    assert short[0] / short[1] == pytest.approx(0.7 / 0.296)
