"""What a face is asked to do: sides, fades, holds and layers, and an honest report of them."""

from __future__ import annotations

import numpy as np
import pytest

from engine import LONGEST_ONSET, Keyframe, Rig, Simulator
from engine.mixing import Mixer
from engine.simulator import STILL_TICKS


def units_of(mixer: Mixer, tick: int = 0, layer: str = "puppet") -> dict[str, float]:
    """Return the units a layer holds."""
    layers = mixer.report(tick)["layers"]
    assert isinstance(layers, dict)
    return dict(layers[layer]["action_units"]) if layer in layers else {}


def held_after(rig: Rig, *commands: dict[str, float]) -> dict[str, float]:
    """Return what the puppet layer holds after one command after another."""
    mixer = Mixer(rig)
    for command in commands:
        mixer.apply(Keyframe(action_units=command), 0)
    return units_of(mixer)


@pytest.mark.parametrize(
    ("commands", "held"),
    [
        (({"L12": 0.5}, {"AU12": 1.0}), {"AU12": 1.0}),
        (({"L12": 0.5, "R12": 0.2}, {"AU12": 0.0}), {}),
        (({"AU12": 1.0}, {"L12": 0.5}), {"L12": 0.5, "R12": 1.0}),
        (({"AU12": 1.0}, {"L12": 0.0}), {"R12": 1.0}),
        (({"L12": 0.5, "AU12": 1.0},), {"L12": 0.5, "R12": 1.0}),
        (({"AU12": 1.0}, {"12": 0.5}), {"AU12": 0.5}),
        (({"12": 0.5}, {"au12": 0.0}), {}),
        (({"L12": 0.5}, {"LAU12": 0.0}), {}),
    ],
)
def test_a_unit_is_held_once_whatever_it_is_called(standard_rig, commands, held):
    assert held_after(standard_rig, *commands) == held


def test_a_side_is_not_added_to_both(standard_rig):
    mixer = Mixer(standard_rig)
    mixer.apply(Keyframe(action_units={"AU12": 1.0}), 0)
    mixer.apply(Keyframe(action_units={"L12": 0.5}), 0)
    merged = mixer.at(1)
    left = merged[standard_rig.muscle_names.index("zygomatic_major.L")]
    right = merged[standard_rig.muscle_names.index("zygomatic_major.R")]
    full = standard_rig.contraction({"AU12": 1.0})
    assert right == full[standard_rig.muscle_names.index("zygomatic_major.R")]
    assert left == pytest.approx(
        standard_rig.contraction({"L12": 0.5})[standard_rig.muscle_names.index("zygomatic_major.L")]
    )


def test_an_expired_layer_does_not_come_back_with_the_next_command(standard_rig):
    mixer = Mixer(standard_rig)
    mixer.apply(Keyframe(action_units={"AU12": 1.0}, hold=0.5), 0)
    mixer.apply(Keyframe(action_units={"AU1": 1.0}), 30)
    assert units_of(mixer, 30) == {"AU1": 1.0}


