"""Faces in banks: what one alone does, bit for bit whoever sits beside it, and in float64."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from engine import FaceState, Keyframe, Model, Simulator, builtin_rig
from engine.alone import Alone
from engine.dynamics import scratch_for, static_forces
from engine.flesh import random_mixes
from engine.lanes import WIDTH
from engine.lanes.network import arrange, order_columns
from engine.lanes.sweep import Faces, sweep
from engine.lanes.vector import aligned
from engine.tissue import no_pull

LOOKING = {"yaw": 12.0, "pitch": -9.0}
WIDE = Keyframe(action_units={"AU26": 0.9, "AU12": 0.7, "AU45": 1.0}, gaze=LOOKING)


@pytest.fixture
def live(standard_rig):
    return Model.for_rig(standard_rig, integrator="verlet")


def in_a_bank(rig, live, keyframes):
    """Return a simulator with a face for each keyframe, called "0", "1" …."""
    simulator = Simulator(rig, model=live, threads=1)
    for name, keyframe in enumerate(keyframes):
        simulator.add(str(name))
        simulator.apply(str(name), keyframe)
    return simulator


def one_by_one(rig, live, keyframes):
    """Return the same, stepped in float64 by the reference kernels."""
    simulator = in_a_bank(rig, live, keyframes)
    simulator._stepper = Alone(simulator.assembly, farthest=90.0)
    return simulator


def test_a_bank_moves_faces_as_the_reference_does(standard_rig, live):
    """Jaw, lids, gaze, contact, every force: the same motion but for float32's grain."""
    keyframes = [WIDE, *random_mixes(standard_rig, 5, 3), Keyframe(action_units={"AU28": 1.0})]
    fast = in_a_bank(standard_rig, live, keyframes)
    reference = one_by_one(standard_rig, live, keyframes)
    for _ in range(40):
        fast.step()
        reference.step()
        for name in fast.faces:
            here, there = fast.frame(name), reference.frame(name)
            assert here.displacements == pytest.approx(there.displacements, abs=0.01)
            assert here.pose == there.pose
            assert np.array_equal(here.activations, there.activations)


def test_a_bank_takes_the_reference_forces(standard_rig, live):
    """From rest one short step shows every node's acceleration: f/m of the same positions."""
    simulator = in_a_bank(standard_rig, live, [WIDE])
    for _ in range(12):
        simulator.step()
    before = simulator.snapshot("0")
    tissue = before.assembly.tissue.arrays
    rng = np.random.default_rng(5)
    x = before.x + rng.normal(scale=0.05, size=before.x.shape)
    force = np.zeros_like(x)
    n = before.assembly.tissue.node_count
    static_forces(x, tissue, before.skull, no_pull(n), scratch_for(tissue), force)

    order = order_columns(tissue)
    net = arrange(tissue, order)

    def lanes(values, places):
        flat = aligned(3 * WIDTH * len(places))
        flat.reshape(-1, 3, WIDTH)[places] = values.T[:, :, None]
        return flat

    load = lanes(before.skull.load, order.nodes)
    faces = Faces(
        x=lanes(x, order.nodes),
        v=aligned(load.size),
        force=load.copy(),
        load=load,
        target=lanes(before.skull.targets, order.places),
        travel=aligned(3 * WIDTH * n),
        normal=lanes(before.skull.normals, order.places),
        bone=lanes(before.skull.bone, order.places),
        places=aligned(WIDTH),
    )

    @numba.njit
    def once(faces, net):
        sweep(faces, net, np.float32(0.0), np.float32(1.0), np.float32(1.0), np.float32(0.0))

    once(faces, net)
    got = faces.v.reshape(-1, 3, WIDTH)[order.nodes]
    assert all(np.array_equal(got[:, :, 0], got[:, :, lane]) for lane in range(WIDTH))
    want = (force * tissue.inverse_mass).T
    assert np.abs(got[:, :, 3] - want).max() < 5e-5 * np.abs(want).max()


def test_who_sits_beside_a_face_does_not_touch_its_bits(standard_rig, live):
    """Others come, go, sleep, move up from other banks: the face's every frame is the same."""

    def frames(others):
        simulator = Simulator(standard_rig, model=live, threads=1)
        for name in range(others):
            simulator.add(f"other {name}")
            simulator.apply(f"other {name}", Keyframe(action_units={"AU4": 0.05 * (name % 20)}))
        simulator.add("face")
        simulator.apply("face", WIDE)
        seen = []
        for tick in range(30):
            if tick == 8:
                for name in range(0, others, 2):
                    simulator.remove(f"other {name}")
            if tick == 15 and others:
                simulator.add("late")
                simulator.apply("late", Keyframe(action_units={"AU27": 1.0}))
            if tick == 20:
                simulator.apply("face", Keyframe(emotion=("anger", 1.0), replace=True))
            simulator.step()
            seen.append(simulator.frame("face").displacements)
        return np.array(seen)

    alone = frames(0)
    assert np.abs(alone).max() > 8.0
    for others in (3, WIDTH, 2 * WIDTH + 3):
        assert np.array_equal(frames(others), alone)


