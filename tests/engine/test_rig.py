"""Rigs: names, content hashes, edits, and what the clients read of them."""

from __future__ import annotations

import json

import numpy as np
import pytest

from engine import (
    InvalidValue,
    Keyframe,
    Model,
    Recipe,
    UnknownName,
    builtin_rig,
    rig_from_recipe,
)
from engine.head import STANDARD, person_head, reference_head
from engine.muscle import LidMuscle
from engine.rig import rig_from_head
from engine.tissue import TissueParameters

TABLE_1 = (1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 16, 17, 20, 23, 25, 26)


def test_the_papers_action_units_and_23_muscles_are_there(standard_rig):
    assert {f"AU{number}" for number in TABLE_1} <= set(standard_rig.action_units)
    assert standard_rig.action_units["AU10"].title == "Upper lip raiser"
    assert standard_rig.action_units["AU12"].title == "Lip corner puller"
    own = [m for m in standard_rig.muscles if not m.extension and not isinstance(m, LidMuscle)]
    assert len(own) == 23
    assert {m.kind for m in own} == {"linear", "sphincter", "sheet"}


def test_every_recipe_names_muscles_that_exist_and_a_source(standard_rig):
    stems = {name.partition(".")[0] for name in standard_rig.muscle_names}
    for unit in standard_rig.action_units.values():
        assert set(unit.muscles) <= stems
        assert unit.source
    for muscle in standard_rig.muscles:
        assert muscle.source
    for emotion in standard_rig.emotions.values():
        assert emotion.source
        for term in emotion.terms:
            standard_rig.resolve_unit(term.key)


def test_muscles_are_fitted_on_the_standard_person(standard_rig):
    """Its tissue is that of the head that all people come from, which needs no hair and paint."""
    person = person_head(STANDARD)
    fitted = [
        rig_from_head(person, parameters=TissueParameters(), fitted_on=head).muscles
        for head in (person, reference_head("high"))
    ]
    assert repr(fitted[0]) == repr(fitted[1]) == repr(standard_rig.muscles)


def test_curves_rise(standard_rig):
    for unit in standard_rig.action_units.values():
        intensities, scales = zip(*unit.curve, strict=True)
        assert (np.diff(intensities) > 0).all()
        assert (np.diff(scales) > 0).all()
        assert unit.scale(1.0) <= 1.5


def test_the_same_edits_give_the_same_id(standard_rig):
    edit = {"tissue": {"damping": 50.0}, "muscles": {"risorius.L": {"force_scale": 900.0}}}
    one, other = standard_rig.derive(**edit), standard_rig.derive(**edit)
    assert one.id == other.id != standard_rig.id
    assert standard_rig.derive().id == standard_rig.id


@pytest.mark.parametrize("edit", [{}, {"tissue": {"damping": 50.0}}, {"recipe": {"age": 60.0}}])
def test_a_level_changes_no_id_whatever_is_edited(standard_rig, edit):
    low = standard_rig.at_level("low")
    assert low.id == standard_rig.id
    edited = low.derive(**edit)
    assert edited.id == standard_rig.derive(**edit).id
    assert len(edited.head.drawn.vertices) == len(low.head.drawn.vertices)
    back = edited.at_level("high")
    assert back.id == edited.id
    assert len(back.head.drawn.vertices) == len(standard_rig.head.drawn.vertices)


def test_what_is_left_of_the_tissue_is_left_of_the_usual_one():
    usual = rig_from_recipe(Recipe(age=20.0), level="low").parameters
    assert usual == TissueParameters()
    old = rig_from_recipe(Recipe(age=85.0), level="low").parameters
    assert old.pretension == pytest.approx(0.65 * usual.pretension)
    assert old.stiffness_low.dermis == pytest.approx(0.70 * usual.stiffness_low.dermis)
    assert old.stiffness_low.epidermis == pytest.approx(1.15 * usual.stiffness_low.epidermis)
    assert old.plate == usual.plate


def test_who_looks_otherwise_has_another_id(standard_rig):
    # Freckles change neither tissue nor muscles.
    assert standard_rig.derive(recipe={"freckles": 1.0}).id != standard_rig.id


def test_custom_units_and_emotions_are_kept(standard_rig):
    rig = standard_rig.derive(
        action_units={"SNEER": {"muscles": {"levator_labii_alaeque_nasi.L": 1.0}, "jaw": 2.0}},
        emotions={"Smug": {"recipe": "R12C+L14B"}},
    )
    vector = rig.contraction({"SNEER": 1.0})
    assert vector[rig.muscle_names.index("levator_labii_alaeque_nasi.L")] == 1.0
    assert vector[rig.muscle_names.index("levator_labii_alaeque_nasi.R")] == 0.0
    assert rig.resolve_emotion("smug").recipe == "R12C+L14B"


