"""What an edit of tissue or of a muscle may say, as JSON Schema (draft 2020-12).

Which values fit together (k_L below k_H, regions that a head has, a muscle's own fields) depends on
the rig, and is checked when it is derived.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from .rig import EDITABLE, MOST_OF_A_MUSCLE
from .tissue import LAYERS, Layered, TissueParameters
from .tissue.parameters import LIMITS, MAP_LIMITS, POINT_MAPS, STIFFNESS_LIMITS

Schema = dict[str, Any]

_NUMBER: Schema = {
    "type": "number",
    "minimum": -MOST_OF_A_MUSCLE,
    "maximum": MOST_OF_A_MUSCLE,
}
_POINT: Schema = {"type": "array", "items": _NUMBER, "minItems": 3, "maxItems": 3}
_MUSCLE_FIELDS: dict[str, Schema] = {
    **{name: _POINT for name in ("center", "plane", "normal", "extent")},
    # A sheet has two of each, the ends of its lines.
    **{
        name: {"anyOf": [_POINT, {"type": "array", "items": _POINT, "minItems": 2, "maxItems": 2}]}
        for name in ("attachment", "insertion")
    },
    "gain": {"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}]},
}


def tissue_edit_schema() -> Schema:
    """Return the schema of changes of tissue constants, as `TissueParameters.edited` takes them."""
    usual = TissueParameters()
    return _object({f.name: _constant(f.name, getattr(usual, f.name)) for f in fields(usual)})


def muscle_edit_schema() -> Schema:
    """Return the schema of changes of one muscle, of whatever kind; lengths in mm."""
    return _object({name: _MUSCLE_FIELDS.get(name, _NUMBER) for name in EDITABLE})


def _constant(name: str, usual: object) -> Schema:
    if isinstance(usual, Layered):
        return _object({layer: _between(*STIFFNESS_LIMITS) for layer in LAYERS})
    if isinstance(usual, bool):
        return {"type": "boolean"}
    if name not in MAP_LIMITS:
        return _between(*LIMITS[name])
    entry = _between(*MAP_LIMITS[name])
    forms: list[Schema] = [{"type": "object", "additionalProperties": entry}, {"type": "null"}]
    if name in POINT_MAPS:
        forms.append({"type": "array", "items": entry})
    return {"anyOf": forms}


def _between(least: float, most: float) -> Schema:
    return {"type": "number", "minimum": least, "maximum": most}


def _object(properties: dict[str, Schema]) -> Schema:
    return {"type": "object", "properties": properties, "additionalProperties": False}
