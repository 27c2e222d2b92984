"""People drawn by a number: the same every time, all kinds, what is named kept."""

from __future__ import annotations

import pytest

from engine import InvalidValue, Recipe


def test_a_number_is_a_person() -> None:
    assert Recipe.of({"sample": 7}) == Recipe.of({"sample": 7})
    assert Recipe.of({"sample": 7}) == Recipe.of({"sample": True, "seed": 7})
    assert Recipe.of({"sample": 7}) != Recipe.of({"sample": 8})


def test_what_is_named_is_kept_and_changes_nothing_else() -> None:
    free, kept = Recipe.of({"sample": 7}), Recipe.of({"sample": 7, "nose_width": 1.5})
    assert kept.nose_width == 1.5
    assert {**free.to_json(), "nose_width": 1.5} == kept.to_json()
    assert Recipe.of({"sample": 7, "skin": "dark"}).eye_color in ("brown", "dark_brown")


def test_many_are_of_all_kinds() -> None:
    crowd = [Recipe.of({"sample": number}) for number in range(200)]
    assert 70 < sum(person.sex == 0.0 for person in crowd) < 130
    assert min(person.age for person in crowd) < 25 < 70 < max(person.age for person in crowd)
    assert len({person.hair_color for person in crowd}) > 5
    assert len({person.eye_color for person in crowd}) > 5
    assert all(person.stubble == 0.0 for person in crowd if person.sex == 0.0)


@pytest.mark.parametrize("number", [-1, 2**32, 1.5, "seven", [7]])
def test_a_number_that_is_none_is_refused(number: object) -> None:
    with pytest.raises(InvalidValue, match="sample"):
        Recipe.of({"sample": number})


def test_grey_and_stubble_go_with_age_and_sex() -> None:
    old = Recipe.of({"age": 75})
    assert old.grayness > 0.8
    assert Recipe.of({"age": 25}, old).grayness == 0.0
    assert Recipe.of({"age": 75, "grayness": 0.1}).grayness == 0.1
    assert Recipe.of({"sex": "female"}).stubble == 0.0
