"""The two sides of a face are seen to differ a little; lids, lips and tissue are not touched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.head import STANDARD, Head, person_head, standard_head
from engine.head.anthropometry import measured
from engine.head.identity.asymmetry import asymmetry_at
from engine.head.identity.shape import anchors_of


@pytest.fixture(scope="module")
def even() -> Head:
    """Return the standard head with both sides alike."""
    return person_head(replace(STANDARD, asymmetry=0.0))


@pytest.fixture(scope="module")
def head() -> Head:
    """Return the standard head."""
    return standard_head()


def test_a_face_is_slightly_uneven(head: Head, even: Head) -> None:
    away = np.linalg.norm(head.drawn.vertices - even.drawn.vertices, axis=1)
    assert 0.2 < away[head.drawn.vertices[:, 2] > 30].mean() < 0.8
    assert away.max() < 2.5
    assert np.array_equal(head.points, even.points)


def test_the_sides_differ_and_their_mean_does_not(even: Head) -> None:
    points = even.drawn.vertices
    here = asymmetry_at(STANDARD, points, anchors_of(even))
    image = asymmetry_at(STANDARD, points * [-1, 1, 1], anchors_of(even)) * [-1, 1, 1]
    assert here == pytest.approx(-image, abs=1e-9)


def test_lids_and_lips_stay(head: Head, even: Head) -> None:
    lids = head.drawn.lids.vertices
    eye = np.array([e.center for e in even.eyes])[head.drawn.lids.eyes]
    close = np.linalg.norm(even.drawn.vertices[lids] - eye, axis=1) < 17.0
    moved = head.drawn.vertices[lids] - even.drawn.vertices[lids]
    assert np.abs(moved[close]).max() == 0.0
    seam = [head.landmarks["sto"]]
    assert np.abs(head.drawn.vertices[seam] - even.drawn.vertices[seam]).max() == 0.0


def test_the_seed_chooses_and_measures_stay(head: Head) -> None:
    other = person_head(replace(STANDARD, seed=5))
    assert not np.array_equal(other.drawn.vertices, head.drawn.vertices)
    for name, size in measured(head.landmark_places).items():
        assert abs(measured(other.landmark_places)[name] - size) < 1.0, name
