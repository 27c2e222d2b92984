"""Maps of a few texels, for tests of files that embed some: nothing is baked."""

from __future__ import annotations

import io
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from PIL import Image
from small_face import small_rig

from engine.head.textures import TEXTURE_NAMES


def small_textures() -> dict[str, bytes]:
    """Return an image of 4 x 4 texels under the name of each map."""
    return {name: _image(10 * index) for index, name in enumerate(TEXTURE_NAMES)}


def _image(level: int) -> bytes:
    file = io.BytesIO()
    Image.fromarray(np.full((4, 4, 3), 128 + level, np.uint8)).save(file, "JPEG")
    return file.getvalue()


def textured_rig() -> Any:
    """Return the small rig with its skin and eyes laid out on their maps."""
    rig = small_rig()
    drawn = rig.head.drawn
    flat = drawn.vertices[:, :2]
    uvs = (flat - flat.min(axis=0)) / np.ptp(flat, axis=0)
    eyes = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.5, 0.5]])
    parts = tuple(
        replace(part, uvs=eyes) if part.material == "eye" else part for part in rig.head.parts
    )
    head = replace(rig.head, drawn=replace(drawn, uvs=uvs), parts=parts)
    return SimpleNamespace(**{**vars(rig), "head": head})
