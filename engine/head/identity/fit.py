"""From a recipe to amplitudes of the modes: forms given, measurements met with least change."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ...arrays import FloatArray
from ..anthropometry import measured, norms
from ..recipe import STANDARD, Recipe
from .ageing import form_of_life, measures_of_age
from .modes import MEASURED

Warped = Callable[[Mapping[str, float]], Mapping[str, FloatArray]]
"""From amplitudes to where the landmarks come to lie, mm."""

NAMED_BY: Mapping[str, Mapping[str, float]] = {
    "tr-n": {"forehead_height": 1.0},
    "n-gn": {"face_height": 1.0},
    "n-sn": {"nose_length": 1.0, "face_height": 0.5},
    "sn-sto": {"upper_lip": 1.0, "face_height": 0.2},
    "ls-sto": {"lip_fullness": 1.0, "lip_balance": -0.6},
    "sto-li": {"lip_fullness": 1.0, "lip_balance": 0.6},
    "sn-prn": {"nose_projection": 1.0},
    "al-al": {"nose_width": 1.0},
    "ch-ch": {"mouth_width": 1.0},
    "en-en": {"eye_spacing": 1.0},
    "en-ex": {"eye_size": 1.0},
    "ps-pi": {"eye_size": 0.5, "eye_opening": 1.0},
    "zy-zy": {"face_width": 1.0},
    "go-go": {"jaw_width": 1.0},
    "eu-eu": {"head_width": 1.0, "face_width": 0.4},
    "g-op": {"head_length": 1.0},
    "v-gn": {"head_height": 0.6, "face_height": 0.6},
}
"""Standard deviations of each measure that one of a recipe's attribute brings.

Nose and upper lip share in a long face, and the head in a wide one, as they do in people.
"""
DERIVED = ("sn-gn", "ex-ex", "v-gn")
"""Measures that follow from others: n-gn without n-sn; the eyes and what is between; n-gn."""
FITTED = (*MEASURED, "fissure", "opening")

# Millimetres of each mode for one standard deviation of the recipe's attribute.
PER_STANDARD_DEVIATION: Mapping[str, Mapping[str, float]] = {
    "head_height": {"head_height": 4.5},
    "head_width": {"forehead_width": 0.6},
    "forehead_width": {"forehead_width": 2.6, "temple": 0.4},
    "forehead_slope": {"forehead_slope": 3.0, "forehead_dome": -0.5},
    "brow_ridge": {"brow_ridge": 1.3},
    "brow_height": {"brow_height": 1.6},
    "eye_slant": {"slant": 1.0},
    "eye_depth": {"eye_depth": 1.2},
    "lid_fold": {"fold": 1.7, "crease": 1.1, "epicanthus": 0.4},
    "inner_fold": {"epicanthus": 1.5},
    "nose_bridge": {"nose_bridge": 1.5, "nose_root_width": -0.5},
    "nose_hump": {"nose_hump": 1.0},
    "nose_tip": {"nose_tip": 1.3},
    "nose_tip_width": {"nose_tip_width": 1.3},
    "nose_width": {"nose_tip_width": 0.5, "nostril_flare": 0.15},
    "lip_projection": {"lip_projection": 1.8},
    "lip_fullness": {"lip_projection": 0.4},
    "cupid_bow": {"cupid": 0.5},
    "mouth_corners": {"mouth_corners": 0.8},
    "cheekbones": {"cheekbones": 1.6},
    "jaw_angle": {"jaw_angle": 1.8, "jaw_line": 0.8},
    "chin_projection": {"chin_projection": 2.0},
    "chin_width": {"chin_width": 1.8},
    "ear_size": {"ear_length": 3.7, "ear_out": 0.5},
    "ear_angle": {"ear_out": 2.2},
    "neck_width": {"neck_width": 2.8},
}
STIFFNESS = 0.02
"""Standard deviations that a millimetre of change weighs as: it only decides between ways."""
ROUNDS = 6
NEAR = 0.6
"""Share of its tolerance within which a measure of the built-in head counts as the norm's."""


