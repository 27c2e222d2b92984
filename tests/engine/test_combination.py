"""Combinations: what units do together that their sum would not, in commands and on the face."""

from __future__ import annotations

import pytest

from engine import InvalidValue, Keyframe
from engine.combination import Combination, together
from engine.flesh import examine
from engine.measure import (
    CHEEK,
    CORNER,
    HOLLOW,
    INNER_BROW,
    LIP_BOTTOM,
    LIP_TOP,
    LOWER_LID,
    LOWER_LIP,
    OUT_OF_CHEEK,
    OUTER_BROW,
    UPPER_LID,
    UPPER_LIP,
    Face,
    settle,
)

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


@pytest.fixture(scope="module")
def looks(standard_rig):
    """The face of units at 1, by their numbers: "6+12"."""
    names = (
        "1 2 4 5 6 7 9 10 12 15 18 20 22 23 24 26 33 34 43 1+2 2+4 4+5 6+12 6+7 9+10 15+17 23+24 "
        "18+22 18+23 5+43 33+34 12+25 12+26 20+25"
    ).split()
    units = [{f"AU{unit}": 1.0 for unit in name.split("+")} for name in names]
    faces = settle(standard_rig, [Keyframe(action_units=one) for one in units])
    return dict(zip(names, faces, strict=True))


def up(face: Face, point: str) -> float:
    return float(face.u(point)[1])


def gap(face: Face) -> float:
    return face.distance(LIP_TOP, LIP_BOTTOM)


def red(face: Face) -> float:
    """How far the red of the lips has become narrower, mm."""
    return -face.opening("M2_1.L", "M2_9.L")


def fissure(face: Face) -> float:
    return face.gap(UPPER_LID, LOWER_LID)


def test_brows_combine_as_the_manual_says(looks):
    # 1+2: one curve; the lid goes with the brow once.
    assert min(up(looks["1+2"], INNER_BROW), up(looks["1+2"], OUTER_BROW)) > 6.0
    alone = max(up(looks["1"], UPPER_LID), up(looks["2"], UPPER_LID))
    assert up(looks["1+2"], UPPER_LID) < 1.5 * alone
    # 2+4: steep, its inner end held down and drawn in.
    assert up(looks["2+4"], OUTER_BROW) - up(looks["2+4"], INNER_BROW) > 4.0
    assert looks["2+4"].u(INNER_BROW)[0] < looks["2"].u(INNER_BROW)[0] - 1.0
    # 4+5: the brow as low as in 4, the lid as high as in 5.
    assert up(looks["4+5"], INNER_BROW) == pytest.approx(up(looks["4"], INNER_BROW), abs=0.3)
    assert up(looks["4+5"], UPPER_LID) > up(looks["5"], UPPER_LID) - 0.5


def test_eyes_and_cheeks_combine_as_the_manual_says(looks):
    cheeks = {name: up(looks[name], CHEEK) for name in ("6", "12", "6+12")}
    assert max(cheeks["6"], cheeks["12"]) < cheeks["6+12"] < 0.9 * (cheeks["6"] + cheeks["12"])
    narrowest = min(fissure(looks["6"]), fissure(looks["7"]))
    assert 4.0 < fissure(looks["6+7"]) < narrowest
    assert looks["5+43"].displacements == pytest.approx(looks["43"].displacements, abs=0.05)
    out = {n: looks[n].along(HOLLOW, *OUT_OF_CHEEK) for n in ("33", "34", "33+34")}
    assert out["33+34"] == pytest.approx(out["34"], abs=0.05)
    assert out["34"] > out["33"] + 2.0


def test_lips_combine_as_the_manual_says(looks):
    # 9+10: no higher than by the stronger, the nostril's wing as high as in 9.
    assert up(looks["9+10"], UPPER_LIP) == pytest.approx(up(looks["10"], UPPER_LIP), abs=0.5)
    # 15+17: an arch: the middle of the lower lip over its corners.
    arch = {n: up(looks[n], LOWER_LIP) - up(looks[n], CORNER) for n in ("15", "15+17")}
    assert arch["15+17"] > arch["15"] + 1.0
    # 23+24: one line, not twice as thin; and no more drawn in than by 23.
    assert red(looks["23+24"]) < red(looks["23"]) + red(looks["24"]) - 0.3
    drawn = {
        n: -float(looks[n].u(CORNER)[0]) for n in ("18", "22", "23", "23+24", "18+22", "18+23")
    }
    assert drawn["23+24"] < drawn["23"]
    # 18+22: the ring contracts once; 18+23: a tight, small mouth.
    assert drawn["18+22"] < 0.8 * (drawn["18"] + drawn["22"])
    assert drawn["18+23"] > drawn["18"]
    assert gap(looks["18+23"]) < 2.0


def test_stretched_lips_part(looks):
    assert gap(looks["12+25"]) > gap(looks["12"]) + 2.0
    assert gap(looks["20+25"]) > gap(looks["20"]) + 3.0
    assert up(looks["12+25"], CORNER) > 5.0
    assert up(looks["12+26"], CORNER) > 2.0 > up(looks["26"], CORNER) + 4.0


def test_a_laugh_keeps_its_corners_up_and_its_flesh_whole(standard_rig):
    """Jaw open, the corners stand above where they rest, and no element of the lips turns over."""
    smiles = [Keyframe(action_units={"AU12": k, "AU26": 1.0}) for k in (0.4, 0.6, 0.8, 1.0)]
    heights = [float(face.u(CORNER)[1]) for face in settle(standard_rig, smiles)]
    assert heights == sorted(heights)
    assert heights[-1] > 5.0
    assert [flesh.inverted for flesh in examine(standard_rig, smiles)] == [0] * len(smiles)
