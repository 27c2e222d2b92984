"""Combinations: what units do together that their sum would not, in commands and on the face."""

from __future__ import annotations

import pytest

from engine import InvalidValue, Keyframe
from engine.combination import Combination, together
from engine.measure import INNER_BROW, LIP_BOTTOM, LIP_TOP, OUTER_BROW, UPPER_LID, settle

OPEN = Combination(("AU25", "AU26"), yields={"AU25": 4.0, "AU26": 16.0})
BROWS = Combination(("AU1", "AU4"), factors={"AU4": {"depressor": 0.0}}, adds={"frontalis": 0.5})


def test_a_unit_yields_to_one_of_greater_reach():
    acting = together([OPEN], {"AU25": 1.0, "AU26": 0.125}).levels
    assert acting == {"AU26": 0.125, "AU25": 0.5}  # 2 mm by the jaw, and 2 more by the lips
    assert together([OPEN], {"AU25": 1.0, "AU26": 0.5}).levels["AU25"] == 0.0
    assert together([OPEN], {"AU25": 0.7}).levels == {"AU25": 0.7}


def test_factors_grow_with_the_share_of_the_weakest_and_not_with_the_expression():
    for whole in (0.2, 1.0):
        assert together([BROWS], {"AU1": whole, "AU4": whole}).factors == {
            ("AU4", "depressor"): 0.0
        }
        half = together([BROWS], {"AU1": whole, "AU4": whole / 2}).factors
        assert half["AU4", "depressor"] == pytest.approx(0.5)
    assert together([BROWS], {"AU4": 1.0}).factors == {}
    assert together([BROWS], {"AU1": 0.4, "AU4": 1.0}).adds == {"frontalis": pytest.approx(0.2)}


def test_a_rule_speaks_of_its_own_units():
    with pytest.raises(InvalidValue, match="speaks of no other"):
        Combination(("AU1", "AU4"), factors={"AU5": {}})
    with pytest.raises(InvalidValue, match="two"):
        Combination(("AU1",))


def test_the_built_in_rules_name_units_and_muscles_that_exist(standard_rig):
    stems = {name.partition(".")[0] for name in standard_rig.muscle_names}
    for rule in standard_rig.combinations:
        assert set(rule.units) <= set(standard_rig.action_units), rule.name
        assert rule.look
        assert rule.source
        for unit, weights in rule.factors.items():
            assert set(weights) <= set(standard_rig.action_units[unit].muscles), rule.name
        assert set(rule.adds) <= stems, rule.name


def test_sides_combine_by_themselves(standard_rig):
    mouth = standard_rig.contraction({"L43": 1.0, "R45": 1.0})
    assert mouth == pytest.approx(standard_rig.contraction({"AU43": 1.0}))


def test_combined_looks_on_the_face(standard_rig):
    """The landmarks of the manual's combined looks, each beside what the sum would do."""
    units = {
        "1": {"AU1": 1.0},
        "4": {"AU4": 1.0},
        "1+4": {"AU1": 1.0, "AU4": 1.0},
        "1+2+4": {"AU1": 1.0, "AU2": 1.0, "AU4": 1.0},
        "7": {"AU7": 1.0},
        "5+7": {"AU5": 1.0, "AU7": 1.0},
        "12": {"AU12": 1.0},
        "12+15": {"AU12": 1.0, "AU15": 1.0},
        "26": {"AU26": 1.0},
        "25+26": {"AU25": 1.0, "AU26": 1.0},
        "43": {"AU43": 1.0},
        "43+45": {"AU43": 1.0, "AU45": 1.0},
    }
    names = list(units)
    faces = dict(
        zip(
            names,
            settle(standard_rig, [Keyframe(action_units=u) for u in units.values()]),
            strict=True,
        )
    )
    inner, outer = (
        {name: face.u(point) for name, face in faces.items()} for point in (INNER_BROW, OUTER_BROW)
    )
    # 1+4: raised and drawn together, so that the brow slants.
    assert inner["1+4"][1] > 2.0
    assert inner["1+4"][0] < inner["1"][0] - 1.0
    assert inner["1+4"][1] - outer["1+4"][1] > 2.0
    # 1+2+4: the whole brow raised and drawn together.
    assert min(inner["1+2+4"][1], outer["1+2+4"][1]) > 2.0
    assert inner["1+2+4"][0] < inner["1"][0] - 1.0
    # 5+7: the upper lid stays up while the lower one is tense.
    assert faces["5+7"].u(UPPER_LID)[1] > faces["7"].u(UPPER_LID)[1] + 1.0
    # 12+15: the corner goes back, and up less than in 12.
    corner = {name: faces[name].u("M1_5.L") for name in ("12", "12+15")}
    assert -2.0 < corner["12+15"][1] < 0.6 * corner["12"][1]
    assert corner["12+15"][2] < -2.0
    # 25+26: as open as the stronger; 43+45: shut once.
    gaps = {name: faces[name].distance(LIP_TOP, LIP_BOTTOM) for name in ("26", "25+26")}
    assert gaps["25+26"] == pytest.approx(gaps["26"], abs=0.5)
    assert faces["43+45"].displacements == pytest.approx(faces["43"].displacements, abs=0.01)
