"""A rig's textures, kept on disk: baked once for each person and engine."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .cache import Arrays, cached_arrays
from .head.recipe import STANDARD
from .head.storage import source_key
from .head.textures import TEXTURE_NAMES, head_textures
from .rig import Rig

Bake = Callable[[Rig, Callable[[], bool] | None], dict[str, bytes]]


def texture_names(rig: Rig) -> tuple[str, ...]:
    """Return the files of a rig's textures; none for a head that is not laid out on any."""
    return TEXTURE_NAMES if rig.head.drawn.uvs is not None else ()


def textures_of(
    rig: Rig,
    *,
    bake: Bake | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> dict[str, bytes]:
    """Return a rig's textures by file name; the first time takes seconds.

    All levels of detail of a person share them.

    Args:
        rig: Whose textures.
        bake: Makes them if nobody has; `bake_textures` if None.
        cancelled: Asked between the maps whether to stop.

    Raises:
        Cancelled: `cancelled` said so.
    """
    if not texture_names(rig):
        return {}

    def baked() -> Arrays:
        files = (bake or bake_textures)(rig, cancelled)
        return {name: np.frombuffer(data, dtype=np.uint8) for name, data in files.items()}

    vertices = rig.at_level("high").head.drawn.vertices
    key = source_key("textures", rig.recipe or STANDARD, vertices)
    return {name: data.tobytes() for name, data in cached_arrays("textures", key, baked).items()}


def bake_textures(rig: Rig, cancelled: Callable[[], bool] | None = None) -> dict[str, bytes]:
    """Return a rig's textures by file name, made anew.

    Args:
        rig: Whose textures.
        cancelled: Asked between the maps whether to stop.

    Raises:
        Cancelled: `cancelled` said so.
    """
    head = rig.at_level("high").head
    return head_textures(head, rig.recipe or STANDARD, cancelled=cancelled)
