"""Who moves what: for each thing that the layers of a face hold, the layers that hold it."""

from __future__ import annotations

from collections.abc import Mapping

from .facs import with_facs

_NAMED = ("action_units", "muscles")
_POSED = ("jaw", "gaze", "head", "tongue")


def with_writers(report: Mapping[str, object]) -> dict[str, object]:
    """Return a face's report with what its layers make together told by layer and by owner.

    Beside it stand `facs`; `writers`: for each thing the layers that hold it; and `owners`: for
    each thing who holds it where.
    """
    layers, merged = report["layers"], report["merged"]
    assert isinstance(layers, Mapping)
    assert isinstance(merged, Mapping)
    told = {**merged, "writers": writers(layers), "owners": owners(layers)}
    return with_facs({**report, "merged": told})


def writers(layers: Mapping[str, Mapping[str, object]]) -> dict[str, list[str]]:
    """Return the layers, from the lowest, that hold each thing.

    Things are named as commands name them: "AU12", "L12", "zygomatic_major.L", "jaw.pitch".
    """
    found: dict[str, list[str]] = {}
    for layer, held in layers.items():
        for name in _names(held):
            found.setdefault(name, []).append(layer)
    return found


def owners(layers: Mapping[str, Mapping[str, object]]) -> dict[str, list[dict[str, str]]]:
    """Return the layer and owner of everyone who holds each thing, from the lowest."""
    found: dict[str, list[dict[str, str]]] = {}
    for layer, held in layers.items():
        by = held["writers"]
        assert isinstance(by, list)
        for writer in by:
            for name in _names(writer):
                found.setdefault(name, []).append({"layer": layer, "owner": writer["owner"]})
    return found


def _names(held: Mapping[str, object]) -> list[str]:
    names: list[str] = []
    for group in (*_NAMED, *_POSED):
        things = held.get(group, {})
        assert isinstance(things, Mapping)
        names += [f"{group}.{name}" if group in _POSED else str(name) for name in things]
    return names
