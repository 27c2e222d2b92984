"""Insight: energies whose gradients are the forces, strains by hand, and what a face shows."""

from __future__ import annotations

import numpy as np
import pytest
from small_tissue import FAT, small_tissue

from engine import (
    Keyframe,
    Model,
    Simulator,
    UnknownName,
    analyze,
    analyze_facs,
    plain_changes,
    unit_basis,
)
from engine.analysis.energy import node_energy
from engine.analysis.measured import opposition, sparse_nnls
from engine.analysis.muscles import MILLINEWTON, muscle_forces
from engine.analysis.strain import Spread, strains_along


def snapshot_of(rig, ticks=60, model=None, **commands):
    simulator = Simulator(rig, model=model)
    simulator.add("a")
    simulator.apply("a", Keyframe(fade=0.1, **commands))
    for _ in range(ticks):
        simulator.step()
    return simulator.snapshot("a")


def shown(analysis):
    """The measured intensities by key."""
    return {
        (f"{u.side}{u.unit[2:]}" if u.side else u.unit): u.measured for u in analysis.seen.units
    }


@pytest.fixture(scope="module")
def basis(standard_rig):
    return unit_basis(standard_rig)


@pytest.mark.parametrize("literal", [False, True])
def test_the_forces_are_minus_the_gradient_of_the_energy(literal):
    patch = small_tissue(FAT, literal=literal)
    arrays, skull = patch.model.arrays, patch.skull
    rng = np.random.default_rng(5)
    x = arrays.rest + rng.normal(0.0, 1.2, arrays.rest.shape)  # Past knee, guard, wall, barrier.

    def energy(places):
        return sum(part.sum() for part in node_energy(places, arrays, skull, skull).values())

    forces = patch.forces(x)
    step = 1e-4
    for node in rng.choice(x.shape[1], 40, replace=False):
        for axis in range(3):
            ahead, behind = x.copy(), x.copy()
            ahead[axis, node] += step
            behind[axis, node] -= step
            slope = (energy(ahead) - energy(behind)) / (2.0 * step)
            assert -slope == pytest.approx(forces[axis, node], rel=2e-4, abs=0.05)


def test_the_energy_is_zero_at_rest_and_falls_back_to_it(standard_rig):
    rest = analyze(snapshot_of(standard_rig, ticks=1))
    smile = analyze(snapshot_of(standard_rig, action_units={"AU12": 1.0}))
    assert sum(rest.energy.values()) == pytest.approx(0.0, abs=1e-6)
    assert sum(smile.energy.values()) > 1e4
    assert sum(smile.region_energy.values()) == pytest.approx(sum(smile.energy.values()))
    assert smile.region_energy["nasolabial"] > 20.0 * abs(smile.region_energy["forehead"])


def test_strain_is_the_change_of_length(patch):
    arrays = patch.model.arrays
    stretched = strains_along(arrays.rest * 1.1, arrays)
    np.testing.assert_allclose(stretched.strain, 0.1)
    assert set(stretched.layer) == {0, 1, 2}
    assert (np.bincount(stretched.layer) == np.bincount(stretched.layer)[0]).all()
    assert Spread.of(np.arange(101.0)) == Spread(50.0, 95.0, 100.0)


def test_a_smile_stretches_its_antagonist_and_shortens_itself(standard_rig):
    analysis = analyze(snapshot_of(standard_rig, action_units={"AU12": 1.0}))
    states = {state.name: state for state in analysis.muscles}
    zygomatic, depressor = states["zygomatic_major.L"], states["depressor_anguli_oris.L"]
    assert 8.0 < zygomatic.contraction < 20.0
    share = zygomatic.contraction / zygomatic.rest_length
    assert zygomatic.contraction_share == pytest.approx(share)
    assert depressor.contraction < -5.0
    assert depressor.force == 0.0 < zygomatic.force
    assert 100.0 < zygomatic.force * MILLINEWTON < 1000.0  # A facial muscle pulls tenths of a N.
    assert states["orbicularis_oculi_preseptal.L"].turn[1] > 0.5
    sides = [states[f"zygomatic_major.{side}"].contraction for side in "LR"]
    assert sides[0] == pytest.approx(sides[1], abs=1e-6)


def test_a_ring_closes_and_an_open_jaw_stretches_what_hangs_on_it(standard_rig):
    pucker = analyze(snapshot_of(standard_rig, action_units={"AU18": 1.0}))
    jaw = analyze(snapshot_of(standard_rig, jaw={"pitch": 20.0}))
    ring = {s.name: s.contraction_share for s in pucker.muscles}["orbicularis_oris"]
    assert ring > 0.05
    opened = {s.name: s.contraction for s in jaw.muscles}
    assert opened["zygomatic_major.L"] < -3.0  # From the cheekbone to the lowered corner.
    assert abs(opened["mentalis.L"]) < 8.0  # Both ends ride the jaw, which moves them 30 mm.


def test_forces_are_those_that_the_simulation_applies(standard_rig):
    for forces in ("rest", "current"):
        model = Model(forces=forces)
        snapshot = snapshot_of(standard_rig, ticks=20, model=model, action_units={"AU12": 0.7})
        found = muscle_forces(snapshot)
        active = {standard_rig.muscle_names[row] for row in np.flatnonzero(found.any(axis=(1, 2)))}
        assert active == {"zygomatic_major.L", "zygomatic_major.R"}


