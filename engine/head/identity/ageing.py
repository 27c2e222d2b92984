"""What sex, weight and years do to a face: its form and its tissue.

Form: the nose and ears go on growing and the tip sinks, lips thin and the upper lip lengthens
(Farkas; Albert, Ricanek, Patterson 2007; Sforza et al. 2009), brows and lids descend, temples,
cheeks and orbits hollow, the maxilla retreats and ligaments hold while the skin between them sags
into folds and jowls (Mendelson and Wong, 2012). Most of it starts at about 35.

Tissue: skin's elasticity falls by about half from 20 to 80 (Cua, Wilhelm, Maibach 1990; Escoffier
et al. 1989), so that pre-tension and the dermis' low stiffness fall and fibres straighten later;
the epidermis stiffens, fat and ligaments slacken. Extents were chosen within those trends and kept
where the face stays stable.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import FloatArray
from ..recipe import Recipe

_ONSET, _FULL = 32.0, 85.0


def years_shown(age: float, onset: float = _ONSET, full: float = _FULL) -> float:
    """Return how much of ageing shows at `age`: 0 to `onset`, 1 at `full`, a little more beyond."""
    share = max(0.0, age - onset) / (full - onset)
    return float(share**1.25)


_PER_FULL_AGE: Mapping[str, float] = {
    "nose_tip": -2.2,
    "ear_length": 5.0,
    "lobule": 3.0,
    "upper_lid": 0.7,
    "lower_lid": 0.4,
    "fold": 1.5,
    "hood": 2.0,
    "brow_ptosis": 2.0,
    "temple": -3.2,
    "cheek": -2.4,
    "mid_cheek": -1.7,
    "tear_trough": 3.2,
    "eye_bag": 2.4,
    "eye_depth": 1.2,
    "nasolabial": 3.8,
    "marionette": 2.3,
    "mouth_corners": -0.9,
    "jowl": 5.0,
    "prejowl": 2.4,
    "submental": 3.4,
    "neck_bands": 2.2,
    "maxilla": 1.7,
    "lip_projection": -0.8,
    "chin_projection": 0.6,
    "cheekbones": -0.5,
    "brow_ridge": 0.4,
}
"""Amplitude of each mode when all of ageing shows, mm or so."""

_FEMALE_PER_FULL_AGE: Mapping[str, float] = {
    "brow_ridge": -0.4,
    "brow_ptosis": -0.7,
    "cheek": 0.6,
    "mid_cheek": 0.5,
    "eye_depth": -0.3,
    "ear_length": -1.5,
    "jowl": -1.3,
    "marionette": -0.8,
    "neck_bands": -0.5,
    "chin_projection": -0.5,
    "mouth_corners": 0.3,
}
"""What is otherwise in a woman's ageing: bone changes less about the brow, fat stays longer."""

_PER_STANDARD_DEVIATION_OF_WEIGHT: Mapping[str, float] = {
    "cheek": 2.6,
    "mid_cheek": 1.0,
    "jowl": 2.2,
    "submental": 4.0,
    "neck_soft": 2.6,
    "temple": 0.9,
    "jaw_line": 2.0,
    "nasolabial": 0.3,
    "eye_bag": 0.2,
    "chin_width": 0.6,
}

_FEMALE: Mapping[str, float] = {
    "size": -4.5,
    "brow_ridge": -2.4,
    "brow_height": 1.8,
    "brow_arch": 1.2,
    "forehead_slope": -1.2,
    "forehead_dome": 0.3,
    "eye_depth": -0.9,
    "nose_bridge": -0.3,
    "nose_root_width": -1.2,
    "nose_hump": -0.8,
    "nose_tip": 1.6,
    "nose_tip_width": -1.6,
    "cheekbones": 0.8,
    "mid_cheek": 0.9,
    "cheek": -0.3,
    "cupid": 0.9,
    "mouth_corners": 0.4,
    "chin_projection": -0.8,
    "chin_width": -2.8,
    "jaw_angle": -2.8,
    "jaw_line": -3.2,
    "lower_cheek": -2.2,
    "neck_width": -8.0,
    "larynx": -2.8,
    "submental": -0.8,
    "ear_length": -1.4,
    "nasolabial": -0.4,
    "lip_projection": 0.4,
}
"""What tells a woman's head from a man's beside its measurements."""