def test_a_sleeping_face_gives_up_its_seat_and_wakes_where_it_was(standard_rig, live):
    simulator = in_a_bank(standard_rig, live, [Keyframe(action_units={"AU12": 0.8})])
    while simulator.step():
        pass
    state = simulator._faces["0"]
    assert state.asleep
    assert state.seat is None
    lying = simulator.frame("0").displacements
    simulator.apply("0", Keyframe(action_units={"AU12": 0.8, "AU1": 0.1}))
    woken = simulator.step()["0"]
    assert state.seat is not None
    assert np.abs(woken.displacements - lying).max() < 0.05


def test_a_face_that_diverges_leaves_its_neighbours_alone(standard_rig, live):
    simulator = in_a_bank(standard_rig, live, [WIDE, WIDE])
    undisturbed = in_a_bank(standard_rig, live, [WIDE])
    simulator.step()
    undisturbed.step()
    bank, lane = simulator._faces["0"].seat
    bank.faces.v.reshape(-1, WIDTH)[300, lane] = np.nan
    frames, expected = simulator.step(), undisturbed.step()["0"]
    assert frames["0"].diverged
    assert not frames["0"].displacements.any()
    assert np.array_equal(frames["1"].displacements, expected.displacements)
    assert not simulator.step()["0"].diverged


def test_a_face_keeps_its_place_between_simulators_and_banks(standard_rig, live):
    simulator = in_a_bank(standard_rig, live, [WIDE])
    for _ in range(10):
        simulator.step()
    simulator.branch("0", "twin")
    there = simulator.frame("0").displacements
    snapshot = simulator.snapshot("0")
    n = snapshot.assembly.tissue.node_count
    rest = snapshot.assembly.tissue.arrays.rest
    assert (snapshot.x - rest)[:, :n].T == pytest.approx(there[:n], abs=1e-4)
    other = Simulator(standard_rig, model=Model.for_rig(standard_rig), threads=1)
    state = simulator.remove("0")
    assert isinstance(state, FaceState)
    other.add("0", state=state)
    assert other.frame("0").displacements == pytest.approx(there, abs=1e-4)
    went = other.step()["0"].displacements
    stayed = simulator.step()["twin"].displacements
    assert went == pytest.approx(stayed, abs=0.1)


def test_what_the_kernel_lacks_is_stepped_alone(standard_rig, live):
    simulator = Simulator(standard_rig, model=live)
    assert not isinstance(simulator._stepper, Alone)
    for other in (
        Simulator(standard_rig, model=Model.for_rig(standard_rig, integrator="rk2")),
        Simulator(
            standard_rig, model=Model.for_rig(standard_rig, integrator="verlet", forces="current")
        ),
        Simulator(standard_rig.derive(tissue={"plate": 20.0}), model=live),
    ):
        assert isinstance(other._stepper, Alone)


def test_a_rig_whose_lips_would_buzz_takes_shorter_steps(standard_rig, live):
    """Mei's tightened lips are stiffer than masses are made for, the built-in head's are not."""
    assert Simulator(standard_rig, model=live).assembly.substeps == 7
    mei = builtin_rig("mei")
    simulator = in_a_bank(mei, live, [Keyframe(action_units={"AU23": 1.0})])
    assert simulator.assembly.substeps > 7
    for _ in range(90):
        simulator.step()
    assert simulator.frame("0").asleep


def test_a_bank_whose_faces_fit_elsewhere_empties_a_few_a_tick(standard_rig, live):
    """Half of two banks' faces go: the others move together, and none waits for all of them."""
    units = Keyframe(action_units={"AU12": 0.8}, fade=2.0)
    simulator = in_a_bank(standard_rig, live, [units] * (2 * WIDTH))

    def banks():
        held = {name: simulator._faces[name].seat[0] for name in simulator.faces}
        return held, len(set(map(id, held.values())))

    simulator.step()
    for name in range(0, 2 * WIDTH, 2):
        simulator.remove(str(name))
    before, moves = banks()[0], []
    while banks()[1] > 1:
        simulator.step()
        after = banks()[0]
        moves.append(sum(after[name] is not before[name] for name in after))
        before = after
    assert sum(moves) == WIDTH // 2
    assert max(moves) <= 4
    # Who comes next is given the bank that was emptied, not another one.
    emptied = simulator._stepper._spare
    simulator.add("next")
    simulator.step()
    assert simulator._faces["next"].seat[0] is emptied
