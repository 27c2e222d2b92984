"""The lids: outside ball and cornea at rest, and pushed out when the tissue presses them in."""

from __future__ import annotations

import numpy as np
import pytest

from engine.head import BULGE_HEIGHT, BULGE_RADIUS, LID_GAP, Eye, Head, LidContact
from engine.head.head import corneal_bulge

ALL = ("low", "medium", "high", "paper")


def height_over_eye(head: Head, vertices: np.ndarray) -> np.ndarray:
    """Return how high each contact vertex lies over ball and bulge, mm."""
    lids = head.drawn.lids
    offsets = vertices[lids.vertices] - np.array([eye.center for eye in head.eyes])[lids.eyes]
    radius = np.array([eye.radius for eye in head.eyes])[lids.eyes]
    return np.linalg.norm(offsets, axis=1) - radius - LID_GAP - corneal_bulge(offsets)


@pytest.mark.parametrize("level", ALL)
def test_lids_lie_outside_at_rest(heads: dict[str, Head], level: str) -> None:
    head = heads[level]
    assert height_over_eye(head, head.drawn.vertices).min() > 0.05
    for eye in head.eyes:
        distance = np.linalg.norm(head.drawn.vertices - eye.center, axis=1)
        assert distance.min() > eye.radius + 0.1


@pytest.mark.parametrize("level", ALL)
def test_rest_stays_at_rest(heads: dict[str, Head], level: str) -> None:
    head = heads[level]
    still = head.drawn.deform(np.zeros_like(head.points), head.eyes)
    np.testing.assert_array_equal(still, head.drawn.vertices)


def test_pressed_lids_stay_outside(head: Head) -> None:
    pressed = np.zeros_like(head.points)
    around_eye = np.array([name.startswith(("E0", "E1", "E2", "EB")) for name in head.names])
    pressed[around_eye, 2] = -3.0
    free = head.drawn.vertices + head.drawn.map @ pressed
    held = head.drawn.deform(pressed, head.eyes)
    assert height_over_eye(head, free).min() < -1
    lids = head.drawn.lids
    in_front = held[lids.vertices, 2] > head.eyes[0].center[2]
    # The bulge under a vertex changes a little as it is pushed out: not exactly the clearance.
    assert (height_over_eye(head, held) - lids.clearance)[in_front].min() > -0.12
    assert height_over_eye(head, held)[in_front].min() > -0.05
    untouched = np.setdiff1d(np.arange(len(held)), lids.vertices)
    np.testing.assert_array_equal(held[untouched], free[untouched])


def test_each_lid_has_its_own_eye(head: Head) -> None:
    lids = head.drawn.lids
    side = head.drawn.vertices[lids.vertices, 0]
    np.testing.assert_array_equal(lids.eyes, (side < 0).astype(int))
    assert head.eyes[0].center[0] > 0 > head.eyes[1].center[0]


def test_projection_by_hand() -> None:
    eye = Eye(np.zeros(3), 12.0)
    contact = LidContact(np.array([0, 1, 2]), np.array([0, 0, 0]), np.array([0.5, 0.5, 0.5]))
    vertices = np.array([[0.0, 0.0, 6.0], [9.0, 0.0, 1.0], [0.0, 0.0, -6.0], [0.0, 0.0, 1.0]])
    pushed = contact.project(vertices, (eye,))
    np.testing.assert_allclose(pushed[0], [0, 0, 12 + LID_GAP + BULGE_HEIGHT + 0.5])
    assert np.linalg.norm(pushed[1]) == pytest.approx(12.55)  # beyond the cornea
    np.testing.assert_array_equal(pushed[2:], vertices[2:])  # behind the eye, and no lid at all


def test_bulge_ends_where_it_should() -> None:
    offsets = np.array([[0.0, 0.0, 1.0], [BULGE_RADIUS, 0.0, 1.0], [0.0, 0.0, -1.0]])
    np.testing.assert_allclose(corneal_bulge(offsets), [BULGE_HEIGHT, 0, 0])
