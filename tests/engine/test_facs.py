"""FACS notation, curves and sides."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import LETTERS, ActionUnit, InvalidNotation, Term, format_facs, parse_facs
from engine.facs import split_side

TERMS = st.builds(
    Term,
    st.integers(1, 66).map(lambda number: f"AU{number}"),
    st.sampled_from(["", "L", "R"]),
    st.sampled_from(sorted(LETTERS.values())),
)


@given(st.lists(TERMS, min_size=1, max_size=8))
def test_what_is_written_reads_back_the_same(terms):
    assert list(parse_facs(format_facs(terms))) == terms


def test_spaces_case_and_long_names_are_allowed():
    expected = (Term("AU1", "", 0.6), Term("AU12", "L", 0.8), Term("AU26", "", 0.6))
    assert parse_facs(" 1c + l12D+AU26 ") == expected
    assert parse_facs("01*")[0] == Term("AU1", "", 0.6)


@pytest.mark.parametrize("text", ["", "12F", "12+", "smile", "L", "12 13", "X12A", "1" * 5000])
def test_what_cannot_be_read_says_which_part(text):
    with pytest.raises(InvalidNotation):
        parse_facs(text)


@pytest.mark.parametrize("text", ["6c 12D", "6C, 12D", "6C;12D"])
def test_units_without_a_plus_are_told_what_was_probably_meant(text):
    with pytest.raises(InvalidNotation, match=r"joined by '\+'.*may mean '6C\+12D'"):
        parse_facs(text)


def test_sides_are_read_from_keys():
    assert split_side("AU12") == ("AU12", "")
    assert split_side("l12") == ("AU12", "L")
    assert split_side("RAU4") == ("AU4", "R")
    with pytest.raises(InvalidNotation, match="smile"):
        split_side("smile")


def test_the_curve_is_followed_between_its_knots():
    unit = ActionUnit("AU1", "", curve=((0.0, 0.0), (0.5, 0.2), (1.0, 1.0)))
    assert unit.scale(0.0) == 0.0
    assert unit.scale(0.25) == pytest.approx(0.1)
    assert unit.scale(0.75) == pytest.approx(0.6)
    assert unit.scale(1.0) == 1.0
