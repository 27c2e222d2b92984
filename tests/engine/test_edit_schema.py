"""What edits may say, as a schema: what it allows is taken, what it forbids is not."""

from __future__ import annotations

from dataclasses import fields

import pytest

from engine import EngineError, builtin_rig, muscle_edit_schema, tissue_edit_schema
from engine.tissue import LAYERS, TissueParameters

NUMBERS = {
    name: schema
    for name, schema in tissue_edit_schema()["properties"].items()
    if schema.get("type") == "number"
}


def test_every_constant_of_tissue_is_described() -> None:
    described = tissue_edit_schema()
    assert set(described["properties"]) == {f.name for f in fields(TissueParameters)}
    assert described["additionalProperties"] is False


@pytest.mark.parametrize("name", NUMBERS)
def test_a_constant_may_be_what_its_schema_says_and_no_more(name: str) -> None:
    usual = TissueParameters()
    least, most = NUMBERS[name]["minimum"], NUMBERS[name]["maximum"]
    for value in (least, most):
        assert getattr(usual.edited({name: value}), name) == value
    for value in (least - 1.0, most + 1.0):
        with pytest.raises(EngineError, match=name):
            usual.edited({name: value})


def test_layers_and_maps_may_be_what_their_schemas_say_and_no_more() -> None:
    usual, described = TissueParameters(), tissue_edit_schema()["properties"]
    assert set(described["stiffness_low"]["properties"]) == set(LAYERS)
    for name in ("region_laxity", "skin_thickness"):
        entry = described[name]["anyOf"][0]["additionalProperties"]
        for value in (entry["minimum"], entry["maximum"]):
            assert getattr(usual.edited({name: {"any": value}}), name) == {"any": value}
        with pytest.raises(EngineError, match=f"{name}.any"):
            usual.edited({name: {"any": entry["maximum"] + 1.0}})
        assert {"type": "null"} in described[name]["anyOf"]
        assert not getattr(usual.edited({name: None}), name)


def test_every_field_of_every_muscle_that_may_be_edited_is_described() -> None:
    described = muscle_edit_schema()["properties"]
    rig = builtin_rig("standard")
    for muscle in {muscle.kind: muscle for muscle in rig.muscles}.values():
        for name in described:
            if not hasattr(muscle, name):
                with pytest.raises(EngineError, match=name):
                    rig.derive(muscles={muscle.name: {name: 1.0}})
                continue
            value = getattr(muscle, name)
            same = rig.derive(muscles={muscle.name: {name: value}})
            assert same.muscle(muscle.name) == muscle
            assert _allows(described[name], value), name


def _allows(schema: dict[str, object], value: object) -> bool:
    """Tell whether a schema of numbers and lists of them allows a value."""
    forms = schema.get("anyOf")
    if isinstance(forms, list):
        return any(_allows(form, value) for form in forms)
    if schema["type"] == "number":
        low, high = schema["minimum"], schema["maximum"]
        return isinstance(value, int | float) and low <= value <= high  # type: ignore[operator]
    items = schema["items"]
    return (
        isinstance(value, tuple)
        and len(value) == schema["minItems"]
        and all(_allows(items, each) for each in value)  # type: ignore[arg-type]
    )
