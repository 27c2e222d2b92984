"""The motion basis: the fewest shapes that keep to the tolerance, and an honest error."""

from __future__ import annotations

import numpy as np
import pytest

from engine.gltf.basis import SNAPSHOT_COUNT, MotionBasis, fit_basis
from engine.gltf.positive import positive
from engine.gltf.regions import regions_of
from engine.rig import builtin_rig


def wandering_bump(frames: int, vertices: int = 120) -> np.ndarray:
    """A travelling bump: motion that no few shapes hold exactly."""
    place = np.linspace(0, 1, vertices)
    time = np.linspace(0, 1, frames)[:, None]
    height = 5 * np.exp(-(((place - time) / 0.15) ** 2))
    return (height[:, :, None] * np.array([0.2, -0.5, 1.0])).astype(np.float32)


def error_of(motion: np.ndarray, basis: MotionBasis, count: int | None = None) -> float:
    rebuilt = np.einsum("fk,kvi->fvi", basis.weights[:, :count], basis.shapes[:count])
    return float(np.linalg.norm(motion - rebuilt, axis=2).max())


def truncated(motion: np.ndarray, count: int) -> float:
    """The largest error of a plain SVD of some shapes."""
    rows = motion.reshape(len(motion), -1)
    left, strength, right = np.linalg.svd(rows, full_matrices=False)
    rest = rows - (left[:, :count] * strength[:count]) @ right[:count]
    return float(np.linalg.norm(rest.reshape(motion.shape), axis=2).max())


@pytest.mark.parametrize("tolerance", [0.5, 0.05, 0.005])
def test_keeps_to_the_tolerance_with_no_shape_to_spare(tolerance: float) -> None:
    motion = wandering_bump(60)
    basis = fit_basis(motion, tolerance=tolerance)
    assert error_of(motion, basis) == pytest.approx(basis.max_error, abs=1e-5)
    assert basis.max_error <= tolerance
    # One of them only turns the weights positive; without it, and with one shape fewer, no
    # plain SVD keeps to the tolerance.
    assert truncated(motion, len(basis.shapes) - 2) > tolerance


def test_looser_tolerance_takes_fewer_shapes() -> None:
    motion = wandering_bump(60)
    counts = [len(fit_basis(motion, tolerance=t).shapes) for t in (0.005, 0.05, 0.5)]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[2]


def test_one_shape_of_a_straight_motion() -> None:
    motion = np.linspace(0, 1, 20, dtype=np.float32)[:, None, None] * wandering_bump(3)[1]
    basis = fit_basis(motion, tolerance=0.01)
    assert len(basis.shapes) == 1
    np.testing.assert_allclose(basis.weights[:, 0], np.linspace(0, 1, 20), atol=1e-5)


def test_motion_between_the_snapshots_is_kept_too() -> None:
    motion = np.zeros((3 * SNAPSHOT_COUNT, 30, 3), np.float32)
    motion[7, 3] = 4.0  # one frame that even sampling steps over
    basis = fit_basis(motion, tolerance=0.05)
    assert error_of(motion, basis) <= 0.05


def test_stillness_is_one_shape_that_does_nothing() -> None:
    basis = fit_basis(np.zeros((5, 8, 3), np.float32), tolerance=0.05)
    assert basis.max_error == 0
    assert not basis.shapes.any()
    assert basis.shapes.shape == (1, 8, 3)


@pytest.mark.parametrize("step", [0.0, 0.005])
def test_weights_lie_from_0_to_1_and_rest_has_none(step: float) -> None:
    motion = wandering_bump(60) * np.cos(np.linspace(0, 20, 60))[:, None, None].astype("f4")
    motion[0] = 0.0
    basis = fit_basis(motion, tolerance=0.05, step=step)
    assert basis.weights.min() >= 0.0
    assert basis.weights.max(axis=0) == pytest.approx(1.0)
    assert np.abs(basis.weights[0]).max() < 1e-3
    assert error_of(motion, basis) <= 0.05


def test_a_move_that_does_not_fit_on_the_grid_says_so() -> None:
    basis = fit_basis(wandering_bump(60), tolerance=0.05, step=1e-4)
    assert basis.max_error == np.inf


def test_positive_weights_add_up_to_the_same() -> None:
    random = np.random.default_rng(5)
    shapes, weights = random.normal(0, 1, (6, 30)), random.normal(0.2, 1, (40, 6))
    weights[7] = 0.0
    others, turned = positive(shapes, weights)
    np.testing.assert_allclose(turned @ others, weights @ shapes, atol=1e-12)
    assert (others.shape, turned.shape) == ((7, 30), (40, 7))
    assert turned.min() >= 0.0
    np.testing.assert_allclose(turned.max(axis=0), 1.0)
    assert not turned[7].any()


def test_weights_that_are_positive_take_no_further_shape() -> None:
    weights = np.abs(np.random.default_rng(5).normal(0, 1, (40, 6)))
    for signs in (1.0, -1.0):
        others, turned = positive(np.eye(6), signs * weights)
        assert len(others) == 6
        np.testing.assert_allclose(turned @ others, signs * weights)


def test_every_vertex_is_in_one_region() -> None:
    skin = builtin_rig("standard").head.drawn.vertices
    regions = regions_of(skin)
    assert len(regions) == 5
    np.testing.assert_array_equal(np.sort(np.concatenate(regions)), np.arange(len(skin)))
    low = regions_of(np.array([[0.0, -60.0, 80.0]] * 4))
    assert [region.tolist() for region in low] == [[0, 1, 2, 3]]


class Watched:
    """A motion that counts the frames that are looked at."""

    def __init__(self, frames: np.ndarray) -> None:
        self.frames, self.seen = frames, 0

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, which: slice | np.ndarray, /) -> np.ndarray:
        some = self.frames[which]
        self.seen += len(some)
        return some


def mixes(frames: int) -> np.ndarray:
    """Every 30 frames another mix of some of thirty bumps, which slide a little as they rise."""
    random = np.random.default_rng(9)
    keys = random.random((frames // 30 + 2, 30)) * (random.random((frames // 30 + 2, 30)) < 0.15)
    time, place = np.arange(frames) / 30, np.linspace(0, 1, 150)
    heights = np.stack([np.interp(time, np.arange(len(keys)), each) for each in keys.T], axis=1)
    centers = random.random(30) + 0.03 * heights
    bumps = np.exp(-(((place - centers[:, :, None]) / 0.08) ** 2))
    moved = np.einsum("fk,fkv->fv", 5 * heights, bumps)
    return (moved[:, :, None] * np.array([0.2, -0.5, 1.0])).astype(np.float32)


def test_a_motion_of_any_length_is_looked_at_a_few_times() -> None:
    for frames in (600, 3600):
        motion = Watched(mixes(frames))
        basis = fit_basis(motion, tolerance=0.1)
        assert error_of(motion.frames, basis) <= 0.1
        # Twice for each round of more frames, and these rounds are few.
        assert motion.seen <= 7 * frames
