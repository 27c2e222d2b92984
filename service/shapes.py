"""ARKit's shapes and visemes in a command: what a rig plays of them, and what it cannot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from engine import (
    Blend,
    EngineError,
    FacsWarning,
    Rig,
    Shape,
    arkit_blend,
    arkit_shapes,
    split_name,
    viseme_blend,
    viseme_shapes,
)

from .bodies import Controls
from .errors import refused_by_engine
from .facs import playable


@dataclass(frozen=True)
class Shaped:
    """What the shapes of a command come to on a rig.

    Attributes:
        units: Intensities by key, without those that the command names by themselves.
        axes: Degrees or mm by axis, by "jaw", "gaze" and "tongue".
        warnings: What is played otherwise than it was named, or not at all.
    """

    units: Mapping[str, float]
    axes: Mapping[str, Mapping[str, float]]
    warnings: tuple[FacsWarning, ...]


def shaped(controls: Controls, rig: Rig) -> Shaped:
    """Return what the shapes of a command come to on `rig`.

    Raises:
        Unprocessable: For a name that is not known, a weight that is not from 0 to 1, or a shape
            that is named twice.
    """
    try:
        arkit = arkit_blend(controls.arkit or {})
        named = arkit_shapes(controls.arkit or {})
        spoken = Blend() if controls.visemes is None else viseme_blend(controls.visemes)
        named += viseme_shapes(controls.visemes or {})
    except EngineError as error:
        raise refused_by_engine(error) from error
    itself = playable(controls, rig).units
    sums = [arkit.without(itself), spoken.without([*itself, *arkit.units])]
    units = {key: value for blend in sums for key, value in blend.units.items()}
    axes = {
        group: {**spoken.axes.get(group, {}), **arkit.axes.get(group, {})}
        for group in {*spoken.axes, *arkit.axes}
    }
    warnings = [*_not_played(named, rig), *_said_twice(named, itself)]
    return Shaped(units, axes, tuple(dict.fromkeys(warnings)))


def _not_played(named: list[tuple[Shape, float]], rig: Rig) -> Iterator[FacsWarning]:
    """What no unit does, and what moves nothing on this rig."""
    for shape, weight in named:
        if weight and shape.stands_in:
            yield FacsWarning("stands_in", (shape.name,), f"{shape.name}: {shape.stands_in}")
        still = [key for key in shape.units if rig.resolve_unit(key)[0].still]
        if weight and still and not shape.axes and len(still) == len(shape.units):
            message = f"{shape.name}: {' and '.join(still)} moves nothing on this rig"
            yield FacsWarning("still", (shape.name,), message)


def _said_twice(
    named: list[tuple[Shape, float]], itself: Mapping[str, float]
) -> Iterator[FacsWarning]:
    """Units that the command names by themselves, which count."""
    own = {place: key for key in itself for place in _places(key)}
    for shape, weight in named:
        hits = [own[place] for key in shape.units for place in _places(key) if place in own]
        for key in dict.fromkeys(hits) if weight else ():
            message = f"{key} is named itself, so {shape.name} does not move it"
            yield FacsWarning("named_itself", (key,), message)


def _places(key: str) -> list[tuple[str, str]]:
    name, side = split_name(key)
    return [(name, each) for each in side or "LR"]
