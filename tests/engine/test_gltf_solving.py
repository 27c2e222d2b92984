"""Bounded weights: what made a frame is found again, and nothing leaves its bounds."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from engine.gltf.solving import bounded_weights


def random_shapes(count: int = 8) -> np.ndarray:
    return np.random.default_rng(4).normal(0, 1, (60, count))


def test_weights_that_made_a_frame_are_found_again() -> None:
    shapes = random_shapes()
    made = np.random.default_rng(5).uniform(0, 1, (8, 30))
    found = bounded_weights(shapes.T @ shapes, shapes.T @ (shapes @ made))
    np.testing.assert_allclose(found, made.T, atol=2e-3)


def test_weights_are_those_of_bounded_least_squares() -> None:
    shapes = random_shapes()
    frames = np.random.default_rng(6).normal(0, 6, (60, 20))
    found = bounded_weights(shapes.T @ shapes, shapes.T @ frames)
    assert found.min() == 0.0
    assert found.max() == 1.0
    for weights, frame in zip(found, frames.T, strict=True):
        reference = lsq_linear(shapes, frame, bounds=(0, 1), method="bvls").x
        np.testing.assert_allclose(weights, reference, atol=3e-3)


def test_shapes_that_are_alike_share() -> None:
    shapes = np.repeat(random_shapes(1), 2, axis=1)
    found = bounded_weights(shapes.T @ shapes, shapes.T @ shapes[:, :1])
    assert found.sum() == pytest.approx(1.0, abs=0.01)


def test_a_shape_that_does_nothing_has_no_weight() -> None:
    shapes = random_shapes()
    shapes[:, 3] = 0.0
    found = bounded_weights(shapes.T @ shapes, shapes.T @ shapes[:, [0]])
    assert found[0, 3] == 0.0
