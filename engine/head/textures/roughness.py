"""The roughness of the skin: oily in the middle of the face, glossy lips, dull where hair grows."""

from __future__ import annotations

import numpy as np

from ...arrays import Float32Array, FloatArray
from ..anatomy import smoothstep
from ..noise import noise
from ..recipe import Recipe
from .texels import Texels
from .zones import Zones


def roughness(
    texels: Texels, zones: Zones, places: FloatArray, heights: Float32Array, recipe: Recipe
) -> Float32Array:
    """Return glTF roughness of texels, shape (n,).

    Args:
        texels: Where they lie.
        zones: Fields over the skin.
        places: Positions of the vertices on the built-in head [mm], shape (d, 3).
        heights: Relief [mm], shape (n,): what lies deep is dull.
        recipe: The person.
    """
    age = np.clip((recipe.age - 30) / 50, 0, 1)
    lip = smoothstep(-0.8, 2.4, zones.lip)
    broad = 0.535 - 0.115 * zones.oil * (1 - 0.4 * age) + 0.05 * age
    broad = broad + 0.055 * zones.beard * recipe.sex + 0.07 * zones.violet
    broad = broad + 0.012 * noise(places, 9.0, 81) + 0.012 * noise(places, 4.0, 82)
    broad = broad + (0.40 + 0.05 * age - broad) * lip
    broad = broad + (0.66 - broad) * np.clip(0.8 * zones.scalp, 0, 1)
    # The lids' edges are moist; wet is the tear line, which is a part of its own.
    broad = broad + (0.44 - broad) * zones.lid**2
    broad = broad + (0.24 - broad) * zones.mouth
    pits = np.clip(-heights * 1.6, -0.05, 0.12)
    return np.asarray(np.clip(texels.carried(broad) + pits, 0.05, 1), dtype=np.float32)
