"""Faces: the same bits alone, in a batch and in a replay; sleep, divergence, live edits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import InvalidValue, Keyframe, Model, Simulator, UnknownName, builtin_rig
from engine.measure import settle
from engine.mixing import Mixer

SMILE = Keyframe(action_units={"AU12": 1.0, "AU6": 0.6}, fade=0.1)
SHOCK = Keyframe(action_units={"AU1": 1.0, "AU26": 0.7}, layer="emotion", hold=0.1, fade_out=0.1)


@pytest.fixture(params=["rk2", "verlet"])
def model(request, standard_rig):
    """A face stepped alone, and one stepped in a bank."""
    return Model.for_rig(standard_rig, integrator=request.param)


def play(rig, ticks, model, *, others=0, threads=1):
    """Return a face's displacements at every tick, with `others` beside it."""
    simulator = Simulator(rig, model=model, threads=threads)
    for other in range(others):
        simulator.add(f"other {other}")
        simulator.apply(f"other {other}", Keyframe(action_units={"AU4": 0.05 * other}))
    simulator.add("face")
    frames = []
    for tick in range(ticks):
        if tick == 2:
            simulator.apply("face", SMILE)
        if tick == 9:
            simulator.apply("face", SHOCK)
        simulator.step()
        frames.append(simulator.frame("face").displacements)
    return np.array(frames)


def test_a_face_moves_the_same_alone_in_a_batch_and_on_threads(standard_rig, model):
    alone = play(standard_rig, 24, model)
    assert np.abs(alone[-1]).max() > 3.0
    assert np.array_equal(alone, play(standard_rig, 24, model, others=3))
    assert np.array_equal(alone, play(standard_rig, 24, model, others=20, threads=2))


def test_a_command_says_when_it_takes_effect(standard_rig, model):
    simulator = Simulator(standard_rig, model=model)
    simulator.add("a")
    for _ in range(3):
        simulator.step()
    assert simulator.apply("a", SMILE) == 3
    before = simulator.frame("a").displacements
    after = simulator.step()["a"]
    assert after.tick == 4
    assert np.abs(after.displacements - before).max() >= 0.0


def test_a_face_without_commands_falls_asleep_and_costs_nothing(standard_rig, model):
    simulator = Simulator(standard_rig, model=model)
    simulator.add("a")
    frames = [simulator.step() for _ in range(60)]
    last = max(i for i, frame in enumerate(frames) if frame)
    assert frames[last]["a"].asleep
    assert last < 30
    assert not any(frames[last + 1 :])
    assert simulator.frame("a").tick == 60


def test_a_sleeping_face_wakes_on_a_command_and_when_its_hold_is_over(standard_rig, model):
    simulator = Simulator(standard_rig, model=model)
    simulator.add("a")
    simulator.apply("a", Keyframe(emotion=("happiness", 0.7), layer="emotion", hold=2.0))
    asleep = [not simulator.step() for _ in range(120)]
    assert any(asleep)
    assert not all(asleep[-10:]) or asleep[-1]
    for _ in range(150):
        simulator.step()
    assert np.abs(simulator.frame("a").displacements).max() < 0.05


def test_still_faces_are_still_before_they_sleep(standard_rig, model):
    simulator = Simulator(standard_rig, model=model)
    simulator.add("a")
    simulator.apply("a", SMILE)
    previous = None
    for _ in range(120):
        frame = simulator.step().get("a")
        if frame is None:
            break
        if previous is not None and frame.asleep:
            assert np.abs(frame.displacements - previous).max() < 0.01
        previous = frame.displacements
    else:
        pytest.fail("the face did not fall asleep within two seconds")