def test_looking_changes_no_bit(standard_rig):
    ends = []
    for look in (False, True):
        simulator = Simulator(standard_rig)
        simulator.add("a")
        simulator.apply("a", Keyframe(action_units={"AU12": 1.0, "AU27": 0.5}))
        for _ in range(10):
            if look:
                simulator.snapshot("a")
            simulator.step()
        ends.append(simulator.frame("a").displacements)
    np.testing.assert_array_equal(*ends)


@pytest.mark.parametrize(
    "units",
    [
        {"AU12": 0.6},
        {"AU1": 0.8, "AU2": 0.8},
        {"L12": 1.0, "R15": 0.8},
        {"AU4": 0.8, "AU7": 0.6, "AU23": 0.8},
        {"R45": 1.0},
    ],
)
def test_what_does_not_fight_is_shown_as_it_was_asked_for(standard_rig, basis, units):
    snapshot = snapshot_of(standard_rig, action_units=units)
    analysis = analyze(snapshot, basis=basis, requested=units)
    found = shown(analysis)
    for key, intensity in units.items():
        assert found.pop(key) == pytest.approx(intensity, abs=0.12)
    assert max(found.values(), default=0.0) < 0.25  # 1 and 2 raise the lid a little, like 5.
    assert analysis.seen.residual < 0.12
    assert analysis.seen.fights == ()


@pytest.mark.parametrize(
    "unit", ["AU1", "AU4", "AU6", "AU9", "AU12", "AU15", "AU17", "AU20", "AU24"]
)
def test_a_unit_is_read_that_nobody_asked_for(standard_rig, basis, unit):
    snapshot = snapshot_of(standard_rig, action_units={unit: 0.6})
    found = shown(analyze(snapshot, basis=basis))
    assert found.pop(unit) == pytest.approx(0.6, abs=0.06)
    assert max(found.values(), default=0.0) < 0.1


@pytest.mark.parametrize("side", ["L", "R"])
def test_a_wink_is_on_one_side(standard_rig, basis, side):
    units = {f"{side}46": 0.8}
    snapshot = snapshot_of(standard_rig, action_units=units)
    found = shown(analyze(snapshot, basis=basis, requested=units))
    assert found == {f"{side}46": pytest.approx(0.8, abs=0.05)}


def test_sparse_least_squares_meet_their_conditions():
    rng = np.random.default_rng(2)
    columns, target = rng.normal(size=(40, 12)), rng.normal(size=40)
    columns[:, 3] = 0.0
    spare = np.full(12, 0.1)
    solution = sparse_nnls(columns, target, spare)
    assert solution.min() == 0.0 == solution[3]
    sizes = np.linalg.norm(columns, axis=0)
    slopes = columns.T @ (columns @ solution - target) + spare * sizes * np.linalg.norm(target)
    np.testing.assert_allclose(slopes[solution > 0.0], 0.0, atol=1e-5)
    assert slopes[(solution == 0.0) & (sizes > 0.0)].min() > -1e-5
    assert (sparse_nnls(columns, target, spare * 4) > 0).sum() < (solution > 0).sum()


def test_15_fights_12_and_both_are_reduced(standard_rig):
    analysis = analyze_facs(standard_rig, "12E+15E")
    found = shown(analysis)
    assert found["AU12"] < 0.95
    assert found["AU15"] < 0.75
    (fight,) = analysis.seen.fights
    assert fight.units == ("AU15", "AU12")
    assert fight.requested == (1.0, 1.0)
    muscles = {frozenset(pair.muscles) for pair in analysis.seen.antagonists}
    assert {"zygomatic_major.L", "depressor_anguli_oris.L"} in muscles


def test_one_lip_is_asked_for_as_half_of_its_unit(standard_rig):
    (one,) = [u for u in analyze_facs(standard_rig, "T24D").seen.units if u.requested > 0.0]
    assert (one.unit, one.side, one.requested) == ("AU24", "", 0.4)


def test_a_palsied_smile_is_seen_on_one_side(standard_rig, basis):
    palsy = {"palsy": {"side": "left", "gain": 0.0}}
    rig = standard_rig.derive(**plain_changes(standard_rig, palsy))
    units = {"AU12": 0.8}
    found = shown(analyze(snapshot_of(rig, action_units=units), basis=basis, requested=units))
    assert found["L12"] < 0.15
    assert found["R12"] == pytest.approx(0.8, abs=0.15)


def test_units_that_look_alike_are_measured_as_the_one_asked_for(standard_rig, basis):
    for asked, other in (("AU43", "AU45"), ("AU45", "AU43")):
        units = {asked: 1.0}
        snapshot = snapshot_of(standard_rig, action_units=units)
        found = shown(analyze(snapshot, basis=basis, requested=units))
        assert found[asked] == pytest.approx(1.0, abs=0.05)
        assert other not in found


def test_a_unit_that_the_rig_does_not_have_is_refused(standard_rig, basis):
    with pytest.raises(UnknownName, match="action unit"):
        analyze(snapshot_of(standard_rig, ticks=1), basis=basis, requested={"AU99": 1.0})


def test_fields_that_meet_head_on_are_wholly_opposed():
    one = np.tile([0.0, 1.0, 0.0], (5, 1))
    weights = np.ones(5)
    assert opposition(one, -one, weights) == 1.0
    assert opposition(one, one, weights) == 0.0
    apart = one.copy()
    apart[:, [0, 1]] = apart[:, [1, 0]]
    assert opposition(one, apart, weights) == 0.0


def test_an_analysis_is_plain_data(standard_rig):
    import json

    data = analyze_facs(standard_rig, "6B+12C").to_json()
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert set(data["layers"]) == {"epidermis", "dermis", "hypodermis"}
    assert len(data["muscles"]) == len(standard_rig.muscles)
