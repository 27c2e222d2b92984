"""Equations 19-22: forces against a slow twin, conservation, and the integrators' order."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import twin
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from small_tissue import FAT, SmallTissue, small_tissue

from engine.dynamics import TABLEAUS, resolve_teeth
from engine.tissue import PAPER_PARAMETERS, Layered, assemble


def shaken(tissue: SmallTissue, seed: int, size: float) -> np.ndarray:
    """Return the patch's nodes, each moved by up to `size` mm."""
    rng = np.random.default_rng(seed)
    rest = tissue.model.arrays.rest
    return rest + rng.uniform(-size, size, rest.shape)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), size=st.floats(0.01, 4.0))
def test_forces_agree_with_the_slow_twin(patch, seed, size):
    x = shaken(patch, seed, size)
    expected = twin.forces(x, patch.model.arrays, patch.skull)
    scale = np.abs(expected).max()
    assert patch.forces(x) == pytest.approx(expected, abs=1e-6 * scale)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10_000), size=st.floats(0.01, 4.0))
def test_the_literal_springs_agree_with_the_slow_twin(seed, size):
    tissue = small_tissue(PAPER_PARAMETERS, literal=True)
    x = shaken(tissue, seed, size)
    expected = twin.forces(x, tissue.model.arrays, tissue.skull)
    assert tissue.forces(x) == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_forces_are_minus_the_gradient_of_the_energy(patch):
    x = shaken(patch, 3, 1.5)
    force = patch.forces(x)
    rng = np.random.default_rng(4)
    for _ in range(5):
        way = rng.normal(size=x.shape)
        step = 1e-5
        ahead = twin.energy(x + step * way, patch.model.arrays, patch.skull)
        back = twin.energy(x - step * way, patch.model.arrays, patch.skull)
        assert -(ahead - back) / (2 * step) == pytest.approx((force * way).sum(), rel=1e-5)


def test_one_spring_by_hand():
    # d0 = 10, k_L = 2, k_H = 5, ε_c = 0.1. Stretched to 12: 2·2 + 3·(2 - 1) = 7 continuous,
    # 5·2 = 10 literal; to 10.5: 1 in both. Compressed to 8 with guard 4 beyond 5 %: -4 - 4·1.5.
    def tension(length: float, *, literal: bool) -> float:
        from engine.dynamics import Springs, add_spring_forces

        one = np.array([0], np.int32), np.array([1], np.int32)
        springs = Springs(
            *one,
            np.array([10.0]),
            np.array([2.0]),
            np.array([5.0]),
            np.array([4.0]),
            0.1,
            0.05,
            literal,
        )
        x = np.array([[0.0, length], [0.0, 0.0], [0.0, 0.0]])
        force = np.zeros_like(x)
        add_spring_forces(x, springs, np.zeros((3, 1)), force)
        assert force[0, 1] == -force[0, 0]
        return float(force[0, 0])

    assert tension(10.5, literal=False) == pytest.approx(1.0)
    assert tension(10.5, literal=True) == pytest.approx(1.0)
    assert tension(12.0, literal=False) == pytest.approx(7.0)
    assert tension(12.0, literal=True) == pytest.approx(10.0)
    assert tension(8.0, literal=False) == pytest.approx(-10.0)


def test_a_free_patch_has_no_net_force_or_torque():
    # The columns stand on bone: springs and elements alone.
    tissue = small_tissue(replace(FAT, fat_pressure=0.0), anchored=False)
    x = shaken(tissue, 7, 2.0)
    force = tissue.forces(x)
    scale = np.abs(force).max()
    assert np.abs(force.sum(axis=1)).max() < 1e-11 * scale
    assert np.abs(np.cross(x.T, force.T).sum(axis=0)).max() < 1e-9 * scale * np.abs(x).max()


def test_rest_stays_at_rest(patch):
    rest = patch.model.arrays.rest
    x, v = patch.run(rest, np.zeros_like(rest), 600, 1e-3, TABLEAUS["rk2"])
    assert np.abs(x - rest).max() < 1e-9
    assert np.abs(v).max() < 1e-9


def test_damping_only_loses_energy(patch):
    arrays = patch.model.arrays
    free = arrays.inverse_mass > 0.0
    mass = np.where(free, 1.0 / np.maximum(arrays.inverse_mass, 1e-30), 0.0)
    x = arrays.rest + (shaken(patch, 11, 0.8) - arrays.rest) * free
    v = np.zeros_like(x)
    last = math.inf
    for _ in range(200):
        total = twin.energy(x, arrays, patch.skull) + 0.5 * (mass * v**2).sum()
        assert total < last + 1e-6 * abs(last if math.isfinite(last) else 0.0)
        last = total
        x, v = patch.run(x, v, 1, 2e-4, TABLEAUS["rk4"])


