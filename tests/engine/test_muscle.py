"""Equations 1-17 at points worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import InvalidValue
from engine.dynamics import add_muscle_forces
from engine.force_basis import packed_shape
from engine.muscle import (
    RING_PEAK,
    LinearMuscle,
    SheetMuscle,
    SphincterMuscle,
    angular_profile,
    literal_ring_profile,
    longitudinal_profile,
    mirrored,
    ring_profile,
)

LINEAR = LinearMuscle("m.L", (0.0, 0.0, 0.0), (10.0, 0.0, 0.0), 15.0, 30.0, 1.5, 100.0)
SHEET = SheetMuscle(
    "s.L",
    ((10.0, 20.0, 0.0), (20.0, 20.0, 0.0)),
    ((10.0, 10.0, 0.0), (20.0, 10.0, 0.0)),
    15.0,
    2.0,
    1.0,
)
RING = SphincterMuscle("r", (0.0, 0.0, 10.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 20.0, 10.0, 50.0)


@pytest.mark.parametrize("strength", [0.5, 1.0, 2.5])
def test_longitudinal_profile_is_zero_at_the_ends_and_one_at_the_insertion(strength):
    along = np.array([0.0, 1.0, 1.6, 1.7])
    assert longitudinal_profile(along, 1.6, strength) == pytest.approx([0, 1, 0, 0], abs=1e-12)


@pytest.mark.parametrize("strength", [0.5, 1.0, 2.5])
def test_longitudinal_profile_is_smooth_across_the_insertion(strength):
    step = 1e-6
    below, above = longitudinal_profile(np.array([1 - step, 1 + step]), 1.5, strength)
    assert abs(below - 1.0) < 1e-9
    assert abs(above - 1.0) < 1e-9


def test_longitudinal_profile_by_hand():
    # Eq. 7 at λ = 0.25, η = 0.5: cos((1 - 0.5) π/2); beyond, at λ = 1.21, η = 0.5, δ = 1.44:
    # cos((1.1 - 1)/(1.2 - 1) π/2).
    values = longitudinal_profile(np.array([0.25, 1.21]), 1.44, 0.5)
    assert values == pytest.approx([math.cos(math.pi / 4), math.cos(math.pi / 4)])


def test_a_smaller_strength_spreads_the_influence_towards_the_attachment():
    near = np.array([0.3])
    assert longitudinal_profile(near, 1.5, 0.5) > longitudinal_profile(near, 1.5, 2.0)


def test_angular_profile_by_hand():
    angle = math.radians(40.0)
    values = angular_profile(np.array([0.0, 0.5, 1.0, 1.01]), angle)
    half = math.cos(angle / 2) * math.cos(math.pi / 4)
    assert values == pytest.approx([1.0, half, 0.0, 0.0], abs=1e-12)


def test_linear_muscle_pulls_its_insertion_straight_to_the_attachment():
    insertion = np.array([LINEAR.insertion])
    assert LINEAR.weights(insertion) == pytest.approx([1.0])
    assert LINEAR.directions(insertion)[0] == pytest.approx([-1.0, 0.0, 0.0])
    assert LINEAR.weights(np.array([LINEAR.attachment])) == pytest.approx([0.0], abs=1e-9)


def test_linear_muscle_off_its_axis_by_hand():
    # A point at the muscle's length, 15 degrees off: λ = 1, γ = 0.5.
    point = np.array([[10 * math.cos(math.radians(15)), 10 * math.sin(math.radians(15)), 0.0]])
    expected = math.cos(math.radians(15)) * math.cos(math.pi / 4)
    assert LINEAR.weights(point) == pytest.approx([expected])


def test_linear_muscle_does_not_act_beyond_its_angle_or_reach():
    beyond = np.array([[0.0, 10.0, 0.0], [15.5, 0.0, 0.0], [-5.0, 0.0, 0.0]])
    assert LINEAR.weights(beyond) == pytest.approx([0.0, 0.0, 0.0])


def test_literal_sphincter_is_greatest_on_the_rim():
    values = literal_ring_profile(np.array([0.0, 0.5, 1.0, 1.001]))
    assert values == pytest.approx([0.0, math.cos(math.pi / 4), 1.0, 0.0], abs=1e-12)


def test_ring_sphincter_is_continuous_and_greatest_at_its_peak():
    values = ring_profile(np.array([0.0, RING_PEAK, 1.0, 1.5]))
    assert values == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=1e-12)
    fine = ring_profile(np.linspace(0.0, 1.2, 2001))
    assert np.abs(np.diff(fine)).max() < 3e-3


def test_sphincter_radius_is_one_on_the_ellipse():
    # Eq. 12 on both half-axes: the literal profile is 1 on the rim.
    rim = np.array([[20.0, 0.0, 0.0], [0.0, 10.0, 0.0]])
    assert RING.weights(rim, profile="literal") == pytest.approx([1.0, 1.0])
    assert RING.directions(np.array([[0.0, 0.0, 0.0]]))[0] == pytest.approx([0.0, 0.0, 1.0])


def test_sheet_pulls_everything_one_way():
    points = np.array([[15.0, 10.0, 0.0], [13.0, 12.0, 0.0]])
    assert SHEET.directions(points) == pytest.approx(np.tile([0.0, 1.0, 0.0], (2, 1)))
    assert SHEET.weights(points)[0] == pytest.approx(1.0)
    # Eq. 16: 2 mm nearer the attachment line, λ = 0.8, η = 2: cos((1 - 0.64) π/2).
    assert SHEET.weights(points)[1] == pytest.approx(math.cos(0.36 * math.pi / 2))


def test_sheet_has_no_force_behind_its_attachment_or_beyond_its_zone():
    beyond = np.array([[15.0, 21.0, 0.0], [15.0, 4.9, 0.0], [40.0, 10.0, 0.0]])
    assert SHEET.weights(beyond) == pytest.approx([0.0, 0.0, 0.0])


@given(st.lists(st.tuples(*[st.floats(-30, 30)] * 3), min_size=1, max_size=20))
def test_a_mirrored_muscle_mirrors_its_force(points):
    here = np.array(points)
    flip = np.array([-1.0, 1.0, 1.0])
    for muscle in (LINEAR, SHEET):
        twin = mirrored(muscle)
        assert twin.name.endswith(".R")
        assert twin.weights(here * flip) == pytest.approx(muscle.weights(here), abs=1e-12)


@given(st.lists(st.tuples(*[st.floats(-25, 25)] * 3), min_size=4, max_size=30))
def test_the_moving_kernel_agrees_with_the_muscles(points):
    here = np.array(points)
    n = len(here)
    from engine.dynamics import Pull

    for kind, muscle in enumerate((LINEAR, RING, SHEET)):
        if kind == 2:
            # The kernel leaves the lateral fade of a sheet to the shares: stay inside it.
            here = here * np.array([0.05, 1.0, 1.0]) + np.array([15.0, 0.0, 0.0])
        force = np.zeros((3, 3 * n))
        pull = Pull(
            np.array([kind], np.int32),
            packed_shape(muscle, ring="ring")[None],
            np.array([2.0]),
            np.ones((1, n)),
        )
        x = np.ascontiguousarray(np.tile(here, (3, 1)).T)
        add_muscle_forces(x, pull, force)
        near = np.abs(here[:, 2]) < 29.0
        expected = 2.0 * muscle.weights(here)[:, None] * muscle.directions(here)
        assert force[:, 2 * n :].T[near] == pytest.approx(expected[near], abs=1e-7)
        assert not force[:, : 2 * n].any()


def test_nonsense_geometry_is_refused_with_what_was_given():
    with pytest.raises(InvalidValue, match="radius is 5 mm"):
        LinearMuscle("m", (0, 0, 0), (10, 0, 0), 5.0, 30.0, 1.0, 1.0)
    with pytest.raises(InvalidValue, match="angle"):
        LinearMuscle("m", (0, 0, 0), (10, 0, 0), 15.0, 90.0, 1.0, 1.0)
    with pytest.raises(InvalidValue, match="semi_minor"):
        SphincterMuscle("r", (0, 0, 1), (0, 0, 0), (0, 0, 1), 20.0, 0.0, 1.0)
