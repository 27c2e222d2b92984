"""Aged tissue, palsy and relaxed muscles: edits that do what the clinic says."""

from __future__ import annotations

import numpy as np
import pytest

from engine import InvalidValue, Keyframe, UnknownName, plain_changes, settled


def conditioned(rig, **changes):
    return rig.derive(**plain_changes(rig, changes))


def shown(rig, **units):
    return settled(rig, [Keyframe(action_units=units)])[0].displacements


def test_a_palsy_weakens_one_side_and_spares_the_oculomotor_nerve(standard_rig):
    rig = conditioned(standard_rig, palsy={"side": "left", "grade": "V"})
    assert rig.muscle("zygomatic_major.L").gain == (0.15, 1.0)
    assert rig.muscle("zygomatic_major.R").gain == (1.0, 1.0)
    assert rig.muscle("frontalis_medial.L").gain[0] == 0.0
    assert rig.muscle("orbicularis_oris").gain == (0.15, 1.0)
    assert rig.muscle("levator_palpebrae.L").gain == (1.0, 1.0)


def test_the_palsied_side_stays_down_and_the_sound_one_pulls_the_mouth(standard_rig):
    rig = conditioned(standard_rig, palsy={"side": "left", "grade": "VI"})
    left, right = (rig.head.point(f"M1_5.{side}") for side in "LR")
    sound = shown(standard_rig, AU12=1.0)[left]
    smile = shown(rig, AU12=1.0)
    assert smile[left][1] < 0.2 * sound[1]
    assert smile[right][1] > 0.9 * sound[1]
    assert smile[rig.head.point("M0_0")][0] < -1.5  # The mouth is drawn to the sound side.


def test_grades_rise_from_sound_to_still(standard_rig):
    ways = []
    for grade in ("I", "III", "VI"):
        rig = conditioned(standard_rig, palsy={"side": "right", "grade": grade})
        ways.append(shown(rig, AU1=1.0)[rig.head.point("E4_2.R")][1])
    assert ways[0] > ways[1] + 1.0 > ways[2] + 2.0
    assert conditioned(standard_rig, palsy={"side": "right", "grade": "I"}).id == standard_rig.id


def test_a_relaxed_muscle_has_lost_its_share_on_the_side_that_is_named(standard_rig):
    rig = conditioned(
        standard_rig,
        relaxed={"corrugator_supercilii": 0.8, "corrugator_supercilii.R": 0.2, "procerus": 1.0},
    )
    assert rig.muscle("corrugator_supercilii.L").gain == pytest.approx((0.2, 0.2))
    assert rig.muscle("corrugator_supercilii.R").gain == pytest.approx((0.8, 0.8))
    assert rig.muscle("procerus.L").gain == (0.0, 0.0)


def test_relaxing_the_frown_lets_the_brow_be(standard_rig):
    glabella = ("corrugator_supercilii", "procerus", "depressor_supercilii")
    rig = conditioned(standard_rig, relaxed=dict.fromkeys(glabella, 1.0))
    brow = rig.head.point("E4_2.L")
    before, after = shown(standard_rig, AU4=1.0)[brow], shown(rig, AU4=1.0)[brow]
    assert np.linalg.norm(after) < 0.15 * np.linalg.norm(before)


def test_a_palsy_and_a_relaxed_muscle_multiply(standard_rig):
    rig = conditioned(
        standard_rig,
        palsy={"side": "left", "gain": 0.5},
        relaxed={"zygomatic_major": 0.5},
    )
    assert rig.muscle("zygomatic_major.L").gain == pytest.approx((0.25, 0.5))
    assert rig.muscle("zygomatic_major.R").gain == pytest.approx((0.5, 0.5))


def test_a_gain_of_zero_is_a_muscle_without_force_in_both_force_modes(standard_rig):
    from engine import Model
    from engine.assembly import compile_rig

    rig = standard_rig.derive(muscles={"zygomatic_major.L": {"gain": 0.0}})
    row = rig.muscle_names.index("zygomatic_major.L")
    for forces in ("rest", "current"):
        before = compile_rig(standard_rig, Model(forces=forces))
        after = compile_rig(rig, Model(forces=forces))
        assert not after.basis[row].any()
        np.testing.assert_array_equal(after.basis[row + 1], before.basis[row + 1])
        if forces == "current":
            assert not after.pull.share[row].any()
            assert before.pull.share[row].any()


def test_old_tissue_is_slacker_weaker_and_idempotent(standard_rig):
    old = conditioned(standard_rig, tissue_age="old")
    assert old.parameters.pretension < standard_rig.parameters.pretension
    assert old.parameters.muscle_strength < 1.0
    np.testing.assert_array_equal(old.head.points, standard_rig.head.points)
    assert conditioned(old, tissue_age="old").id == old.id
    young = conditioned(standard_rig, tissue_age="young")
    assert conditioned(old, tissue_age="young").id == young.id
    middle = conditioned(standard_rig, tissue_age="middle")
    assert conditioned(standard_rig, tissue_age=50).id == middle.id
    corner = standard_rig.head.point("M1_5.L")
    ways = [np.linalg.norm(shown(rig, AU12=1.0)[corner]) for rig in (young, middle, old)]
    assert ways[0] > ways[1] > ways[2]


def test_what_is_named_wins_over_a_condition(standard_rig):
    rig = conditioned(
        standard_rig,
        tissue_age="old",
        tissue={"pretension": 0.1},
        palsy={"side": "left", "grade": "VI"},
        muscles={"zygomatic_major.L": {"gain": 0.7}},
    )
    assert rig.parameters.pretension == 0.1
    assert rig.muscle("zygomatic_major.L").gain == (0.7, 0.7)


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"tissue_age": "ancient"}, UnknownName, "tissue age"),
        ({"tissue_age": 7}, InvalidValue, "between 18 and 90"),
        ({"tissue_age": True}, InvalidValue, "number"),
        ({"palsy": {"grade": "IV"}}, UnknownName, "palsy side"),
        ({"palsy": {"side": "left", "grade": "VII"}}, UnknownName, "House-Brackmann"),
        ({"palsy": {"side": "left"}}, UnknownName, "House-Brackmann"),
        ({"palsy": {"side": "left", "gain": 2.0}}, InvalidValue, "palsy.gain"),
        ({"palsy": {"side": "left", "grades": "II"}}, UnknownName, "palsy field"),
        ({"relaxed": {"zygomaticus": 0.5}}, UnknownName, "did you mean zygomatic"),
        ({"relaxed": {"procerus": 1.5}}, InvalidValue, "between 0 and 1"),
        ({"relaxed": {"procerus": {"up": 1}}}, UnknownName, "side"),
        ({"relaxed": [1]}, InvalidValue, "object"),
        ({"muscles": {"procerus.L": {"gain": 3.0}}}, InvalidValue, "gain"),
    ],
)
def test_what_is_no_condition_is_refused(standard_rig, changes, error, message):
    with pytest.raises(error, match=message):
        conditioned(standard_rig, **changes)


def test_the_papers_mask_has_no_age(paper_rig):
    with pytest.raises(InvalidValue, match="does not age"):
        conditioned(paper_rig, tissue_age="old")
