"""What a recipe may ask for."""

from __future__ import annotations

from engine import Recipe, people, recipe_attributes


def test_every_attribute_is_described_and_its_limits_are_held() -> None:
    described = recipe_attributes()
    assert set(described) == set(Recipe().to_json())
    assert "hazel" in described["eye_color"]["choices"]  # type: ignore[operator]
    assert described["skin"]["words"]["dark"] == 1.0  # type: ignore[index]
    for name, attribute in described.items():
        for value in attribute.get("range", attribute.get("choices", ())):  # type: ignore[attr-defined]
            Recipe.of({name: value})


def test_hair_is_cut_as_is_usual_unless_it_is_named() -> None:
    woman = Recipe.of({"sex": "female", "age": 60})
    assert woman.hair_style == "bob"
    assert Recipe.of({"skin": "dark"}, woman).hair_style == "curly"
    assert Recipe.of({"sex": "male"}, woman) == Recipe.of({"age": 60})
    assert Recipe.of({"age": 60, "skin": "dark"}).hair_style == "crop"
    cropped = Recipe.of({"sex": "female", "hair_style": "crop"})
    assert cropped.hair_style == Recipe.of({"age": 60}, cropped).hair_style == "crop"


def test_a_recipe_in_full_reads_back_the_same() -> None:
    for person in people().values():
        assert Recipe.of(person.recipe.to_json()) == person.recipe
    shorn = Recipe(sex=0.0, hair_style="crop")
    assert Recipe.of(shorn.to_json()) == shorn
