"""Colours as instruments measure them on skin: CIELAB, and the individual typology angle."""

from __future__ import annotations

import numpy as np

from engine.arrays import FloatArray
from engine.head.textures.pigment import WHITE, XYZ_OF_LINEAR


def lab_of_linear(linear: FloatArray) -> FloatArray:
    """Return CIELAB under D65 of linear sRGB (..., 3)."""
    xyz = linear @ XYZ_OF_LINEAR.T / WHITE
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    rows = [116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])]
    return np.asarray(np.stack(rows, axis=-1))


def typology_angle(linear: FloatArray) -> FloatArray:
    """Return the individual typology angle [degrees] of linear colours (..., 3)."""
    lab = lab_of_linear(linear)
    return np.asarray(np.degrees(np.arctan2(lab[..., 0] - 50, lab[..., 2])))