def pull_of(tissue: SmallTissue, size: float) -> np.ndarray:
    """Return a smooth sideways load on the hypodermis of the patch's middle."""
    arrays, n = tissue.model.arrays, tissue.model.node_count
    load = np.zeros_like(arrays.rest)
    distance = np.hypot(arrays.rest[0, :n], arrays.rest[1, :n])
    load[0, 2 * n :] = size * np.exp(-((distance / 12.0) ** 2))
    return load


# The biphasic law bends at its knees, which fourth order feels: its load stays below them.
@pytest.mark.parametrize(
    ("name", "order", "load"),
    [
        ("rk2", 2.0, 300.0),
        ("heun", 2.0, 300.0),
        ("rk4", 4.0, 3.0),
        ("symplectic_euler", 1.0, 300.0),
        ("verlet", 2.0, 300.0),
    ],
)
def test_integrators_have_their_order(patch, name, order, load):
    loaded = patch.loaded(pull_of(patch, load))
    rest = patch.model.arrays.rest
    exact = reference(loaded, 0.03)
    errors = []
    for steps in (30, 60, 120):
        x, _ = loaded.run(rest, np.zeros_like(rest), steps, 0.03 / steps, TABLEAUS[name])
        errors.append(np.abs(x - exact).max())
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders[-1] == pytest.approx(order, abs=0.35)


def reference(tissue: SmallTissue, seconds: float) -> np.ndarray:
    """Return positions from SciPy's DOP853 at tight tolerance: an integrator not of our own."""
    arrays = tissue.model.arrays
    shape = arrays.rest.shape

    def slope(_: float, state: np.ndarray) -> np.ndarray:
        x, v = state.reshape(2, *shape)
        a = tissue.forces(np.ascontiguousarray(x)) * arrays.inverse_mass - arrays.damping * v
        return np.concatenate(
            [(v * (arrays.inverse_mass > 0)).ravel(), (a * (arrays.inverse_mass > 0)).ravel()]
        )

    start = np.concatenate([arrays.rest.ravel(), np.zeros(arrays.rest.size)])
    result = solve_ivp(slope, (0.0, seconds), start, method="DOP853", rtol=1e-11, atol=1e-11)
    return np.asarray(result.y[: arrays.rest.size, -1].reshape(shape))


def test_literal_springs_cost_the_order_that_the_continuous_ones_keep():
    def order(literal: bool) -> float:
        parameters = replace(PAPER_PARAMETERS, strain_threshold=0.02)
        tissue = small_tissue(parameters, literal=literal)
        tissue = tissue.loaded(pull_of(tissue, 900.0))
        rest = tissue.model.arrays.rest
        fine, _ = tissue.run(rest, np.zeros_like(rest), 4096, 0.05 / 4096, TABLEAUS["rk4"])
        errors = []
        for steps in (64, 128, 256):
            x, _ = tissue.run(rest, np.zeros_like(rest), steps, 0.05 / steps, TABLEAUS["rk2"])
            errors.append(np.abs(x - fine).max())
        return float(np.log2(errors[0] / errors[-1]) / 2.0)

    assert order(False) > 1.7
    assert order(True) < 1.5


def test_a_dynamic_equilibrium_is_a_root_of_the_static_forces(patch):
    loaded = patch.loaded(pull_of(patch, 900.0))
    rest = patch.model.arrays.rest
    x, v = loaded.run(rest, np.zeros_like(rest), 6000, 1e-3, TABLEAUS["rk2"])
    free = patch.model.arrays.inverse_mass > 0.0
    assert np.abs(v).max() < 1e-9
    assert np.abs(x - rest).max() > 0.5
    assert np.abs(loaded.forces(x)[:, free]).max() < 1e-6


def test_stiffness_below_the_knee_is_low_and_above_it_high():
    soft = small_tissue(replace(PAPER_PARAMETERS, stiffness_high=Layered(100.0, 40.0, 80.0)))
    hard = small_tissue(replace(PAPER_PARAMETERS, stiffness_high=Layered(400.0, 160.0, 320.0)))
    small, large = pull_of(soft, 20.0), pull_of(soft, 9000.0)

    def far(tissue: SmallTissue, load: np.ndarray) -> float:
        rest = tissue.model.arrays.rest
        x, _ = tissue.loaded(load).run(rest, np.zeros_like(rest), 4000, 5e-4, TABLEAUS["rk2"])
        return float(np.abs(x - rest).max())

    assert far(hard, small) == pytest.approx(far(soft, small), rel=1e-3)
    assert far(hard, large) < 0.9 * far(soft, large)


def test_contact_with_the_teeth_reads_no_arch_where_there_is_none(standard_rig):
    arrays = assemble(standard_rig.head, standard_rig.parameters, literal_springs=False).arrays
    contacts = arrays.contacts
    for place in (math.nan, math.inf, 1.0e30, len(contacts.arch) - 1.0):
        x, v = arrays.rest.copy(), np.zeros_like(arrays.rest)
        x[0, contacts.tooth_nodes] = place
        before = x.copy()
        resolve_teeth(x, v, contacts)
        assert np.array_equal(x, before, equal_nan=True)
        assert not v.any()
