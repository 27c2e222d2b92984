"""Words for faces: labels, scores and coordinates lead to units that the rig can show."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    InvalidValue,
    Keyframe,
    UnknownName,
    broken_rules,
    examine,
    lexicon,
    parse_facs,
    resolve_coordinates,
    resolve_label,
    resolve_scores,
)
from engine.vocabulary import Recipe, Variant
from engine.vocabulary.mixture import mixed
from engine.vocabulary.words import normal, stem

RECIPES = lexicon().recipes
VOCABULARIES = lexicon().vocabularies
LABELS = [(name, label) for name, v in VOCABULARIES.items() for label in v.labels]
FORMS = [(name, v.facs) for name, recipe in RECIPES.items() for v in recipe.variants if v.facs]
SIZES = {
    "ekman": 7,
    "compound": 15,
    "goemotions": 28,
    "big6": 6,
    "everyday": 17,
    "occ": 22,
    "fsre": 24,
    "frijda": 12,
    "vrm": 18,
    "ros4hri": 25,
    "a2f": 10,
}
"""How many labels each publication has."""
coordinate = st.floats(-1.0, 1.0)
label = st.sampled_from(sorted({label for _, label in LABELS}))
ranked = st.lists(st.tuples(label, st.floats(0.01, 1.0)), min_size=1, max_size=12)


def by_side(units) -> dict[str, float]:
    """Return intensities with both sides of each unit by themselves."""
    sides = {}
    for key, value in units.items():
        number = key.removeprefix("AU").lstrip("LR")
        for side in key[0] if key[0] in "LR" else "LR":
            sides[side + number] = value
    return sides


def farthest(one, other) -> float:
    a, b = by_side(one), by_side(other)
    return max((abs(a.get(key, 0.0) - b.get(key, 0.0)) for key in {*a, *b}), default=0.0)


def test_vocabularies_have_the_labels_of_their_publications():
    sizes = {name: len(vocabulary.labels) for name, vocabulary in VOCABULARIES.items()}
    assert sizes.pop("emoji") >= 40
    assert sizes == SIZES
    assert all(v.source and v.title and v.faces for v in VOCABULARIES.values())


@pytest.mark.parametrize(("vocabulary", "label"), LABELS)
def test_every_label_plays_units_of_the_rig(standard_rig, vocabulary, label):
    plays = resolve_label(label, vocabulary=vocabulary)
    assert (plays.label, plays.vocabulary, plays.found) == (label, vocabulary, "label")
    assert sum(part.weight for part in plays.parts) <= 1.0 + 1e-9
    assert plays.source
    at_rest = {part.recipe for part in plays.parts} == {"neutral"}
    assert bool(plays.units) is not at_rest
    standard_rig.check(Keyframe(action_units=plays.units))


@pytest.mark.parametrize(("name", "facs"), FORMS)
def test_every_variant_is_made_of_units_of_the_rig(standard_rig, name, facs):
    units = {term.key: term.intensity for term in parse_facs(facs)}
    for key in units:
        standard_rig.resolve_unit(key)
    assert list(broken_rules(units)) == []


def test_every_recipe_says_where_it_comes_from():
    for recipe in RECIPES.values():
        assert recipe.place_source
        assert (np.abs(recipe.place) <= 1.0).all()
        assert all(variant.source and variant.weight > 0 for variant in recipe.variants)
        assert len({variant.facs for variant in recipe.variants}) == len(recipe.variants)


def test_the_measured_faces_of_the_rig_are_the_first_variants(standard_rig):
    for name, emotion in standard_rig.emotions.items():
        assert RECIPES[name].variants[0].facs == emotion.recipe
        assert resolve_label(name).facs == (emotion.recipe or "0")
        for word in emotion.synonyms:
            assert resolve_label(word).parts


@pytest.mark.parametrize(
    ("word", "recipe"),
    [
        ("joyful", "happiness"),
        ("HAPPILY", "happiness"),
        ("happier", "happiness"),
        (" sad ", "sadness"),
        ("saddest", "sadness"),
        ("angry", "anger"),
        ("angrily", "anger"),
        ("surprised", "surprise"),
        ("surprisingly", "surprise"),
        ("disgusting", "disgust"),
        ("scary", "fear"),
        ("contemptuously", "contempt"),
        ("confusedly", "confusion"),
        ("proudly", "pride"),
        ("shyly", "embarrassment"),
        ("out-of-breath", "out of breath"),
        ("Happily_Surprised", "happily surprised"),
        ("happy surprise", "happily surprised"),
        ("🤔", "thinking"),
        ("face with raised eyebrow", "skepticism"),
    ],
)
def test_other_forms_of_a_word_name_the_same_face(word, recipe):
    assert [part.recipe for part in resolve_label(word).parts] == [recipe]


SELECTORS = [*range(0xFE00, 0xFE10), 0xE0100, 0xE01EF]


@pytest.mark.parametrize("selector", SELECTORS, ids=hex)
def test_a_word_is_the_same_however_it_is_drawn(selector):
    for word in ("☹", "☺", "🙃", "joy"):
        drawn = resolve_label(word + chr(selector))
        assert (drawn.label, drawn.units) == (word, resolve_label(word).units)


def test_an_upside_down_smile_is_a_smile_that_one_side_does_not_mean():
    smile, ironic = resolve_label("🙂").units, resolve_label("🙃")
    assert ironic.vocabulary == "emoji"
    assert smile.items() < ironic.units.items()
    assert by_side(ironic.units)["L14"] > 0.0


@pytest.mark.parametrize("word", ["joyless", "unafraid", "xyzzy", "", "   ", "🚗", "e"])
def test_a_word_that_names_no_face_is_refused(word):
    with pytest.raises(UnknownName) as refused:
        resolve_label(word)
    assert refused.value.kind == "emotion"
    assert {*RECIPES} <= {*refused.value.known}


def test_the_nearest_words_are_named_first():
    with pytest.raises(UnknownName, match="did you mean surprise") as refused:
        resolve_label("suprise")
    assert refused.value.known[0] == "surprise"


def test_within_a_vocabulary_other_words_name_its_labels():
    assert resolve_label("joyful", vocabulary="big6").label == "happiness"
    assert resolve_label("joyful", vocabulary="goemotions").label == "joy"
    assert resolve_label("furious", vocabulary="ros4hri").parts[0].recipe == "rage"
    with pytest.raises(UnknownName) as refused:
        resolve_label("boredom", vocabulary="big6")
    assert {*refused.value.known} == {*VOCABULARIES["big6"].labels}
    with pytest.raises(UnknownName, match="vocabulary"):
        resolve_label("joy", vocabulary="big7")


def test_no_word_is_a_synonym_of_two_recipes():
    words = Counter(word for recipe in RECIPES.values() for word in recipe.synonyms)
    assert [word for word, count in words.items() if count > 1] == []


def test_words_of_one_stem_name_one_face_but_where_they_differ_in_english():
    faces: dict[str, set[str]] = {}
    for word in lexicon()._words:
        faces.setdefault(stem(word), set()).add(str(resolve_label(word).units))
    assert {s for s, found in faces.items() if len(found) > 1} == {
        stem("sleepy"),
        stem("sleepy face"),
    }


@given(st.text(max_size=30))
def test_a_normal_form_is_its_own(text):
    assert normal(normal(text)) == normal(text)


def test_turns_come_as_often_as_they_weigh_and_do_not_repeat():
    for recipe in RECIPES.values():
        total = sum(variant.weight for variant in recipe.variants)
        turns = [recipe.turn(number) for number in range(2 * total)]
        assert turns[0] == 0
        assert Counter(turns[:total]) == {i: v.weight for i, v in enumerate(recipe.variants)}
        if len(recipe.variants) > 1:
            assert 2 * max(variant.weight for variant in recipe.variants) <= total
            assert all(one != other for one, other in pairwise(turns))


def test_a_turn_chooses_by_recipe():
    assert resolve_label("joy", turn=lambda name: len(name)).parts[0].variant == RECIPES[
        "happiness"
    ].turn(len("happiness"))
    faces = {resolve_label("anger", turn=lambda _, n=n: n).facs for n in range(7)}
    assert faces == {variant.facs for variant in RECIPES["anger"].variants}


@given(ranked)
def test_the_order_of_scores_does_not_matter(scores):
    assert farthest(resolve_scores(scores).units, resolve_scores(scores[::-1]).units) < 1e-9


@given(label, st.floats(0.05, 1.0))
def test_one_score_is_an_intensity(word, score):
    one, alone = resolve_scores([(word, score)]).units, resolve_label(word).units
    assert farthest(one, {key: score * value for key, value in alone.items()}) < 1e-9


def test_neutral_lowers_the_intensity_of_the_rest():
    strong = resolve_scores([("joy", 1.0)]).units
    weak = resolve_scores([("joy", 0.25), ("neutral", 0.75)]).units
    assert farthest(weak, {key: 0.25 * value for key, value in strong.items()}) < 1e-9
    rest = resolve_scores([("neutral", 0.9)])
    assert (rest.units, rest.facs) == ({}, "0")


def test_scores_above_one_in_sum_are_shares():
    twice = resolve_scores([("joy", 2.0), ("fear", 1.0)]).units
    assert farthest(twice, resolve_scores([("joy", 2 / 3), ("fear", 1 / 3)]).units) < 1e-9


def test_the_greatest_scores_stand_for_all():
    tail = [("anger", 0.02), ("disgust", 0.03), ("pride", 0.01), ("love", 0.01)]
    head = [("joy", 0.4), ("surprise", 0.3), ("excitement", 0.1), ("amusement", 0.1)]
    mix = resolve_scores(tail + head)
    assert [part.recipe for part in mix.parts] == [
        "happiness",
        "surprise",
        "amusement",
        "excitement",
    ]
    assert sum(part.weight for part in mix.parts) == pytest.approx(0.97)


@pytest.mark.parametrize("scores", [[], [("joy", 0.0)]])
def test_scores_of_nothing_are_refused(scores):
    with pytest.raises(InvalidValue, match="above 0"):
        resolve_scores(scores)


def test_sides_are_summed_by_side():
    assert mixed([("R12E", 0.5), ("12E", 0.5)]) == {"L12": 0.5, "R12": 1.0}
    assert mixed([("R12E", 0.5), ("L12E", 0.5)]) == {"AU12": 0.5}
    assert mixed([("T28E", 0.5), ("B28E", 0.5)]) == {"T28": 0.5, "B28": 0.5}
    assert mixed([("T28E", 0.5), ("L28E", 0.5)]) == {"T28": 0.5, "L28": 0.5}
    assert mixed([("", 1.0)]) == {}
    assert mixed([("12E", 0.75), ("6E+12E", 0.75)]) == {"AU12": 1.0, "AU6": 0.75}


@given(coordinate, coordinate, coordinate, st.tuples(*[st.floats(-0.01, 0.01)] * 3))
def test_coordinates_lead_to_a_face_that_moves_with_them(valence, arousal, dominance, step):
    here = np.array([valence, arousal, dominance])
    there = np.clip(here + step, -1.0, 1.0)
    one, other = resolve_coordinates(*here.tolist()), resolve_coordinates(*there.tolist())
    assert sum(part.weight for part in one.parts) == pytest.approx(1.0)
    assert farthest(one.units, other.units) <= 8.0 * float(np.linalg.norm(there - here)) + 1e-9


def test_an_anchor_is_its_own_face_and_the_origin_is_rest():
    for name, recipe in RECIPES.items():
        if recipe.anchor:
            parts = resolve_coordinates(*recipe.place.tolist()).parts
            assert [(part.recipe, part.weight) for part in parts] == [(name, 1.0)]
    assert resolve_coordinates(0.0, 0.0).units == {}


def test_intensity_falls_towards_the_origin():
    happy = RECIPES["happiness"].place
    points = [happy * share for share in (0.2, 0.6, 1.0)]
    smiles = [by_side(resolve_coordinates(*point.tolist()).units)["L12"] for point in points]
    assert smiles == sorted(smiles)
    assert smiles[0] < 0.2 < smiles[-1]


def test_a_recipe_of_one_variant_always_plays_it():
    recipe = Recipe("x", (Variant("12E", 2, "ours"),), np.zeros(3), "ours", False, ())
    assert [recipe.turn(n) for n in range(4)] == [0] * 4


def test_recipes_settle_without_folds_and_without_teeth_through_the_lips(standard_rig):
    """Every sixth form; `risorius emotions` measures them all."""
    forms = FORMS[::6]
    commands = [
        Keyframe(action_units={term.key: term.intensity for term in parse_facs(facs)})
        for _, facs in forms
    ]
    for form, flesh in zip(forms, examine(standard_rig, commands), strict=True):
        assert flesh.inverted == 0, form
        assert flesh.folds == {}, form
        assert flesh.through == {}, form
        assert flesh.speed < 5.0, form


@pytest.mark.parametrize(
    ("valence", "arousal", "meant"),
    [
        (0.8, 0.5, "happiness"),
        (-0.5, 0.6, "anger"),
        (-0.7, -0.3, "sadness"),
    ],
)
def test_a_point_without_dominance_is_the_feeling_that_lies_there(valence, arousal, meant):
    resolved = resolve_coordinates(valence, arousal)
    assert resolved.parts[0].recipe == meant


def test_dominance_that_is_left_out_is_that_of_the_anchor_at_the_point():
    for recipe in lexicon().recipes.values():
        if recipe.anchor:
            parts = resolve_coordinates(*recipe.place[:2].tolist()).parts
            assert max(parts, key=lambda part: part.weight).recipe == recipe.name, recipe.name
