"""Shapes of which each vertex has those only that it needs."""

from __future__ import annotations

import numpy as np
import pytest

from engine.gltf.basis import fit_basis
from engine.gltf.spared import spared

RANDOM = np.random.default_rng(8)
WEIGHTS = RANDOM.normal(0, 1, (40, 6))
REACH = np.geomspace(5.0, 0.005, 50)
"""How far each of fifty vertices is moved."""
SHAPES = (RANDOM.normal(0, 1, (6, 50, 3)) * REACH[:, None]).reshape(6, -1)
FRAMES = (WEIGHTS @ SHAPES).reshape(40, 50, 3).astype(np.float32)


def errors(shapes: np.ndarray) -> np.ndarray:
    """The largest error of each vertex."""
    off = (WEIGHTS @ shapes).reshape(FRAMES.shape) - FRAMES
    return np.asarray(np.linalg.norm(off, axis=2).max(axis=0))


def kept(shapes: np.ndarray) -> np.ndarray:
    """How many shapes move each vertex."""
    return np.asarray(shapes.reshape(6, 50, 3).any(axis=2).sum(axis=0))


def test_no_vertex_is_farther_off_than_allowed() -> None:
    fewer = spared(FRAMES, SHAPES, WEIGHTS, 0.1)
    assert errors(fewer).max() <= 0.1 + 1e-6
    assert set(np.unique(kept(fewer))) >= {0, 6}
    stays = kept(fewer)[:, None] > 0
    assert ((fewer == SHAPES) | (fewer == 0.0)).all()
    assert stays[0].all()
    assert not stays[-1].any()


def test_each_vertex_may_have_a_bound_of_its_own() -> None:
    bounds = np.where(np.arange(50) % 2, 1e-9, 6.0 * REACH)
    fewer = spared(FRAMES, SHAPES, WEIGHTS, bounds)
    assert (errors(fewer)[::2] <= bounds[::2] + 1e-6).all()
    assert (kept(fewer)[1::2] == 6).all()
    assert (kept(fewer)[::2] < 6).all()


def test_a_vertex_that_is_off_anyway_keeps_all() -> None:
    other = FRAMES.copy()
    other[:, 7] += 3.0
    fewer = spared(other, SHAPES, WEIGHTS, 0.1)
    assert kept(fewer)[7] == 6
    assert kept(fewer)[-1] == 0


@pytest.mark.parametrize("step", [0.0, 0.005])
def test_a_basis_has_zeros_where_they_take_no_room(step: float) -> None:
    filled = fit_basis(FRAMES, tolerance=0.1, step=step, sparse=False)
    sparse = fit_basis(FRAMES, tolerance=0.1, step=step)
    zeros = [(~basis.shapes.any(axis=2)).mean() for basis in (filled, sparse)]
    assert zeros[1] > zeros[0] + 0.15
    assert sparse.max_error <= 0.1
