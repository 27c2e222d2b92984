"""The skin's colour from its pigments: a tone by typology angle, changed by melanin and blood.

Tones are CIELAB measures of forehead and cheek by class of individual typology angle (Chardon,
Cretois, Hourseau 1991; ITA = atan((L* - 50) / b*)), rounded. Changes are densities: what a pigment
takes from the light that comes back, as in Tsumura et al. 1999 ("Independent-component analysis of
skin color image"); the two spectra are red, green, blue means of melanin's and haemoglobin's.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..recipe import Recipe

TONES = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
"""Recipe.skin of each row of `TONE_LAB`."""
TONE_LAB = np.array([
    [72.0, 9.0, 13.0],
    [67.0, 11.0, 15.5],
    [61.5, 12.5, 17.5],
    [55.5, 13.5, 19.0],
    [45.5, 13.5, 18.0],
    [35.5, 11.5, 13.5],
])  # fmt: skip
"""L*, a*, b* of the bare forehead."""
UNDERTONE_LAB = np.array([0.0, -1.6, 1.7])
"""Change of the tone from neutral to warm; half of it on dark skin."""
MELANIN = np.array([0.42, 0.68, 0.95])
"""Density of one unit of melanin in red, green and blue."""
BLOOD = np.array([0.12, 0.80, 0.62])
"""Density of one unit of haemoglobin."""
CAROTENE = np.array([0.02, 0.10, 0.55])
"""Density of one unit of carotene, the yellow of thick and fat skin."""


def tone(recipe: Recipe) -> FloatArray:
    """Return the forehead's colour of a recipe in linear light, shape (3,)."""
    lab = np.array([np.interp(recipe.skin, TONES, TONE_LAB[:, axis]) for axis in range(3)])
    return linear_of_lab(lab + recipe.undertone * (1 - 0.5 * recipe.skin) * UNDERTONE_LAB)


def blood_visibility(recipe: Recipe) -> float:
    """Return how much of a blush shows through the melanin above it."""
    return float(1 - 0.5 * recipe.skin**1.3)


def pigmented(
    base: FloatArray, melanin: FloatArray, blood: FloatArray, carotene: FloatArray
) -> FloatArray:
    """Return linear colours (n, 3) of a base (3,) with more or less of each pigment, (n,) each."""
    density = np.outer(melanin, MELANIN) + np.outer(blood, BLOOD) + np.outer(carotene, CAROTENE)
    return np.asarray(base * np.exp(-density))


def linear_of_lab(lab: FloatArray) -> FloatArray:
    """Return linear sRGB (..., 3) of CIELAB under D65."""
    fy = (lab[..., 0] + 16) / 116
    f = np.stack([fy + lab[..., 1] / 500, fy, fy - lab[..., 2] / 200], axis=-1)
    xyz = np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * WHITE
    return np.asarray(np.clip(xyz @ np.linalg.inv(XYZ_OF_LINEAR).T, 0.0, 1.0))


def srgb(linear: FloatArray) -> FloatArray:
    """Return linear light 0..1 as sRGB 0..1 (IEC 61966-2-1)."""
    low = linear <= 0.0031308
    return np.asarray(
        np.where(low, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    )


XYZ_OF_LINEAR = np.array([
    [0.4124564, 0.3575761, 0.1804375],
    [0.2126729, 0.7151522, 0.0721750],
    [0.0193339, 0.1191920, 0.9503041],
])  # fmt: skip
WHITE = XYZ_OF_LINEAR.sum(axis=1)
