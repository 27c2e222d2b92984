"""Equation 18: the jaw's rotation, by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import JawHinge
from engine.jaw import jaw_rotation


def test_rotation_is_proper():
    matrix = jaw_rotation(0.3, -0.2)
    assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(matrix) == pytest.approx(1.0)


def test_rotation_is_the_papers_matrix():
    px, py = 0.4, 0.1
    sx, cx, sy, cy = math.sin(px), math.cos(px), math.sin(py), math.cos(py)
    expected = [[cy, -sx * sy, -cx * sy], [0, cx, -sx], [sy, sx * cy, cx * cy]]
    assert jaw_rotation(px, py) == pytest.approx(np.array(expected))


def test_opening_drops_the_chin_and_yaw_moves_it_to_the_faces_left():
    jaw = JawHinge()
    chin = np.array([[0.0, -104.5, 98.0]])
    opened = jaw.move(chin, np.ones(1), 20.0, 0.0, 0.0)
    assert opened[0, 1] < chin[0, 1] - 20.0
    turned = jaw.move(chin, np.ones(1), 0.0, 5.0, 0.0)
    assert turned[0, 0] > 5.0


def test_the_share_scales_the_angle():
    jaw = JawHinge(slide=0.0)
    point = np.array([[0.0, -50.0, 80.0]])
    half = jaw.move(point, np.array([0.5]), 20.0, 4.0, 0.0)
    whole = jaw.move(point, np.ones(1), 10.0, 2.0, 0.0)
    assert half == pytest.approx(whole)


def test_the_transform_is_the_move_of_a_rigid_point():
    jaw = JawHinge()
    points = np.array([[3.0, -80.0, 70.0], [-10.0, -60.0, 90.0]])
    rotation, offset = jaw.transform(12.0, -3.0, 2.0)
    center = np.array(jaw.center)
    rigid = (points - center) @ rotation.T + center + offset
    assert rigid == pytest.approx(jaw.move(points, np.ones(2), 12.0, -3.0, 2.0))
