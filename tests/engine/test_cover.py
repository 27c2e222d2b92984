"""Teeth, gums, tongue and eyeballs stay behind the skin, whatever the action units do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from engine import Keyframe, Recipe, Rig, Simulator, rig_from_recipe
from engine.cover import REACH_MM, crossings, showing
from engine.frame import Frame

POSES: Mapping[str, Mapping[str, float]] = {
    **{unit: {unit: 1.0} for unit in "AU12 AU15 AU18 AU20 AU24 AU27".split()},
    "smile": {"AU6": 1.0, "AU12": 1.0, "AU25": 1.0},
    "bared": {"AU10": 1.0, "AU16": 1.0, "AU25": 1.0},
    "laugh": {"AU12": 1.0, "AU27": 1.0},
}


def settled(rig: Rig, poses: Mapping[str, Mapping[str, float]]) -> dict[str, Frame]:
    """Return the face in each pose."""
    simulator = Simulator(rig)
    for name, units in poses.items():
        simulator.add(name)
        simulator.apply(name, Keyframe(action_units=dict(units)))
    for _ in range(60):
        simulator.step()
    return {name: simulator.frame(name) for name in poses}


def test_a_tooth_before_the_lips_would_be_found(standard_rig: Rig) -> None:
    head = standard_rig.head
    lips = head.landmarks["ls"]
    start = head.drawn.vertices[[lips, lips]] + [[0.0, 0.0, 2.0], [0.0, 0.0, -12.0]]
    way = np.tile([0.0, 0.0, -REACH_MM], (2, 1))
    found = crossings(start, way, head.drawn.vertices, head.drawn.triangles)
    assert found.tolist() == [True, False]


def test_nothing_of_the_mouth_comes_through_the_skin(standard_rig: Rig) -> None:
    frames = settled(standard_rig, POSES)
    through = {name: showing(standard_rig, frame) for name, frame in frames.items()}
    assert not {name: found for name, found in through.items() if found}


@pytest.mark.parametrize("recipe", [Recipe(sex=0.0, mouth_width=-2.0, lip_fullness=-1.0)])
def test_nor_does_it_in_a_small_mouth(recipe: Recipe) -> None:
    rig = rig_from_recipe(recipe, level="medium")
    chosen = ("AU12", "AU15", "AU18", "AU20", "AU24", "AU27", "smile", "bared")
    frames = settled(rig, {name: POSES[name] for name in chosen})
    through = {name: showing(rig, frame) for name, frame in frames.items()}
    assert not {name: found for name, found in through.items() if found}
