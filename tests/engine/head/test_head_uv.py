"""The map of the skin: no flips, islands apart, both halves alike, the face the largest."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.head import Head
from engine.head import layout as layout_module
from engine.head.layout import layout_file, layout_key, shipped, unwrapped
from engine.head.shipping import write_layout
from engine.head.standard import Sculpture
from engine.head.textures.texels import Texels
from engine.head.uv import ISLANDS, Pieces, Unwrap, unwrap

FACE_SHARE = 0.45
SIZE = 512


@pytest.fixture(scope="module")
def laid_out(sculpture: Sculpture) -> Unwrap:
    return unwrap(sculpture.cage, sculpture.limit, sculpture.points)


@pytest.fixture(scope="module")
def pieces(sculpture: Sculpture) -> Pieces:
    return Pieces.of(sculpture.cage, sculpture.limit, sculpture.points)


def signed_areas(head: Head) -> np.ndarray:
    a, b, c = (head.drawn.uvs[head.drawn.triangles[:, corner]] for corner in range(3))
    u, v = b - a, c - a
    return (u[:, 1] * v[:, 0] - u[:, 0] * v[:, 1]) / 2


def test_no_quad_is_flipped(sculpture: Sculpture, laid_out: Unwrap) -> None:
    fine = sculpture.limit.levels[2]
    quads = fine.topology.faces
    places = laid_out.at(quads, laid_out.charts(quads, fine.parents))
    for turn in range(4):
        a, b, c = (places[:, (corner + turn) % 4] for corner in range(3))
        u, v = b - a, c - a
        assert (u[:, 1] * v[:, 0] - u[:, 0] * v[:, 1]).min() > 0


@pytest.mark.parametrize("level", ["medium", "high"])
def test_no_drawn_triangle_is_flipped(heads: dict[str, Head], level: str) -> None:
    # Where levels meet, three corners may lie on one line.
    assert signed_areas(heads[level]).min() > -1e-12


def test_islands_do_not_overlap(head: Head) -> None:
    drawn = head.drawn
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, SIZE)
    assert len(texels.rows) == pytest.approx(signed_areas(head).sum() * SIZE**2, rel=0.01)
    assert drawn.uvs.min() > 0
    assert drawn.uvs.max() < 1


def test_face_has_most_of_the_map(sculpture: Sculpture, laid_out: Unwrap) -> None:
    fine = sculpture.limit.levels[2]
    quads = fine.topology.faces
    places = laid_out.at(quads, laid_out.charts(quads, fine.parents))
    diagonals = places[:, 2] - places[:, 0], places[:, 3] - places[:, 1]
    area = np.abs(diagonals[0][:, 0] * diagonals[1][:, 1] - diagonals[0][:, 1] * diagonals[1][:, 0])
    face = laid_out.islands[fine.parents] == [i.name for i in ISLANDS].index("face")
    assert area[face].sum() / 2 > FACE_SHARE


def test_halves_mirror_each_other(sculpture: Sculpture, laid_out: Unwrap) -> None:
    fine = sculpture.limit.levels[2]
    quads = fine.topology.faces
    of_face = laid_out.islands[fine.parents] == 0
    chosen = quads[of_face]
    charts = laid_out.charts(chosen, fine.parents[of_face])
    here, there = laid_out.at(chosen, charts), laid_out.at(fine.mirror[chosen], charts)
    middle = (here[..., 0] + there[..., 0]) / 2
    np.testing.assert_allclose(middle, middle.mean(), atol=1e-9)
    np.testing.assert_allclose(here[..., 1], there[..., 1], atol=1e-9)


def test_doubles_lie_on_their_firsts(head: Head) -> None:
    drawn = head.drawn
    doubled = np.flatnonzero(drawn.seams != np.arange(len(drawn.seams)))
    assert 0 < len(doubled) < 0.06 * len(drawn.seams)
    firsts = drawn.seams[doubled]
    np.testing.assert_array_equal(drawn.vertices[doubled], drawn.vertices[firsts])
    np.testing.assert_array_equal(drawn.normals[doubled], drawn.normals[firsts])
    assert np.abs(drawn.map[doubled] - drawn.map[firsts]).max() == 0


def test_face_is_laid_out_evenly(head: Head) -> None:
    drawn = head.drawn
    texels = Texels.of(drawn.uvs, drawn.triangles, drawn.vertices, SIZE)
    front = (texels.carried(drawn.reference)[:, 2] > 60) & (texels.rows < 0.74 * SIZE)
    low, high = np.percentile(texels.width[front], [2, 98])
    assert high / low < 2.2


def test_what_ships_is_what_the_code_makes(sculpture: Sculpture, laid_out: Unwrap) -> None:
    """If not: `python -m engine.head.shipping`."""
    made = unwrapped(sculpture.cage, sculpture.limit, sculpture.points)
    np.testing.assert_array_equal(made.keys, laid_out.keys)
    np.testing.assert_allclose(made.uvs, laid_out.uvs, atol=1e-5)  # a fiftieth of a texel


def test_what_ships_fits_and_is_small(pieces: Pieces) -> None:
    assert shipped(pieces) is not None
    assert layout_file().stat().st_size < 50_000


def test_what_ships_is_for_one_skin_whatever_its_rounding(pieces: Pieces) -> None:
    noise = np.random.default_rng(1).normal(0, 1e-10, pieces.vertices.shape)
    assert layout_key(replace(pieces, vertices=pieces.vertices + noise)) == layout_key(pieces)
    moved = pieces.vertices.copy()
    moved[700, 1] += 0.01
    assert shipped(replace(pieces, vertices=moved)) is None


def test_another_skin_is_laid_out_anew(
    sculpture: Sculpture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[Pieces] = []

    def scattered(pieces: Pieces) -> np.ndarray:
        calls.append(pieces)
        count = sum(len(used) for _, used, _ in pieces.authored())
        return np.random.default_rng(0).uniform(size=(count, 2))

    monkeypatch.setenv("RISORIUS_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(layout_module, "flattened_islands", scattered)
    points = sculpture.points * 1.001
    for _ in range(2):  # The second time they are kept.
        unwrapped(sculpture.cage, sculpture.limit, points)
    assert len(calls) == 1


def test_what_is_written_is_read_again(
    pieces: Pieces, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = shipped(pieces)
    path = tmp_path / "islands.npz"
    monkeypatch.setattr("engine.head.shipping.flattened_islands", lambda pieces: before)
    write_layout(pieces, path)
    monkeypatch.setattr(layout_module, "layout_file", lambda: path)
    np.testing.assert_array_equal(shipped(pieces), before)
