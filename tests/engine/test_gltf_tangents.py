"""Tangents: at right angles to the normals, along u, and true for pictures that are mirrored."""

from __future__ import annotations

import numpy as np
import pytest

from engine.gltf.tangents import tangents_of

CORNERS = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
FACING = np.tile([0.0, 0.0, 1.0], (4, 1))
UPRIGHT = np.array([[0.0, 1], [1, 1], [1, 0], [0, 0]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize(
    ("uvs", "expected"),
    [
        (UPRIGHT, (1, 0, 0, 1)),
        (UPRIGHT * [-1, 1] + [1, 0], (-1, 0, 0, -1)),  # mirrored: left is right, up stays up
        (UPRIGHT[[1, 2, 3, 0]], (0, -1, 0, 1)),  # a quarter turn
    ],
)
def test_they_follow_the_picture(uvs: np.ndarray, expected: tuple[float, ...]) -> None:
    found = tangents_of(CORNERS, FACING, uvs, TRIANGLES)
    np.testing.assert_allclose(found, np.tile(expected, (4, 1)), atol=1e-6)


def test_they_are_at_right_angles_to_any_normals() -> None:
    normals = FACING + np.random.default_rng(3).normal(0, 0.4, (4, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    found = tangents_of(CORNERS, normals, UPRIGHT, TRIANGLES)
    np.testing.assert_allclose(np.einsum("ij,ij->i", normals, found[:, :3]), 0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(found[:, :3], axis=1), 1, atol=1e-6)


def test_a_point_of_the_picture_gives_some_direction() -> None:
    found = tangents_of(CORNERS, FACING, np.zeros((4, 2)), TRIANGLES)
    np.testing.assert_allclose(np.linalg.norm(found[:, :3], axis=1), 1, atol=1e-6)
