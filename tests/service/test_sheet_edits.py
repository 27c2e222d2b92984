"""Edited rigs on contact sheets: what each is called, and what is no edit."""

from __future__ import annotations

import json

import pytest

from service.sheet import name_of
from service.sheet_edits import Edit, EditRefused, read_edits

LEFT = {"side": "left", "grade": "IV"}


@pytest.mark.parametrize(
    ("body", "label"),
    [
        ({"palsy": LEFT}, "palsy left IV"),
        ({"palsy": {"side": "both", "gain": 0.3}}, "palsy both gain 0.3"),
        ({"tissue_age": 78}, "tissue age 78"),
        ({"tissue_age": "old", "palsy": LEFT}, "tissue age old, palsy left IV"),
        ({"relaxed": {"procerus": 0.9}}, "relaxed procerus 0.9"),
        ({"relaxed": {"procerus": {"left": 0.4}}}, "relaxed procerus left 0.4"),
        ({"tissue": {"region_laxity": {"cheek.L": 1}}}, "tissue region laxity cheek.L 1"),
        ({"tissue": {"tissue_depth": [9.5] * 900}}, "tissue tissue depth (a map)"),
        ({"palsy": LEFT, "name": "Bell's palsy"}, "Bell's palsy"),
    ],
)
def test_an_edit_is_called_what_it_does_unless_it_has_a_name(body: object, label: str) -> None:
    (edit,) = read_edits([json.dumps(body)])
    assert edit.label == label


def test_an_edit_asks_for_what_was_written_and_no_more() -> None:
    (edit,) = read_edits([json.dumps({"palsy": LEFT, "passing": True})])
    assert edit.changes == {"palsy": LEFT}


def test_a_long_edit_has_a_short_label() -> None:
    muscles = {f"zygomatic_{part}": 0.5 for part in ("major", "minor", "other", "last")}
    (edit,) = read_edits([json.dumps({"relaxed": muscles})])
    assert len(edit.label) == 60
    assert edit.label.endswith("…")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"palsi": {}}', "there is no field 'palsi'; did you mean 'palsy'"),
        ('{"palsy": {"side": "left", "grad": "IV"}}', "'grad' in palsy; did you mean 'grade'?"),
        ('{"palsy": {"side": "up", "grade": "IV"}}', "palsy.side is 'up'; expected one of 'left'"),
        ('{"relaxed": {"procerus": NaN}}', "cannot be used"),
        ("palsy", "is not JSON (expecting value at character 1); write it like"),
        ("[" * 100_000, "is not JSON"),
        ("[]", "expected an object"),
        ("{}", "changes nothing"),
        ('{"name": "nobody"}', "changes nothing"),
        ('{"base": "mei", "tissue_age": 50}', "name it with --rig"),
    ],
)
def test_what_is_no_edit_is_said_in_plain_words(text: str, said: str) -> None:
    with pytest.raises(EditRefused) as refused:
        read_edits([text])
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 400


def test_two_edits_have_two_labels() -> None:
    with pytest.raises(EditRefused, match='give each a "name" of its own'):
        read_edits(['{"tissue_age": 50}', '{"tissue_age": 50.0}'])


def test_a_face_is_called_by_its_edit_and_by_its_rig_where_there_are_several() -> None:
    edit = Edit("tissue age 78", {"tissue_age": 78})
    assert name_of("mei", None, several=False) == "mei"
    assert name_of("mei", edit, several=False) == "tissue age 78"
    assert name_of("mei", edit, several=True) == "mei, tissue age 78"
