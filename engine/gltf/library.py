"""The library that writes glTF, imported when it is first used, for a start does without."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

if TYPE_CHECKING:
    import pygltflib
else:

    class _Later:
        """The library from when it is first used: a start does without."""

        def __getattr__(self, name):
            return getattr(importlib.import_module("pygltflib"), name)

    pygltflib = _Later()

__all__ = ["Array", "Extras", "Textures", "append", "pygltflib"]

Array = npt.NDArray[Any]
Extras = Mapping[str, Any]
Textures = Mapping[str, bytes]
"""Maps of a head by file name."""


def append(items: list[Any], item: Any) -> int:
    """Append to one of a file's lists; return the index that glTF knows it by."""
    items.append(item)
    return len(items) - 1
