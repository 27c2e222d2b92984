"""Everybody's action units: each moves its landmark the right way, and far enough, on each face."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Keyframe, Recipe, people, rig_from_recipe
from engine.measure import measure_units, settle


@pytest.mark.parametrize("name", people())
def test_every_unit_moves_the_right_way_and_within_human_range(name: str) -> None:
    rig = rig_from_recipe(people()[name].recipe, name=name, level="low")
    measured = measure_units(rig, seconds=0.8)
    wrong = [(m.landmark.unit, m.landmark.what, m.value) for m in measured if not m.direction_right]
    assert not wrong
    outside = [(m.landmark.unit, m.landmark.what, m.value) for m in measured if not m.in_range]
    assert not outside


@pytest.mark.parametrize("sex", ["female", "male"])
@pytest.mark.parametrize("age", [20, 60, 85])
def test_faces_of_every_age_come_to_rest(sex: str, age: int) -> None:
    rig = rig_from_recipe(Recipe.of({"sex": sex, "age": age}), level="low")
    strained = Keyframe(action_units={"AU1": 1.0, "AU12": 1.0, "AU17": 0.6, "AU27": 0.5})
    early, late = (settle(rig, [strained], seconds=seconds)[0] for seconds in (0.6, 0.9))
    assert np.isfinite(late.displacements).all()
    assert np.linalg.norm(late.displacements, axis=1).max() < 40.0
    assert np.abs(late.displacements - early.displacements).max() < 1.0
