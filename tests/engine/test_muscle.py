"""Equations 1-17 at points worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import InvalidValue, Simulator
from engine.dynamics import Pull, add_muscle_forces
from engine.force_basis import (
    Samples,
    force_density,
    jaw_rides,
    moving_pull,
    packed_shape,
    press_density,
    ride_jaw,
    share_of,
)
from engine.muscle import (
    RING_PEAK,
    AirPressure,
    LidMuscle,
    LinearMuscle,
    SheetMuscle,
    SphincterMuscle,
    angular_profile,
    literal_ring_profile,
    longitudinal_profile,
    mirrored,
    ring_profile,
)
from engine.rest_basis import ground_of, rest_basis
from engine.tissue import assemble

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


HOOP = replace(RING, hoop=0.8)
CENTRAL = SheetMuscle(
    "c.L",
    ((0.0, 20.0, 0.0), (20.0, 20.0, 0.0)),
    ((0.0, 10.0, 0.0), (20.0, 10.0, 0.0)),
    15.0,
    2.0,
    1.0,
)
"""A sheet that starts at the midline."""


@settings(deadline=None)
@given(st.lists(st.tuples(*[st.floats(-40, 40)] * 3), min_size=4, max_size=30))
def test_the_moving_kernel_agrees_with_the_muscles(points):
    here = np.array(points)
    n = len(here)
    kinds = {"linear": 0, "sphincter": 1, "sheet": 2}
    for muscle in (LINEAR, RING, HOOP, SHEET, mirrored(SHEET), CENTRAL, mirrored(CENTRAL)):
        force = np.zeros((3, 3 * n))
        pull = Pull(
            np.array([kinds[muscle.kind]], np.int32),
            packed_shape(muscle, ring="ring")[None],
            np.array([2.0]),
            np.ones((1, n)),
        )
        x = np.ascontiguousarray(np.tile(here, (3, 1)).T)
        deep = np.stack([np.zeros(n), np.zeros(n), np.ones(n)])
        add_muscle_forces(x, pull, deep, force)
        expected = 2.0 * muscle.weights(here)[:, None] * muscle.directions(here)
        assert force[:, 2 * n :].T == pytest.approx(expected, abs=1e-7)
        assert not force[:, : 2 * n].any()


def test_a_sheet_that_starts_at_the_midline_fades_at_its_outer_edge_only():
    lateral = np.array([[x, 10.0, 0.0] for x in (0.0, 10.0, 17.0, 24.0, 27.1, 60.0)])
    weights = CENTRAL.weights(lateral)
    assert weights[:2] == pytest.approx([1.0, 1.0])
    assert weights[2] > weights[3] > 0.0
    assert weights[4:] == pytest.approx([0.0, 0.0])
    assert mirrored(CENTRAL).weights(lateral * [-1, 1, 1]) == pytest.approx(weights)


@pytest.mark.parametrize("name", ["standard_rig", "paper_rig"])
def test_the_moving_muscles_start_as_strong_as_the_resting_ones_say(name, request):
    rig = request.getfixturevalue(name)
    tissue = assemble(rig.head, rig.parameters, literal_springs=False)
    n, sheet = tissue.node_count, tissue.sheet
    pull = moving_pull(rig.head, tissue, rig.muscles, ring=rig.model.sphincter)
    for row, muscle in enumerate(rig.muscles):
        if isinstance(muscle, LidMuscle | AirPressure):
            continue
        one = Pull(*(part[row : row + 1] for part in pull))
        force = np.zeros_like(tissue.arrays.rest)
        add_muscle_forces(tissue.arrays.rest, one, tissue.arrays.grip, force)
        force[:, 2 * n :] = force.reshape(3, 3, n).sum(axis=1)
        profile = {"profile": rig.model.sphincter} if muscle.kind == "sphincter" else {}
        weight = muscle.weights(sheet.points, **profile) * pull.share[row] * pull.scale[row]
        expected = weight[:, None] * muscle.directions(sheet.points)
        rim = np.zeros(n, bool)
        if muscle.kind == "sphincter":
            rim = np.abs(muscle.radius_at(sheet.points) - 1.0) < 1e-9
        assert force[:, 2 * n :].T[~rim] == pytest.approx(expected[~rim], abs=1e-6)


def test_the_open_jaw_carries_its_muscles_along(paper_rig):
    tissue = assemble(paper_rig.head, paper_rig.parameters, literal_springs=True)
    pull = moving_pull(paper_rig.head, tissue, paper_rig.muscles, ring="literal")
    rides = jaw_rides(paper_rig.head, paper_rig.muscles)
    opened = ride_jaw(pull, rides, paper_rig.jaw, (20.0, 0.0, 0.0))
    for row, muscle in enumerate(paper_rig.muscles):
        before, after = pull.shape[row], opened.shape[row]
        moved = np.linalg.norm(after[:3] - before[:3])
        stem = muscle.name.partition(".")[0]
        if stem in ("mentalis", "depressor_labii_inferioris"):
            assert moved > 30.0
            assert after[6] == pytest.approx(before[6], rel=0.02)
        if stem in ("zygomatic_major", "levator_labii_superioris", "frontalis_medial"):
            assert moved == 0.0
        if stem == "orbicularis_oris":
            assert 10.0 < moved < 30.0
    assert ride_jaw(pull, rides, paper_rig.jaw, (0.0, 0.0, 0.0)).shape == pytest.approx(pull.shape)


def test_nonsense_geometry_is_refused_with_what_was_given():
    with pytest.raises(InvalidValue, match="radius is 5 mm"):
        LinearMuscle("m", (0, 0, 0), (10, 0, 0), 5.0, 30.0, 1.0, 1.0)
    with pytest.raises(InvalidValue, match="angle"):
        LinearMuscle("m", (0, 0, 0), (10, 0, 0), 15.0, 90.0, 1.0, 1.0)
    with pytest.raises(InvalidValue, match="semi_minor"):
        SphincterMuscle("r", (0, 0, 1), (0, 0, 0), (0, 0, 1), 20.0, 0.0, 1.0)


def test_a_belly_lifts_the_skin_over_it_and_not_at_its_ends():
    muscle = LinearMuscle("m.L", (0, 0, 0), (40, 0, 0), 50.0, 30.0, 1.0, 1.0, bulge=0.5)
    points = np.array([[16.0, 0.0, 0.0], [26.0, 0.0, 0.0], [40.0, 0.0, 0.0], [16.0, 20.0, 0.0]])
    normals = np.array([[0.0, 0.6, 0.8]] * 4)
    assert muscle.belly(points) == pytest.approx([1.0, 0.5625, 0.0, 0.0])
    samples = Samples(points, normals, np.zeros(4))
    pressed = press_density(muscle, samples)
    midline = share_of(muscle, points, samples.jaw)
    assert pressed == pytest.approx((0.5 * muscle.belly(points) * midline)[:, None] * normals)
    assert not press_density(replace(muscle, bulge=0.0), samples).any()
    # What pulls does not press, and the pull is the same with a belly or without.
    bare = force_density(replace(muscle, bulge=0.0), samples, ring="ring")
    np.testing.assert_array_equal(force_density(muscle, samples, ring="ring"), bare)


def test_bellies_press_in_both_force_modes(standard_rig):
    """In mode "current" the pull moves with the skin, and only what presses is a basis."""
    head, muscles = standard_rig.head, standard_rig.muscles
    tissue = Simulator(standard_rig).assembly.tissue
    ground = ground_of(head, tissue)
    strength = tissue.parameters.muscle_strength
    whole = rest_basis(ground, muscles, strength=strength, ring="ring")
    flat = [replace(m, bulge=0.0) if hasattr(m, "bulge") else m for m in muscles]
    pulls = rest_basis(ground, flat, strength=strength, ring="ring")
    presses = rest_basis(ground, muscles, strength=strength, ring="ring", pressing_only=True)
    named = {
        muscles[row].name.partition(".")[0] for row in range(len(muscles)) if presses[row].any()
    }
    assert named == {"zygomatic_major", "orbicularis_oculi", "cheek_air", "lip_air"}
    bellied = [row for row, m in enumerate(muscles) if getattr(m, "bulge", 0.0) > 0.0]
    assert len(bellied) == 4
    np.testing.assert_allclose(whole[bellied], (pulls + presses)[bellied], atol=1e-9)


def test_air_presses_along_the_skins_normals_and_fades_at_its_edge():
    air = AirPressure(
        "cheek_air.L", center=(40.0, 0.0, 0.0), extent=(10.0, 20.0, 30.0), force_scale=1.0
    )
    points = np.array([[40.0, 0.0, 0.0], [45.0, 0.0, 0.0], [50.0, 0.0, 0.0], [40.0, 30.0, 0.0]])
    normals = np.array([[0.6, 0.0, 0.8]] * 4)
    assert air.weights(points) == pytest.approx([1.0, 0.5625, 0.0, 0.0])
    samples = Samples(points, normals, np.zeros(4))
    force = press_density(air, samples)
    assert force == pytest.approx(air.weights(points)[:, None] * normals)
    assert not force_density(air, samples, ring="ring").any()
    flip = np.array([-1.0, 1.0, 1.0])
    other = press_density(mirrored(air), Samples(points * flip, normals * flip, np.zeros(4)))
    assert other == pytest.approx(force * flip)
    with pytest.raises(InvalidValue, match="extent"):
        replace(air, extent=(1.0, 0.0, 1.0))