def test_asking_a_sleeping_face_what_it_holds_does_not_keep_it_asleep(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.apply("a", Keyframe(action_units={"AU12": 1.0}, hold=2.0, fade_out=0.2))
    for _ in range(120):
        simulator.step()
    assert simulator.frame("a").asleep
    assert simulator.report("a")["layers"] == {}
    for _ in range(90):
        simulator.step()
    assert np.abs(simulator.frame("a").displacements).max() < 0.05


def test_a_long_fade_that_is_overtaken_keeps_no_face_awake(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("a")
    simulator.apply("a", Keyframe(action_units={"AU5": 1.0}, fade=60.0))
    simulator.step()
    simulator.apply("a", Keyframe(replace=True))
    for _ in range(60 + STILL_TICKS):
        simulator.step()
    assert simulator.frame("a").asleep


def test_the_merged_report_weighs_layers_and_tells_sides(standard_rig):
    mixer = Mixer(standard_rig)
    mixer.apply(Keyframe(action_units={"AU12": 0.4, "AU1": 1.0}, layer="emotion"), 0)
    mixer.apply(Keyframe(action_units={"AU12": 0.8}, layer="speech", weight=0.5), 0)
    mixer.apply(Keyframe(action_units={"L1": 0.2}), 0)
    merged = mixer.report(1)["merged"]
    assert isinstance(merged, dict)
    assert merged["action_units"] == pytest.approx({"AU12": 0.6, "L1": 0.2, "R1": 1.0})


def test_the_merged_report_has_no_noise_of_arithmetic(standard_rig):
    mixer = Mixer(standard_rig)
    mixer.apply(Keyframe(action_units={"AU20": 0.1}, layer="emotion"), 0)
    mixer.apply(Keyframe(action_units={"AU20": 0.8}, layer="speech", weight=0.3), 0)
    mixer.apply(Keyframe(head={"yaw": 12.3}, layer="speech", weight=0.3), 0)
    assert 0.1 + (0.8 - 0.1) * 0.3 != 0.31
    merged = mixer.report(1)["merged"]
    assert isinstance(merged, dict)
    assert merged["action_units"] == {"AU20": 0.31}
    assert len(str(merged["head"]["yaw"])) <= len("12.3456")


def test_a_ramp_asked_late_has_arrived(standard_rig):
    mixer = Mixer(standard_rig)
    mixer.apply(Keyframe(action_units={"AU12": 1.0}, fade=1.0), 0)
    mixer.at(10)
    assert mixer.at(400) == pytest.approx(standard_rig.contraction({"AU12": 1.0}))


def test_a_fade_goes_on_through_a_live_edit(standard_rig):
    stiffer = standard_rig.derive(tissue={"damping": 50.0})
    here, there = Mixer(standard_rig), Mixer(standard_rig)
    for mixer in (here, there):
        mixer.apply(Keyframe(action_units={"AU12": 1.0}, fade=1.0, hold=1.0), 0)
    there = there.moved_to(stiffer, 20)
    for tick in range(20, 200, 10):
        assert here.at(tick) == pytest.approx(there.at(tick), abs=1e-12)


def test_a_jaw_axis_at_zero_lets_go_of_what_lies_under_it(standard_rig):
    mixer = Mixer(standard_rig)
    pitch = standard_rig.channels.index("jaw", "pitch")
    mixer.apply(Keyframe(layer="emotion", action_units={"AU26": 1.0}), 0)
    mixer.apply(Keyframe(jaw={"pitch": 3.0}), 1)
    assert mixer.at(2)[pitch] == 3.0
    mixer.apply(Keyframe(jaw={"pitch": 0.0}), 3)
    assert mixer.at(4)[pitch] > 10.0
    assert "puppet" not in mixer.report(4)["layers"]


def test_without_a_fade_each_unit_takes_its_own_time(standard_rig):
    mixer = Mixer(standard_rig)
    smile, blink = (standard_rig.action_units[name] for name in ("AU12", "AU45"))
    assert 0.3 <= smile.onset <= 0.7
    assert blink.onset == pytest.approx(0.1, abs=0.03)
    assert blink.offset > blink.onset
    both = {"AU12": 1.0, "AU45": 1.0}
    mixer.apply(Keyframe(action_units=both, muscles={"mentalis.L": 0.5}, fade=None), 0)
    full = standard_rig.contraction(both)
    names = standard_rig.muscle_names
    zygomatic, lid, chin = (
        names.index(name)
        for name in ("zygomatic_major.L", "orbicularis_oculi_pretarsal.L", "mentalis.L")
    )
    early = mixer.at(round(60 * blink.onset))
    assert early[lid] == pytest.approx(full[lid])
    assert early[zygomatic] < 0.3 * full[zygomatic]
    assert mixer.at(0)[chin] == 0.5
    mixer.apply(Keyframe(action_units={"AU45": 0.0}, fade=None), 60)
    assert 0.0 < mixer.at(60 + round(60 * blink.onset))[lid] < full[lid]
    assert mixer.at(60 + round(60 * blink.offset))[lid] == 0.0
    assert mixer.at(70)[zygomatic] == pytest.approx(full[zygomatic])


def test_every_unit_says_how_long_it_takes(standard_rig):
    for unit in standard_rig.action_units.values():
        assert 0.0 < unit.onset <= LONGEST_ONSET
        assert 0.0 < unit.offset <= LONGEST_ONSET
        assert unit.timing
