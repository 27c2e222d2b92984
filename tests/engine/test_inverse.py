"""The inverse: known activations are found again from where they put the landmarks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import LANDMARKS_68, InvalidValue, Keyframe, UnknownName, invert, settled
from engine.landmarks import named_point
from engine.muscle import LidMuscle

ACTIVATION_TOLERANCE = 0.15
RMS_MM = 0.05


def targets_of(rig, keyframe, names=LANDMARKS_68):
    """Where a command puts landmarks, as targets."""
    displacements = settled(rig, [keyframe])[0].displacements
    return {name: [float(v) for v in displacements[rig.head.point(name)]] for name in names}


@pytest.fixture(scope="module")
def corner(standard_rig):
    """The inverse of one landmark, asked for farther than it can go."""
    return invert(standard_rig, {"M1_5.L": [15.0, 50.0, -10.0], "prn": [0.0, 0.0, 0.0]})


def test_known_activations_are_recovered(standard_rig):
    muscles = {
        "zygomatic_major.L": 0.8,
        "zygomatic_major.R": 0.3,
        "corrugator_supercilii.L": 0.5,
        "frontalis_lateral.R": 0.6,
        "mentalis.L": 0.4,
        "mentalis.R": 0.4,
    }
    targets = targets_of(standard_rig, Keyframe(muscles=muscles, jaw={"pitch": 8.0}))
    found = invert(standard_rig, targets)
    assert found.rms < RMS_MM
    assert found.converged
    for name in standard_rig.muscle_names:
        wanted = muscles.get(name, 0.0)
        assert found.activations.get(name, 0.0) == pytest.approx(wanted, abs=ACTIVATION_TOLERANCE)
    assert found.jaw["pitch"] == pytest.approx(8.0, abs=0.2)
    assert found.jaw["yaw"] == pytest.approx(0.0, abs=0.2)


def test_known_units_are_recovered(standard_rig):
    units = {"AU6": 0.7, "AU12": 0.8, "AU26": 0.4}
    searched = ["AU1", "AU4", "AU6", "AU12", "AU14", "AU15", "AU20", "AU26"]
    targets = targets_of(standard_rig, Keyframe(action_units=units))
    found = invert(standard_rig, targets, units=searched)
    assert found.rms < RMS_MM
    assert set(found.action_units) <= set(searched)
    for name in searched:
        wanted = units.get(name, 0.0)
        assert found.action_units.get(name, 0.0) == pytest.approx(wanted, abs=0.05)


def test_what_is_answered_is_what_a_client_gets(standard_rig):
    found = invert(standard_rig, {"M1_5.L": [3.0, 6.0, -3.0], "M1_5.R": [-3.0, 6.0, -3.0]})
    played = settled(standard_rig, [Keyframe(muscles=found.activations, jaw=found.jaw)])[0]
    for mark in found.landmarks:
        here = played.displacements[standard_rig.head.point(mark.name)]
        np.testing.assert_allclose(here, mark.reached, atol=0.1)
        assert mark.residual < 0.5
    sides = [found.activations[f"zygomatic_major.{side}"] for side in "LR"]
    assert sides[0] == pytest.approx(sides[1], abs=0.05)


def test_bounds_hold_where_a_target_cannot_be_reached(standard_rig, corner):
    assert max(corner.activations.values()) <= 1.5
    assert corner.activations["zygomatic_major.L"] > 1.0
    for name, value in corner.activations.items():
        if isinstance(standard_rig.muscle(name), LidMuscle):
            assert -1.0 <= value <= 1.0
        else:
            assert value > 0.0
    assert 0.0 <= corner.jaw["pitch"] <= 35.0
    left, nose = corner.landmarks
    assert left.residual > 15.0
    assert left.residual == pytest.approx(math.dist(left.target, left.reached))
    assert nose.residual < left.residual
    assert corner.rms == pytest.approx(math.hypot(left.residual, nose.residual) / math.sqrt(2))


def test_the_same_question_has_the_same_answer(standard_rig, corner):
    again = invert(standard_rig, {"M1_5.L": [15.0, 50.0, -10.0], "prn": [0.0, 0.0, 0.0]}, threads=1)
    assert again.to_json() == corner.to_json()


def test_only_what_may_be_used_is(standard_rig):
    found = invert(
        standard_rig, {"M1_5.L": [4.0, 9.0, -4.0]}, muscles=["zygomatic_major"], jaw=False
    )
    assert set(found.activations) <= {"zygomatic_major.L", "zygomatic_major.R"}
    assert found.jaw == {"pitch": 0.0, "yaw": 0.0, "thrust": 0.0}
    assert found.landmarks[0].residual < 3.0


def test_an_open_axis_is_not_fitted(standard_rig):
    found = invert(standard_rig, {"M1_5.L": [None, 6.0, None]}, muscles=["zygomatic_major.L"])
    (mark,) = found.landmarks
    assert mark.reached[1] == pytest.approx(6.0, abs=0.3)
    assert mark.residual == pytest.approx(abs(mark.reached[1] - 6.0), abs=1e-9)
    assert found.to_json()["landmarks"][0]["target"] == [None, 6.0, None]


def test_weights_say_which_target_counts(standard_rig):
    torn = {"M1_5.L": [3.0, 6.0, -3.0], "M1_4.L": [0.0, 0.0, 0.0]}
    only = {"muscles": ["zygomatic_major.L"], "jaw": False}
    up = invert(standard_rig, torn, weights={"M1_5.L": 100.0}, **only).landmarks
    still = invert(standard_rig, torn, weights={"M1_4.L": 100.0}, **only).landmarks
    assert up[0].residual < still[0].residual
    assert still[1].residual < up[1].residual


def test_effort_is_spared(standard_rig):
    target = {"M1_5.L": [4.0, 9.0, -4.0]}
    some = invert(standard_rig, target, regularization=0.5)
    none = invert(standard_rig, target, regularization=8.0)
    assert sum(none.activations.values()) < 0.8 * sum(some.activations.values())
    assert none.rms > some.rms


def test_landmarks_have_three_kinds_of_names(standard_rig):
    head = standard_rig.head
    assert named_point(head, "48") == named_point(head, "ch.R") == head.point("M1_5.R")
    assert named_point(head, "prn") == head.point("b7_0")
    with pytest.raises(UnknownName, match="did you mean") as error:
        named_point(head, "M1_55.L")
    assert "M1_5.L" in error.value.nearest


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"targets": {}}, InvalidValue, "empty"),
        ({"targets": {"M9_9": [0, 0, 0]}}, UnknownName, "landmark"),
        ({"targets": {"68": [0, 0, 0]}}, UnknownName, "landmark"),
        ({"targets": {"prn": [0, 0]}}, InvalidValue, "x, y and z"),
        ({"targets": {"prn": [0, 900, 0]}}, InvalidValue, "between"),
        ({"targets": {"prn": [0, math.nan, 0]}}, InvalidValue, "finite"),
        ({"targets": {"prn": [None, None, None]}}, InvalidValue, "nothing is asked"),
        ({"weights": {"ls": 1.0}}, UnknownName, "target"),
        ({"weights": {"prn": -1.0}}, InvalidValue, "between"),
        ({"weights": {"prn": 0.0}}, InvalidValue, "nothing is asked"),
        ({"muscles": ["biceps"]}, UnknownName, "muscle"),
        ({"units": ["AU99"]}, UnknownName, "action unit"),
        ({"units": ["AU1"], "muscles": ["risorius"]}, InvalidValue, "not both"),
        ({"muscles": [], "jaw": False}, InvalidValue, "nothing can move"),
        ({"regularization": -1.0}, InvalidValue, "regularization"),
        ({"iterations": 0}, InvalidValue, "iterations"),
    ],
)
def test_what_cannot_be_asked_is_refused(standard_rig, given, error, message):
    with pytest.raises(error, match=message):
        invert(standard_rig, **{"targets": {"prn": [0.0, 1.0, 0.0]}, **given})