def tolerance(mean: float) -> float:
    """Return how far a measure may lie from what is asked: 5 % or 2 mm, mm."""
    return max(2.0, 0.05 * mean)


def asked(recipe: Recipe) -> dict[str, float]:
    """Return every measurement that the recipe asks for, mm."""
    wanted = {}
    for measure, norm in norms(recipe.sex).items():
        deviations = sum(
            share * getattr(recipe, attribute)
            for attribute, share in NAMED_BY.get(measure, {}).items()
        )
        wanted[measure] = norm.mean + deviations * norm.sd
        wanted[measure] += measures_of_age(recipe, measure, norm.mean)
    means = {name: norm.mean for name, norm in norms(recipe.sex).items()}
    wanted["sn-gn"] = means["sn-gn"] + sum(
        sign * (wanted[name] - means[name]) for name, sign in (("n-gn", 1), ("n-sn", -1))
    )
    wanted["ex-ex"] = means["ex-ex"] + sum(
        share * (wanted[name] - means[name]) for name, share in (("en-en", 1.0), ("en-ex", 1.8))
    )
    return wanted


def targets(recipe: Recipe, reference: Mapping[str, float]) -> dict[str, float]:
    """Return the measurements to be fitted, mm: those asked, as the built-in head meets its norm.

    Where the built-in head lies near its norm, others lie as near to theirs: what differs between
    two people is what their recipes say.

    Args:
        recipe: The person.
        reference: Measurements of the built-in head, mm.
    """
    norm = asked(STANDARD)
    found = {}
    for measure, wanted in asked(recipe).items():
        off = reference[measure] - norm[measure]
        near = NEAR * tolerance(wanted)
        found[measure] = wanted + float(np.clip(off, -near, near))
    return found


def given_forms(recipe: Recipe) -> dict[str, float]:
    """Return the amplitudes of the modes that no measurement decides."""
    amplitudes = form_of_life(recipe)
    for attribute, modes in PER_STANDARD_DEVIATION.items():
        for name, millimetres in modes.items():
            amplitude = getattr(recipe, attribute) * millimetres
            amplitudes[name] = amplitudes.get(name, 0.0) + amplitude
    return {name: value for name, value in amplitudes.items() if value != 0.0}


def amplitudes_of(recipe: Recipe, warped: Warped) -> dict[str, float]:
    """Return the amplitude of every mode that makes the built-in head the recipe's person.

    Gauss-Newton on the landmarks with a small price on every change; the built-in recipe asks for
    none and gets none.

    Args:
        recipe: The person.
        warped: Where the landmarks lie for given amplitudes.
    """
    given = given_forms(recipe)
    reference = measured(warped({}))
    wanted = targets(recipe, reference)
    if not given and asked(recipe) == asked(STANDARD):
        return {}
    names = list(wanted)
    scale = np.array([norms(recipe.sex)[name].sd for name in names])
    weight = np.array([0.1 if name in DERIVED else 1.0 for name in names])
    goal = np.array([wanted[name] for name in names])

    def residual(values: FloatArray) -> FloatArray:
        fitted = dict(zip(FITTED, values, strict=True))
        found = measured(warped(_sum(given, fitted)))
        off = np.array([found[name] for name in names]) - goal
        return np.asarray(off * weight / scale)

    values = np.zeros(len(FITTED))
    for _ in range(ROUNDS):
        here = residual(values)
        jacobian = np.column_stack(
            [(residual(values + step) - here) / STEP for step in STEP * np.eye(len(FITTED))]
        )
        normal = jacobian.T @ jacobian + STIFFNESS**2 * np.eye(len(FITTED))
        values = values - np.linalg.solve(normal, jacobian.T @ here + STIFFNESS**2 * values)
    return _sum(given, dict(zip(FITTED, values.tolist(), strict=True)))


STEP = 0.05
"""Change of an amplitude by which its effect is found, mm."""


def _sum(one: Mapping[str, float], other: Mapping[str, float]) -> dict[str, float]:
    total = dict(one)
    for name, value in other.items():
        total[name] = total.get(name, 0.0) + float(value)
    return total
