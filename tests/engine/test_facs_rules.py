"""Rules of FACS as data, and the units that break them."""

from __future__ import annotations

import pytest

from engine import broken_rules, builtin_rig, facs_codes, parse_facs
from engine.facs import exclusions, needs
from engine.rig_data import load_emotions
from engine.vocabulary import lexicon

PAIRS = [(rule, *pair) for rule in exclusions() for pair in rule.pairs]
RECIPES = sorted(
    {emotion.recipe for emotion in load_emotions().values() if emotion.recipe}
    | {v.facs for recipe in lexicon().recipes.values() for v in recipe.variants if v.facs}
)


def found(facs: str) -> list[tuple[str, tuple[str, ...]]]:
    """Return rule and units of each warning about a FACS string."""
    units = {term.key: term.intensity for term in parse_facs(facs)}
    return [(warning.rule, warning.units) for warning in broken_rules(units)]


@pytest.mark.parametrize(("rule", "one", "other"), PAIRS, ids=lambda value: str(value)[:40])
def test_each_pair_that_excludes_itself_is_named(rule, one, other):
    expected = (rule.rule, (one, other))
    warnings = broken_rules({one: 0.2, other: 1.0})
    assert expected in [(warning.rule, warning.units) for warning in warnings]
    (warning,) = [w for w in warnings if (w.rule, w.units) == expected]
    assert str(warning).endswith(f"(rule {rule.rule})")
    assert rule.source in warning.message
    for name in (one, other):
        assert rule.rule not in [w.rule for w in broken_rules({name: 1.0})]
    assert rule.rule not in [w.rule for w in broken_rules({one: 1.0, other: 0.0})]


@pytest.mark.parametrize("rule", needs(), ids=lambda rule: rule.rule)
def test_each_code_that_needs_another_is_named_without_it(rule):
    assert [w.rule for w in broken_rules({rule.unit: 1.0})] == [rule.rule]
    for other in rule.any_of:
        assert broken_rules({rule.unit: 1.0, other: 0.2}) == []


def test_rules_speak_of_codes_that_there_are_and_have_names_of_their_own():
    codes = facs_codes()
    assert {name for _, one, other in PAIRS for name in (one, other)} <= set(codes)
    assert {name for rule in needs() for name in (rule.unit, *rule.any_of)} <= set(codes)
    names = [rule.rule for rule in (*exclusions(), *needs())]
    assert len(set(names)) == len(names)
    pairs = [frozenset((one, other)) for _, one, other in PAIRS]
    assert len(set(pairs)) == len(pairs)


@pytest.mark.parametrize("facs", ["12C+15C", "1+2+4", "18+20", "5+7", "25+26", "6+7+12", "23+24"])
def test_units_that_pull_against_each_other_are_no_clash(facs):
    assert found(facs) == []


def test_only_units_of_the_same_side_and_lip_clash():
    assert found("L43+R5") == []
    assert found("L43+5") == [("lid_up_or_down", ("AU5", "L43"))]
    assert found("T22+B28") == []
    assert found("T22+L28") == [("lips_in_or_out", ("T22", "L28"))]
    assert found("46+R5") == []
    assert found("46+5") == [("lid_up_or_down", ("AU5", "AU46"))]


def test_a_unit_of_one_side_is_not_seen_on_both():
    assert found("L30+R30") == [("one_side_only", ("L30", "R30"))]
    assert found("46+R46") == [("one_side_only", ("AU46", "R46"))]
    assert found("30+L30") == []


def test_a_side_and_a_lip_of_one_unit_overlap():
    assert found("T28+L28") == [("side_and_lip", ("L28", "T28"))]
    assert found("T28+B28") == found("L28+R28") == found("T28+L24") == []


@pytest.mark.parametrize("recipe", RECIPES)
def test_no_recipe_that_comes_with_the_engine_breaks_a_rule(recipe):
    assert found(recipe) == []


def test_a_side_of_what_has_none_is_named():
    assert found("L51+R26+12") == [("no_side", ("L51",)), ("no_side", ("R26",))]


def test_units_of_a_rig_of_its_own_break_no_rule():
    assert broken_rules({"smirk": 1.0, "AU51": 1.0}) == []


def test_the_codes_are_all_of_facs_and_in_order():
    names = list(facs_codes())
    assert names == sorted(names, key=lambda n: (int(n.strip("AUM")), n.startswith("M")))
    assert {f"AU{number}" for number in (8, 21, 31, 32, 36, 37, 50, 69, 70, 84, 98)} < set(names)
    assert not {"AU3", "AU47", "AU59", "AU99", "M12"} & set(names)
    rig = builtin_rig("standard").action_units
    assert set(rig) <= set(names)
    for code in facs_codes().values():
        assert set(code.nearest) <= set(rig), code.name
        assert not (code.nearest and code.name in rig), code.name
        assert not set(code.sides) - set("LRTB")


def test_units_have_the_titles_of_their_codes():
    codes = facs_codes()
    for name, unit in builtin_rig("standard").action_units.items():
        assert codes[name].title == unit.title