def test_a_side_moves_that_side_only(standard_rig):
    both = standard_rig.contraction({"AU12": 1.0})
    left = standard_rig.contraction({"L12": 1.0})
    right = standard_rig.contraction({"R12": 1.0})
    assert left + right == pytest.approx(both)
    assert left[standard_rig.muscle_names.index("zygomatic_major.R")] == 0.0


@pytest.mark.parametrize(
    ("edit", "error", "message"),
    [
        ({"tissue": {"stifness": 1.0}}, UnknownName, "tissue parameter"),
        ({"tissue": {"stiffness_low": {"skin": 1.0}}}, UnknownName, "tissue layer"),
        ({"tissue": {"stiffness_low": 5.0}}, InvalidValue, "mapping"),
        ({"tissue": {"damping": 1e9}}, InvalidValue, "between"),
        ({"tissue": {"damping": "much"}}, InvalidValue, "number"),
        ({"tissue": {"cross_diagonals": 1}}, InvalidValue, "true or false"),
        ({"tissue": {"stiffness_low": {"epidermis": 500.0}}}, InvalidValue, "stiffens"),
        ({"muscles": {"biceps": {"strength": 1.0}}}, UnknownName, "muscle"),
        ({"muscles": {"risorius.L": {"name": "x"}}}, UnknownName, "field"),
        ({"muscles": {"risorius.L": {"strength": -1.0}}}, InvalidValue, "above 0"),
        ({"muscles": {"risorius.L": {"attachment": [1, 2]}}}, InvalidValue, "3 entries"),
        ({"muscles": {"risorius.L": {"strength": float("nan")}}}, InvalidValue, "finite"),
        ({"action_units": {"X": {"muscles": {"biceps": 1.0}}}}, UnknownName, "muscle"),
        ({"action_units": {"X": {"weights": {}}}}, UnknownName, "action unit field"),
        ({"emotions": {"x": "99A"}}, UnknownName, "action unit"),
        ({"emotions": {"x": 4}}, InvalidValue, "FACS string"),
        ({"emotions": {"x": {"recipe": "6C", "synonyms": 5}}}, InvalidValue, "expected words"),
        ({"action_units": {"X": None}}, InvalidValue, "expected an object"),
        ({"muscles": {"risorius.L": None}}, InvalidValue, "expected an object"),
    ],
)
def test_bad_edits_are_refused_with_what_was_given(standard_rig, edit, error, message):
    with pytest.raises(error, match=message):
        standard_rig.derive(**edit)


def test_unknown_labels_come_with_the_nearest(standard_rig):
    assert standard_rig.resolve_emotion("JOY").name == "happiness"
    with pytest.raises(UnknownName) as caught:
        standard_rig.resolve_emotion("hapiness")
    assert "happiness" in caught.value.nearest
    assert "sadness" in caught.value.known
    with pytest.raises(UnknownName, match="rig"):
        builtin_rig("standart")


def test_models_are_named_and_checked(standard_rig, paper_rig):
    assert standard_rig.model == Model()
    assert paper_rig.model.springs == "literal"
    assert Model.for_rig(standard_rig, integrator="heun").integrator == "heun"
    with pytest.raises(UnknownName, match="integrator"):
        Model(integrator="euler")


def test_the_paper_rig_has_every_added_term_off(paper_rig):
    p = paper_rig.parameters
    assert (p.pretension, p.skin_volume, p.plate, p.fat_pressure, p.force_smoothing) == (0,) * 5
    assert not p.thin_skin_grip
    assert (p.cross_diagonals, p.force_quadrature, p.regional_depth) == (False,) * 3
    assert 1200 <= len(paper_rig.head.polygons) <= 1350
    assert (paper_rig.head.polygons[:, 3] == -1).all()


def test_the_description_is_plain_data(standard_rig, paper_rig):
    for rig in (standard_rig, paper_rig):
        data = json.loads(json.dumps(rig.describe(), allow_nan=False))
        assert data["id"] == rig.id
        assert len(data["muscles"]) == len(rig.muscles)
        share = {muscle["name"]: muscle["jaw_share"] for muscle in data["muscles"]}
        assert share["mentalis.L"] == share["mentalis.R"] == 1.0
        assert share["zygomatic_major.L"] == share["frontalis_medial.L"] == 0.0
        assert 0.2 < share["orbicularis_oris"] < 0.8


def test_commands_out_of_range_are_refused(standard_rig):
    for keyframe in (
        Keyframe(layer="top"),
        Keyframe(jaw={"roll": 1.0}),
        Keyframe(jaw={"pitch": 90.0}),
        Keyframe(emotion=("bliss?", 1.0)),
        Keyframe(weight=2.0),
        Keyframe(fade=-1.0),
        Keyframe(muscles={"risorius.L": 9.0}),
    ):
        with pytest.raises((UnknownName, InvalidValue)):
            standard_rig.check(keyframe)
