"""The norms of the face: one for every measurement, of both sexes."""

from __future__ import annotations

import pytest

from engine.head import Head
from engine.head.anthropometry import MEASUREMENTS, UNCHECKED, measured, norms


def test_every_measurement_has_a_norm() -> None:
    for sex in (0.0, 0.5, 1.0):
        assert set(norms(sex)) == set(MEASUREMENTS)
    assert set(UNCHECKED) <= set(MEASUREMENTS)


def test_sexes_blend() -> None:
    women, between, men = norms(0.0)["zy-zy"], norms(0.5)["zy-zy"], norms(1.0)["zy-zy"]
    assert women.mean < between.mean < men.mean
    assert between.mean == pytest.approx((women.mean + men.mean) / 2)


def test_standard_deviations_are_those_of_people() -> None:
    for sex in (0.0, 1.0):
        for name, norm in norms(sex).items():
            assert 0.02 < norm.sd / norm.mean < 0.2, name


def test_measures_from_point_to_point(head: Head) -> None:
    found = measured(head.landmark_places)
    assert set(found) == set(MEASUREMENTS)
    left = head.drawn.vertices[head.landmarks["zy.L"]]
    assert found["zy-zy"] == pytest.approx(2 * left[0])
