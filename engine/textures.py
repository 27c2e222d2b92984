"""A rig's textures, kept on disk: baked once for each person and engine."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .cache import Arrays, cached_arrays
from .head.recipe import STANDARD
from .head.storage import source_key
from .head.textures import TEXTURE_NAMES, head_textures
from .rig import Rig


def texture_names(rig: Rig) -> tuple[str, ...]:
    """Return the files of a rig's textures; none for a head that is not laid out on any."""
    return TEXTURE_NAMES if rig.head.drawn.uvs is not None else ()


def textures_of(rig: Rig, *, cancelled: Callable[[], bool] | None = None) -> dict[str, bytes]:
    """Return a rig's textures by file name; the first time takes seconds.

    All levels of detail of a person share them.

    Args:
        rig: Whose textures.
        cancelled: Asked between the maps whether to stop.

    Raises:
        Cancelled: `cancelled` said so.
    """
    if not texture_names(rig):
        return {}
    full = rig.at_level("high").head
    recipe = rig.recipe or STANDARD

    def baked() -> Arrays:
        files = head_textures(full, recipe, cancelled=cancelled)
        return {name: np.frombuffer(data, dtype=np.uint8) for name, data in files.items()}

    key = source_key("textures", recipe, full.drawn.vertices)
    return {name: data.tobytes() for name, data in cached_arrays("textures", key, baked).items()}
