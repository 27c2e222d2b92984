"""Wrinkles form where an action unit presses the skin, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Keyframe, Rig, settled
from engine.head.wrinkles import Wrinkles, wrinkles_of

PLACES = {
    "forehead": (0, 48),
    "forehead_side": (48, 50),
    "glabella": (6, 17),
    "nasal_root": (0, 3),
    "nose_side": (11, -14),
    "crows_feet": (60, 0),
    "lower_lid": (33, -12),
    "nasolabial": (30, -60),
    "chin": (0, -101),
}
PRESSED = {
    "AU1": ("forehead",),
    "AU2": ("forehead_side",),
    "AU4": ("glabella", "nasal_root"),
    "AU6": ("crows_feet", "lower_lid"),
    "AU9": ("nasal_root", "nose_side", "nasolabial"),
    "AU10": ("nose_side", "nasolabial"),
    "AU12": ("nasolabial",),
    "AU14": (),
    "AU17": ("chin",),
    "AU18": (),
    "AU20": (),
    "AU24": (),
    "AU27": (),
    "AU43": (),
}
FORMED, SMOOTH, REST = 0.6, 0.15, 0.001
"""A unit forms its own wrinkles to more than the one, any other's to less than the other."""


@pytest.fixture(scope="module")
def wrinkles(standard_rig: Rig) -> Wrinkles:
    found = wrinkles_of(standard_rig.head)
    assert found is not None
    return found


def at_places(rig: Rig, weights: np.ndarray) -> dict[str, float]:
    places = rig.head.drawn.reference
    found = {}
    for name, (x, y) in PLACES.items():
        away = np.hypot(places[:, 0] - x, places[:, 1] - y) + np.where(places[:, 2] < 30, 1e3, 0)
        found[name] = float(weights[np.argmin(away)])
    return found


def test_rest_is_smooth(standard_rig: Rig, wrinkles: Wrinkles) -> None:
    assert wrinkles(standard_rig.head.points).max() < REST


@pytest.mark.parametrize("unit", PRESSED)
def test_units_press_their_sites(standard_rig: Rig, wrinkles: Wrinkles, unit: str) -> None:
    frame = settled(standard_rig, [Keyframe(action_units={unit: 1.0}, fade=0.15)])[0]
    strength = at_places(standard_rig, wrinkles(standard_rig.head.points + frame.displacements))
    for site, value in strength.items():
        if site in PRESSED[unit]:
            assert value > FORMED, (unit, strength)
        else:
            assert value < SMOOTH, (unit, strength)


def test_smile_that_narrows_the_eyes_bags_the_lower_lids(
    standard_rig: Rig, wrinkles: Wrinkles
) -> None:
    smile = Keyframe(action_units={"AU6": 1.0, "AU12": 1.0, "AU25": 1.0}, fade=0.15)
    frame = settled(standard_rig, [smile])[0]
    strength = at_places(standard_rig, wrinkles(standard_rig.head.points + frame.displacements))
    for site in ("lower_lid", "crows_feet", "nasolabial"):
        assert strength[site] > FORMED, strength


def test_paper_has_none(paper_rig: Rig) -> None:
    assert wrinkles_of(paper_rig.head) is None


def test_a_smile_creases_the_skin_round_the_eye(standard_rig: Rig, wrinkles: Wrinkles) -> None:
    """The raised cheek of AU12 does not take away what AU6 folds; a slight frown shows."""
    smile = {"AU6": 1.0, "AU12": 1.0}
    for units, sites in ((smile, ("crows_feet", "lower_lid")), ({"AU4": 0.4}, ("glabella",))):
        frame = settled(standard_rig, [Keyframe(action_units=units, fade=0.15)])[0]
        strength = at_places(standard_rig, wrinkles(standard_rig.head.points + frame.displacements))
        for site in sites:
            assert strength[site] > (0.7 if units is smile else 0.2), strength
