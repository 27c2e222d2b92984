"""Everybody's action units: each moves its landmark the right way on each face."""

from __future__ import annotations

import pytest

from engine import people, rig_from_recipe
from engine.measure import measure_units


@pytest.mark.parametrize("name", people())
def test_every_unit_moves_the_right_way(name: str) -> None:
    rig = rig_from_recipe(people()[name].recipe, name=name, level="low")
    wrong = [
        (m.landmark.unit, m.landmark.what, m.value)
        for m in measure_units(rig, seconds=0.5)
        if not m.direction_right
    ]
    assert not wrong