def test_a_diverging_face_is_put_back_to_rest_and_says_so(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.add("b")
    simulator.apply("a", SMILE)
    simulator.apply("b", SMILE)
    simulator.step()
    simulator._faces["a"].v[0, 100] = np.nan
    frames = simulator.step()
    assert frames["a"].diverged
    assert not frames["b"].diverged
    assert not frames["a"].displacements.any()
    assert np.isfinite(frames["b"].displacements).all()
    assert not simulator.step()["a"].diverged


def test_a_face_moves_to_a_derived_rig_without_a_jump(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.apply("a", SMILE)
    for _ in range(40):
        simulator.step()
    before = simulator.frame("a").displacements
    stiffer = standard_rig.derive(tissue={"stiffness_low": {"epidermis": 60.0}})
    assert stiffer.id != standard_rig.id
    edited = Simulator(stiffer)
    edited.add("a", state=simulator.remove("a"))
    assert "a" not in simulator.faces
    assert np.array_equal(edited.frame("a").displacements, before)
    first = edited.step()["a"].displacements
    assert np.abs(first - before).max() < 0.5
    for _ in range(60):
        edited.step()
    assert np.abs(edited.frame("a").displacements - before).max() > 0.2
    assert edited.report("a")["layers"]["puppet"]["action_units"] == SMILE.action_units


def test_mirrored_commands_give_mirrored_faces(standard_rig):
    left, right = Simulator(standard_rig), Simulator(standard_rig)
    left.add("a")
    right.add("a")
    left.apply("a", Keyframe(muscles={"zygomatic_major.L": 0.2, "frontalis_lateral.L": 0.2}))
    right.apply("a", Keyframe(muscles={"zygomatic_major.R": 0.2, "frontalis_lateral.R": 0.2}))
    for _ in range(10):
        left.step()
        right.step()
    mirror = standard_rig.head.mirror
    one = left.frame("a").displacements
    other = right.frame("a").displacements[mirror] * [-1.0, 1.0, 1.0]
    assert np.abs(one).max() > 0.1
    assert np.abs(one - other).max() < 1e-6


def test_mirrored_activations_give_mirrored_forces(standard_rig):
    basis = Simulator(standard_rig).assembly.basis
    names = list(standard_rig.muscle_names)
    n = standard_rig.head.sheet_count
    mirror = standard_rig.head.mirror[:n]
    for index, name in enumerate(names):
        stem, _, side = name.partition(".")
        twin = names.index(f"{stem}.{'R' if side == 'L' else 'L'}") if side else index
        mirrored = basis[twin][:, mirror] * np.array([[-1.0], [1.0], [1.0]])
        assert np.abs(basis[index] - mirrored).max() <= 1e-9 * max(np.abs(basis[index]).max(), 1.0)


def test_the_two_force_modes_agree_at_rest_and_part_as_the_skin_moves(standard_rig):
    faces = {
        forces: settle(
            standard_rig,
            [Keyframe(action_units={"AU12": 1.0})],
            seconds=0.5,
            model=Model.for_rig(standard_rig, forces=forces),
        )[0].u("M1_5.L")
        for forces in ("rest", "current")
    }
    for moved in faces.values():
        assert moved[0] > 0
        assert moved[1] > 2
    assert 0.1 < np.linalg.norm(faces["rest"] - faces["current"]) < 10.5


@pytest.mark.parametrize("integrator", ["heun", "symplectic_euler", "rk4", "verlet"])
def test_every_integrator_finds_the_same_face(standard_rig, integrator):
    smile = [Keyframe(action_units={"AU12": 0.6})]
    model = Model.for_rig(standard_rig, integrator=integrator)
    here = settle(standard_rig, smile, model=model)[0].displacements
    assert here == pytest.approx(settle(standard_rig, smile)[0].displacements, abs=0.05)


def test_fewer_substeps_than_stability_asks_for_are_refused(standard_rig):
    with pytest.raises(InvalidValue, match="needs at least"):
        Simulator(standard_rig, substeps=4)


def test_names_are_checked_with_what_is_known(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    with pytest.raises(InvalidValue, match="already"):
        simulator.add("a")
    with pytest.raises(UnknownName, match="face"):
        simulator.apply("b", SMILE)
    with pytest.raises(UnknownName, match="AU99"):
        simulator.apply("a", Keyframe(action_units={"AU99": 1.0}))
    with pytest.raises(InvalidValue, match=r"AU12 is 1\.5"):
        simulator.apply("a", Keyframe(action_units={"AU12": 1.5}))
    with pytest.raises(InvalidValue, match="finite"):
        simulator.apply("a", Keyframe(jaw={"pitch": float("nan")}))


def test_eyes_and_head_follow_with_their_own_inertia(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.apply("a", Keyframe(gaze={"yaw": 10.0}, head={"pitch": -5.0}))
    frame = simulator.step()["a"]
    assert 5.0 < frame.pose.gaze_left[0] < 10.0
    assert -2.0 < frame.pose.head[1] < 0.0
    for _ in range(120):
        simulator.step()
    assert simulator.frame("a").pose.gaze_right == (10.0, 0.0)
    assert simulator.frame("a").pose.head == (0.0, -5.0, 0.0)


def test_sleepers_are_not_looked_at_until_their_hold_is_over(standard_rig, model, monkeypatch):
    simulator = Simulator(standard_rig, model=model)
    for name in range(5):
        simulator.add(str(name))
    smile = Keyframe(action_units={"AU12": 0.5}, hold=1.5, fade=0.1, fade_out=0.1)
    simulator.apply("3", smile)
    while simulator.step():
        pass
    slept = simulator._clock
    looked = []
    due = Mixer.due
    monkeypatch.setattr(Mixer, "due", lambda mixer, tick: looked.append(tick) or due(mixer, tick))
    ticks = 0
    while not simulator.step():
        ticks += 1
    assert 0 < ticks < 90 - slept + 20
    assert len(looked) == 1
    assert list(simulator.step()) == ["3"]
    assert {simulator.frame(name).tick for name in simulator.faces} == {simulator._clock}
    simulator.remove("3")
    for _ in range(3):
        assert simulator.step() == {}


@pytest.mark.parametrize(("person", "unit"), [("kwame", "AU28"), ("omar", "AU28")])
@pytest.mark.parametrize("integrator", ["rk2", "verlet"])
def test_lips_held_between_contacts_fall_asleep(person, unit, integrator):
    """They have a velocity that lips and teeth take away every substep, and do not move."""
    rig = builtin_rig(person)
    simulator = Simulator(rig, model=Model.for_rig(rig, integrator=integrator))
    simulator.add("a")
    simulator.apply("a", Keyframe(action_units={unit: 1.0}))
    for _ in range(120):
        simulator.step()
    assert simulator.frame("a").asleep


def stepped(simulator, monkeypatch):
    """Return a list that tells how many faces' tissue is stepped in each tick from now on."""
    counts = []
    step = simulator._stepper.step
    watched = lambda faces, pool: counts.append(len(faces)) or step(faces, pool)  # noqa: E731
    monkeypatch.setattr(simulator._stepper, "step", watched)
    return counts


def test_tissue_rests_while_eyes_and_head_go_on(standard_rig, model, monkeypatch):
    simulator = Simulator(standard_rig, model=model)
    simulator.add("a")
    counts = stepped(simulator, monkeypatch)
    simulator.apply("a", Keyframe(head={"yaw": 20.0}, gaze={"yaw": -5.0}, fade=2.0))
    frames = [simulator.step()["a"] for _ in range(90)]
    assert sum(counts) <= 25
    yaws = [frame.pose.head[0] for frame in frames]
    assert yaws == sorted(yaws)
    assert yaws[-1] > 12.0
    assert not any(frame.asleep for frame in frames)
    # What moves the tissue wakes it: the lids go with the gaze, up and down.
    simulator.apply("a", Keyframe(gaze={"pitch": -10.0}))
    simulator.step()
    assert counts[-1] == 1
    for _ in range(10):
        simulator.step()
    assert np.abs(simulator.frame("a").displacements).max() > 1.0


def test_a_face_whose_tissue_rested_moves_the_same_alone_and_in_a_batch(standard_rig, model):
    def played(others):
        simulator = Simulator(standard_rig, model=model, threads=1)
        for other in range(others):
            simulator.add(f"other {other}")
            simulator.apply(f"other {other}", Keyframe(action_units={"AU4": 0.3}))
        simulator.add("face")
        simulator.apply("face", Keyframe(head={"yaw": 5.0}, fade=3.0))
        for _ in range(50):
            simulator.step()
        simulator.apply("face", SMILE)
        for _ in range(8):
            simulator.step()
        return simulator.frame("face")

    alone, beside = played(0), played(2)
    assert np.abs(alone.displacements).max() > 1.0
    assert np.array_equal(alone.displacements, beside.displacements)
    assert alone.pose == beside.pose


def test_tissue_that_rests_wakes_on_another_rig(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.apply("a", SMILE)
    simulator.apply("a", Keyframe(head={"yaw": 5.0}, fade=30.0))
    for _ in range(120):
        simulator.step()
    before = simulator.frame("a").displacements
    stiffer = standard_rig.derive(tissue={"stiffness_low": {"epidermis": 60.0}})
    edited = Simulator(stiffer)
    edited.add("a", state=simulator.remove("a"))
    for _ in range(40):
        edited.step()
    assert np.abs(edited.frame("a").displacements - before).max() > 0.1
