"""Lids that a brow only touches: there it adds to what lies beneath, and no more."""

from __future__ import annotations

import pytest

from engine import Keyframe, Rig
from engine.held import Held
from engine.mixing import Mixer
from engine.touches import touched


def test_a_blink_goes_on_under_a_lowered_brow(standard_rig: Rig) -> None:
    """AU4 weighs on the upper lid a little: that is no word about whether the eye is open."""
    mixer = Mixer(standard_rig)
    lid = standard_rig.muscle_names.index("orbicularis_oculi_pretarsal.L")
    mixer.apply(Keyframe(emotion=("anger", 1.0), layer="emotion"), 0)
    weighed = float(mixer.at(1)[lid])
    assert 0.0 < weighed < 0.1
    mixer.apply(Keyframe(action_units={"AU45": 1.0}, layer="idle"), 1)
    assert mixer.at(2)[lid] == pytest.approx(1.0 + weighed)
    mixer.apply(Keyframe(action_units={"AU45": 0.0}, layer="idle"), 2)
    assert mixer.at(3)[lid] == weighed
    # Whoever says so, of the lid itself, counts.
    mixer.apply(Keyframe(action_units={"AU45": 1.0}, layer="idle"), 3)
    mixer.apply(Keyframe(action_units={"AU45": 0.2}), 4)
    assert mixer.at(5)[lid] == pytest.approx(0.2)


def test_closed_eyes_stay_closed_under_brows_that_move(standard_rig: Rig) -> None:
    for unit in ("AU1", "AU2", "AU4"):
        mixer = Mixer(standard_rig)
        lid = standard_rig.muscle_names.index("orbicularis_oculi_pretarsal.R")
        mixer.apply(Keyframe(action_units={"AU43": 1.0}, layer="mood"), 0)
        mixer.apply(Keyframe(action_units={unit: 1.0}), 1)
        assert mixer.at(2)[lid] >= 1.0
        mixer.apply(Keyframe(action_units={unit: 0.0}, fade=0.5), 2)
        assert all(mixer.at(tick)[lid] >= 1.0 for tick in range(3, 40))


@pytest.mark.parametrize(
    ("held", "only"),
    [
        (Held(action_units={"AU4": 1.0}), True),
        (Held(action_units={"AU4": 1.0, "AU45": 0.01}), False),
        (Held(action_units={"AU4": 1.0, "R45": 1.0}), True),
        (Held(action_units={"L4": 1.0, "L45": 1.0}), False),
        (Held(action_units={"AU4": 1.0}, muscles={"orbicularis_oculi_pretarsal.L": 0.01}), False),
        (Held(action_units={"AU12": 1.0}), False),
        (Held(), False),
    ],
)
def test_a_lid_is_only_touched_where_nobody_says_more(
    standard_rig: Rig, held: Held, only: bool
) -> None:
    left = standard_rig.muscle_names.index("orbicularis_oculi_pretarsal.L")
    assert touched(standard_rig, held)[left] == only
