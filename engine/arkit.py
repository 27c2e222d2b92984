"""ARKit's 52 blend shapes as units and axes, by the names that phones and trackers send."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache

from .blend import Blend, Shape, ShapeTable, blend, check_weight, read_table
from .errors import InvalidValue, UnknownName

_SIDE = re.compile(r"_([lr])$")
_SIDES = {"left": "L", "right": "R"}
_NEUTRAL = Shape("_neutral", "MediaPipe: how much of the face is at rest; it moves nothing")


@lru_cache(maxsize=1)
def arkit_table() -> ShapeTable:
    """Return the table, read from `engine/data/arkit.json`."""
    return read_table("arkit.json")


def find_arkit(name: str) -> Shape:
    """Return what a name means: `eyeBlinkLeft`, `EyeBlinkLeft` or `eyeBlink_L`.

    A side may be said of `browInnerUp` and `cheekPuff` too, as ICT-FaceKit does, and MediaPipe's
    `_neutral` is taken for nothing.

    Raises:
        UnknownName: With the nearest names.
    """
    shape = known_arkit(name)
    if shape is not None:
        return shape
    normal = _normal(name)
    table = arkit_table().shapes
    nearest = [each for each in table if _normal(each) in _near(normal)]
    raise UnknownName("ARKit shape", name, table, nearest=nearest)


def known_arkit(name: str) -> Shape | None:
    """Return what a name means, as `find_arkit`, and None of any other; it looks for none near."""
    return _names().get(_normal(name))


def arkit_shapes(weights: Mapping[str, float]) -> list[tuple[Shape, float]]:
    """Return the shapes that are named, each with its weight.

    Raises:
        UnknownName: For a name that ARKit does not have.
        InvalidValue: For a weight that is not from 0 to 1, or a shape that is named twice.
    """
    seen: dict[str, str] = {}
    shapes = []
    for name, weight in weights.items():
        shape, normal = find_arkit(name), _normal(name)
        if normal in seen:
            raise InvalidValue(f"arkit.{name} and arkit.{seen[normal]} are the same; send one")
        seen[normal] = name
        shapes.append((shape, check_weight("arkit", name, weight)))
    return shapes


def arkit_blend(weights: Mapping[str, float]) -> Blend:
    """Return what ARKit's weights, 0..1 by name, come to.

    Raises:
        UnknownName: For a name that ARKit does not have.
        InvalidValue: For a weight that is not from 0 to 1, or a shape that is named twice.
    """
    return blend(arkit_shapes(weights))


@lru_cache(maxsize=1)
def _names() -> Mapping[str, Shape]:
    names = {_normal(_NEUTRAL.name): _NEUTRAL}
    for shape in arkit_table().shapes.values():
        names[_normal(shape.name)] = shape
        for word, side in _SIDES.items() if shape.halves else ():
            names[_normal(shape.name + word)] = shape.half(side)
    return names


def _near(normal: str) -> list[str]:
    return UnknownName("ARKit shape", normal, _names()).nearest


def _normal(name: str) -> str:
    """Return a name in small letters, without underscores, its side written out."""
    words = {"l": "left", "r": "right"}
    sided = _SIDE.sub(lambda match: words[match[1]], name.strip().lower())
    return sided.replace("_", "")