RED_LOST_SHARE = 0.32
"""Share of the lips' red that is gone when all of ageing shows."""
UPPER_LIP_GAINED_MM = 2.6
NOSE_GAINED_MM = 2.2


def form_of_life(recipe: Recipe) -> dict[str, float]:
    """Return the amplitude of each mode that sex, weight and age give."""
    amplitudes: dict[str, float] = {}
    shown = years_shown(recipe.age)
    shares = (
        (1.0 - recipe.sex, _FEMALE),
        (recipe.weight, _PER_STANDARD_DEVIATION_OF_WEIGHT),
        (shown, _PER_FULL_AGE),
        (shown * (1.0 - recipe.sex), _FEMALE_PER_FULL_AGE),
    )
    for share, modes in shares:
        for name, amplitude in modes.items():
            amplitudes[name] = amplitudes.get(name, 0.0) + share * amplitude
    # Fat fills what years hollow, and hangs where the skin slackens.
    amplitudes["jowl"] += 0.8 * shown * max(recipe.weight, 0.0)
    # Youth is rounder: the last of childhood's fat goes by about 25.
    young = float(np.clip((26.0 - recipe.age) / 8.0, 0.0, 1.0))
    amplitudes["mid_cheek"] += 0.6 * young
    amplitudes["cheek"] += 0.7 * young
    return amplitudes


def measures_of_age(recipe: Recipe, measure: str, mean: float) -> float:
    """Return by how much a measure of mean size `mean` changes with the recipe's years, mm."""
    shown = years_shown(recipe.age)
    change = {
        "ls-sto": -RED_LOST_SHARE * mean,
        "sto-li": -RED_LOST_SHARE * 0.75 * mean,
        "sn-sto": UPPER_LIP_GAINED_MM,
        "n-sn": NOSE_GAINED_MM,
        "n-gn": NOSE_GAINED_MM + 0.8 * UPPER_LIP_GAINED_MM,
        "ps-pi": -0.08 * mean,
        "al-al": 1.4,
        "ch-ch": 1.5,
    }
    return shown * change.get(measure, 0.0)


def muscle_strength(recipe: Recipe) -> float:
    """Return the force of muscles at the recipe's age against a young adult's.

    Muscle wastes, that of the face less than that of limbs: about a fifth by old age, our estimate.
    """
    return 1.0 - 0.18 * years_shown(recipe.age, 25.0, 85.0)


def depth_of_life(recipe: Recipe, depth: FloatArray) -> FloatArray:
    """Return the depth of tissue over bone, mm: fat, where there is some, goes with weight and age.

    Args:
        recipe: The person.
        depth: On the built-in head, mm, shape (n,).
    """
    soft = np.clip((depth - 3.5) / 5.0, 0.0, 1.0)
    change = 0.09 * recipe.weight - 0.10 * years_shown(recipe.age)
    return np.asarray(depth * (1.0 + soft * np.clip(change, -0.3, 0.3)))


def tissue_of_life(recipe: Recipe) -> dict[str, float | dict[str, float]]:
    """Return the shares of the usual tissue parameters that the recipe's age, sex and weight leave.

    Parameters that are not named stay as they are; layered ones have shares by layer.
    """
    shown = years_shown(recipe.age, 25.0, 85.0)
    female = 1.0 - recipe.sex
    if shown == 0.0 and female == 0.0 and recipe.weight == 0.0:
        return {}
    return {
        "pretension": (1.0 - 0.35 * shown) * (1.0 - 0.03 * female),
        "strain_threshold": 1.0 + shown / 3.0,
        "stiffness_low": {
            "epidermis": 1.0 + 0.15 * shown,
            "dermis": (1.0 - 0.30 * shown) * (1.0 - 0.08 * female),
            "hypodermis": (1.0 - 0.15 * shown) * (1.0 - 0.04 * recipe.weight),
        },
        "stiffness_high": {
            "epidermis": 1.0 + 0.15 * shown,
            "dermis": (1.0 + 0.10 * shown) * (1.0 - 0.05 * female),
        },
        "fat_pressure": (1.0 - 0.35 * shown) * (1.0 + 0.08 * recipe.weight),
        "ligament": 1.0 - 0.20 * shown,
        "damping": 1.0 - 0.08 * shown,
    }
