"""FACS notation both ways, scales, curves and sides."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    LETTERS,
    SCALES,
    ActionUnit,
    InvalidNotation,
    Term,
    UnknownName,
    facs_codes,
    format_facs,
    letter_of,
    parse_facs,
    print_facs,
)
from engine.facs import BANDED, nearest_letter, split_side, term_of

SIDE = st.sampled_from(["", "L", "R", "T", "B"])
NAME = st.integers(1, 99).map(lambda number: f"AU{number}") | st.sampled_from(
    [name for name in facs_codes() if name.startswith("M")]
)
LETTERED = st.builds(Term, NAME, SIDE, st.sampled_from(sorted(LETTERS.values())))
TERMS = st.builds(Term, NAME, SIDE, st.floats(0.0, 1.0))
SCALE = st.sampled_from(sorted(SCALES))


@given(st.lists(LETTERED, min_size=1, max_size=8))
def test_letters_that_are_written_read_back_the_same(terms):
    assert list(parse_facs(format_facs(terms))) == terms


@given(st.lists(TERMS, max_size=8), SCALE)
def test_what_is_printed_reads_back_the_same(terms, scale):
    read = parse_facs(print_facs(terms, scale), scale)
    assert list(read) == sorted(terms, key=lambda term: term.order)


@given(st.lists(TERMS, max_size=8), SCALE)
def test_the_canonical_form_is_one(terms, scale):
    printed = print_facs(terms, scale)
    assert print_facs(parse_facs(printed, scale), scale) == printed


@given(st.lists(st.builds(Term, NAME, SIDE, st.sampled_from(sorted(BANDED.values()))), max_size=8))
def test_intensities_of_a_scale_are_written_as_its_letters(terms):
    assert ":" not in print_facs(terms, "banded")


@given(TERMS)
def test_a_unit_is_named_the_same_as_a_key_and_in_a_string(term):
    assert term_of(term.key, term.intensity) == term
    assert split_side(term.key) == (term.name, term.side)


def test_units_are_printed_in_the_order_of_facs():
    terms = parse_facs("M61C+61C+R12D+26+12A+L12B+B28E+T28A+4:0.37+1c")
    assert print_facs(terms) == "1C+4:0.37+12A+L12B+R12D+26C+T28A+B28E+61C+M61C"


def test_a_face_without_units_is_code_0():
    assert print_facs([]) == "0"
    assert parse_facs("0") == parse_facs(" au0 ") == ()
    with pytest.raises(InvalidNotation, match="stands alone"):
        parse_facs("0+12C")


def test_letters_stand_for_other_numbers_on_the_banded_scale():
    assert parse_facs("12A+15", "banded") == (Term("AU12", "", 0.1), Term("AU15", "", 0.55))
    assert print_facs(parse_facs("12A+15", "banded")) == "12:0.1+15:0.55"
    assert print_facs(parse_facs("12D"), "banded") == "12:0.8"
    assert letter_of(0.55, "banded") == "C"
    assert letter_of(0.55) is None
    assert [nearest_letter(0.3, scale) for scale in ("linear", "banded")] == ["A", "B"]
    with pytest.raises(UnknownName, match="logarithmic"):
        parse_facs("12", "logarithmic")


def test_spaces_case_and_long_names_are_allowed():
    expected = (Term("AU1", "", 0.6), Term("AU12", "L", 0.8), Term("AU26", "", 0.6))
    assert parse_facs(" 1c + l12D+AU26 ") == expected
    assert parse_facs("01*")[0] == Term("AU1", "", 0.6)
    assert parse_facs("t28 b + bAU22e + m59") == (
        Term("AU28", "T", 0.4),
        Term("AU22", "B", 1.0),
        Term("M59", "", 0.6),
    )
    assert parse_facs("AD19D + lad33") == (Term("AU19", "", 0.8), Term("AU33", "L", 0.6))
    assert parse_facs("12 : .5 + 4:1e-2") == (Term("AU12", "", 0.5), Term("AU4", "", 0.01))


@pytest.mark.parametrize(
    "text",
    [
        *("", "12F", "12+", "smile", "L", "12 13", "X12A", "1" * 5000, "100", "12:", "12:C"),
        *("12C:0.5", "12:-0.5", "12:1.01", "12:1e9", "12:inf", "12:nan", "LR12", "\u0661\u0662"),
    ],
)
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
    assert split_side("t28") == ("AU28", "T")
    assert split_side("AD19") == ("AU19", "")
    with pytest.raises(InvalidNotation, match="smile"):
        split_side("smile")


def test_the_curve_is_followed_between_its_knots():
    unit = ActionUnit("AU1", "", curve=((0.0, 0.0), (0.5, 0.2), (1.0, 1.0)))
    assert unit.scale(0.0) == 0.0
    assert unit.scale(0.25) == pytest.approx(0.1)
    assert unit.scale(0.75) == pytest.approx(0.6)
    assert unit.scale(1.0) == 1.0
