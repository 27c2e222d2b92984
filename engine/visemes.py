"""Oculus' 15 visemes as units and jaw: the shapes of a mouth that speaks."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from .blend import Blend, Shape, ShapeTable, blend, check_weight, read_table
from .errors import InvalidValue, UnknownName

_PREFIX = "viseme_"


@lru_cache(maxsize=1)
def viseme_table() -> ShapeTable:
    """Return the table, read from `engine/data/visemes.json`."""
    return read_table("visemes.json")


def find_viseme(name: str) -> Shape:
    """Return what a name means: `ih`, `I` or `viseme_I`, in either case.

    Raises:
        UnknownName: With the names there are.
    """
    found = _names().get(_normal(name))
    if found is None:
        raise UnknownName("viseme", name, viseme_table().shapes)
    return found


def viseme_shapes(weights: Mapping[str, float]) -> list[tuple[Shape, float]]:
    """Return the visemes that are named, each with its weight.

    Raises:
        UnknownName: For a name that is no viseme.
        InvalidValue: For a weight that is not from 0 to 1, or a viseme that is named twice.
    """
    seen: dict[str, str] = {}
    shapes = []
    for name, weight in weights.items():
        shape = find_viseme(name)
        if shape.name in seen:
            raise InvalidValue(
                f"visemes.{name} and visemes.{seen[shape.name]} are the same; send one"
            )
        seen[shape.name] = name
        shapes.append((shape, check_weight("visemes", name, weight)))
    return shapes


def viseme_blend(weights: Mapping[str, float]) -> Blend:
    """Return the whole mouth that visemes' weights, 0..1 by name, come to.

    What visemes move, and these do not, is let go: it stands there as 0.

    Raises:
        UnknownName: For a name that is no viseme.
        InvalidValue: For a weight that is not from 0 to 1, or a viseme that is named twice.
    """
    every = [(shape, 0.0) for shape in viseme_table().shapes.values()]
    return blend([*every, *viseme_shapes(weights)])


@lru_cache(maxsize=1)
def _names() -> Mapping[str, Shape]:
    shapes = viseme_table().shapes.values()
    return {_normal(name): shape for shape in shapes for name in (shape.name, *shape.aliases)}


def _normal(name: str) -> str:
    return name.strip().lower().removeprefix(_PREFIX)
