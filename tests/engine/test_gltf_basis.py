"""The motion basis: the fewest shapes that keep to the tolerance, and an honest error."""

from __future__ import annotations

import numpy as np
import pytest

from engine.gltf.basis import SNAPSHOT_COUNT, MotionBasis, fit_basis


def wandering_bump(frames: int, vertices: int = 120) -> np.ndarray:
    """A travelling bump: motion that no few shapes hold exactly."""
    place = np.linspace(0, 1, vertices)
    time = np.linspace(0, 1, frames)[:, None]
    height = 5 * np.exp(-(((place - time) / 0.15) ** 2))
    return (height[:, :, None] * np.array([0.2, -0.5, 1.0])).astype(np.float32)


def error_of(motion: np.ndarray, basis: MotionBasis, count: int | None = None) -> float:
    rebuilt = np.einsum("fk,kvi->fvi", basis.weights[:, :count], basis.shapes[:count])
    return float(np.linalg.norm(motion - rebuilt, axis=2).max())


@pytest.mark.parametrize("tolerance", [0.5, 0.05, 0.005])
def test_keeps_to_the_tolerance_with_no_shape_to_spare(tolerance: float) -> None:
    motion = wandering_bump(60)
    basis = fit_basis(motion, tolerance=tolerance)
    assert error_of(motion, basis) == pytest.approx(basis.max_error, abs=1e-5)
    assert basis.max_error <= tolerance
    assert error_of(motion, basis, len(basis.shapes) - 1) > tolerance


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


def test_weights_stay_within_one() -> None:
    basis = fit_basis(wandering_bump(60), tolerance=0.05)
    assert np.abs(basis.weights).max() == pytest.approx(1.0)
