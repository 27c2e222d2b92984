"""What a recipe may ask for."""

from __future__ import annotations

from engine import Recipe, recipe_attributes


def test_every_attribute_is_described_and_its_limits_are_held() -> None:
    described = recipe_attributes()
    assert set(described) == set(Recipe().to_json())
    assert "hazel" in described["eye_color"]["choices"]  # type: ignore[operator]
    assert described["skin"]["words"]["dark"] == 1.0  # type: ignore[index]
    for name, attribute in described.items():
        for value in attribute.get("range", attribute.get("choices", ())):  # type: ignore[attr-defined]
            Recipe.of({name: value})
