"""Conditions of a living face as edits of a rig: aged tissue, facial palsy, relaxed muscles."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .errors import InvalidValue, UnknownName
from .head import Recipe, muscle_strength, tissue_of_life
from .rig import Rig, living_tissue

TISSUE_AGES: Mapping[str, float] = {"young": 22.0, "middle": 50.0, "old": 78.0}
"""Years of each preset of the tissue's age."""
AGE_LIMITS = (18.0, 90.0)
SIDES = ("left", "right", "both")
GRADES: Mapping[str, int] = {"I": 1, "II": 2, "III": 3, "IV": 4, "V": 5, "VI": 6}
GAIN_BY_GRADE: Mapping[str, tuple[float, ...]] = {
    "forehead": (1.0, 0.75, 0.35, 0.0, 0.0, 0.0),
    "eye": (1.0, 1.0, 1.0, 0.6, 0.3, 0.0),
    "face": (1.0, 0.8, 0.6, 0.4, 0.15, 0.0),
}
"""Force left, by zone, at House-Brackmann grades I to VI.

The grades' own estimates of the function left are 100, 80, 60, 40, 20 and 0 %; the forehead is
slight to moderate at III and still from IV on, eyes close completely up to III (House and
Brackmann, "Facial nerve grading system", 1985). Forces within those words are our estimates.
"""
FOREHEAD = ("frontalis",)
EYE = ("orbicularis_oculi_pretarsal", "orbicularis_oculi_preseptal", "orbicularis_oculi_palpebral")
NOT_FACIAL_NERVE = (
    "levator_palpebrae",
    "masseter",
    "temporalis",
    "pterygoid",
    "genioglossus",
    "cheek_air",
    "lip_air",
)
"""Muscles of other nerves (oculomotor, trigeminal, hypoglossal), which a facial palsy spares;
and air."""
CONDITIONS = ("tissue_age", "palsy", "relaxed")
"""Names of the conditions among a rig's changes."""


def plain_changes(rig: Rig, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return `changes` with conditions written out as edits of tissue and muscles.

    What the changes name themselves wins over a condition, and a relaxed muscle keeps its share
    of what a palsy leaves. So written, changes of changes merge field by field.

    Args:
        rig: What is changed; tells muscles, and whose tissue ages.
        changes: As `Rig.derive` takes them, with `tissue_age`, a preset ("old") or years;
            `palsy`, `{"side": "left", "grade": "IV"}`, where "gain" overrides the grade's; and
            `relaxed`, the share 0..1 of its force that each muscle has lost, by name with or
            without side, or `{"left": 0.5, "right": 0}` for the halves of one.

    Raises:
        UnknownName: For a preset, side, grade or muscle that does not exist.
        InvalidValue: For a number outside its range, or a rig without a person's tissue.
    """
    plain = {key: value for key, value in changes.items() if key not in CONDITIONS}
    if changes.get("tissue_age") is not None:
        aged = tissue_at_age(_recipe(rig, changes), changes["tissue_age"])
        plain["tissue"] = {**aged, **(_mapping("tissue", changes.get("tissue")) or {})}
    gains: dict[str, tuple[float, float]] = {}
    if changes.get("palsy") is not None:
        gains = palsy(rig, changes["palsy"])
    if changes.get("relaxed") is not None:
        for name, (left, right) in relaxed(rig, changes["relaxed"]).items():
            before = gains.get(name, (1.0, 1.0))
            gains[name] = (before[0] * left, before[1] * right)
    if gains:
        muscles = dict(_mapping("muscles", changes.get("muscles")) or {})
        for name, gain in gains.items():
            own = _mapping(f"muscle {name}", muscles.get(name)) or {}
            muscles[name] = {"gain": list(gain), **own}
        plain["muscles"] = muscles
    return plain


def tissue_at_age(recipe: Recipe, age: object) -> dict[str, Any]:
    """Return the tissue edits that give a person the skin and muscles of another age.

    Args:
        recipe: The person, whose sex and weight count too.
        age: A preset of `TISSUE_AGES`, or years.

    Raises:
        UnknownName: For a preset that does not exist.
        InvalidValue: For years outside `AGE_LIMITS`.
    """
    if isinstance(age, str):
        if age not in TISSUE_AGES:
            raise UnknownName("tissue age", age, TISSUE_AGES)
        years = TISSUE_AGES[age]
    else:
        years = _number("tissue_age", age, *AGE_LIMITS)
    aged = replace(recipe, age=years)
    target = living_tissue(aged)
    # All that age touches is set, not only what differs: a preset undoes an earlier one.
    touched = tissue_of_life(replace(recipe, age=AGE_LIMITS[1]))
    plain = target.to_json()
    edits: dict[str, Any] = {name: plain[name] for name in touched}
    edits["muscle_strength"] = muscle_strength(aged) / muscle_strength(recipe)
    return edits


def palsy(rig: Rig, spec: object) -> dict[str, tuple[float, float]]:
    """Return the gain (left, right) of every muscle of the facial nerve in a one-sided palsy.

    Args:
        rig: For its muscles.
        spec: `{"side": "left", "grade": "IV"}`; a grade is a Roman numeral or 1 to 6; "gain",
            0..1, in its place weakens every zone alike.

    Raises:
        UnknownName: For a field, side or grade that does not exist.
        InvalidValue: For a gain outside 0..1, or no side.
    """
    given = _mapping("palsy", spec) or {}
    for key in given:
        if key not in ("side", "grade", "gain"):
            raise UnknownName("palsy field", str(key), ("side", "grade", "gain"))
    side = given.get("side")
    if side not in SIDES:
        raise UnknownName("palsy side", str(side), SIDES)
    gains = {}
    for name in rig.muscle_names:
        stem = name.partition(".")[0]
        if stem.startswith(NOT_FACIAL_NERVE):
            continue
        left_over = _left_over(stem, given)
        gain = (
            left_over if side in ("left", "both") else 1.0,
            left_over if side in ("right", "both") else 1.0,
        )
        spared = {"left": ".R", "right": ".L"}.get(str(side))
        if spared is None or not name.endswith(spared):
            gains[name] = gain
    return gains


def relaxed(rig: Rig, spec: object) -> dict[str, tuple[float, float]]:
    """Return the gain (left, right) of muscles that have lost a share of their force.

    Botulinum toxin blocks a muscle's end plates by dose: a share of 1 is full paralysis.

    Args:
        rig: For its muscles.
        spec: Share 0..1 by muscle, "corrugator_supercilii" for both sides; or
            `{"left": 0.5, "right": 0}`.

    Raises:
        UnknownName: For a muscle or side that does not exist.
        InvalidValue: For a share outside 0..1.
    """
    given = _mapping("relaxed", spec) or {}
    known = {name.partition(".")[0] for name in rig.muscle_names} | set(rig.muscle_names)
    gains: dict[str, tuple[float, float]] = {}
    # Sides after both: "zygomatic_major.L" wins over "zygomatic_major".
    for key in sorted(given, key=lambda name: ("." in str(name), str(name))):
        if key not in known:
            raise UnknownName("muscle", str(key), known)
        left, right = _shares(str(key), given[key])
        for name in rig.muscle_names:
            if key in (name, name.partition(".")[0]):
                gains[name] = (1.0 - left, 1.0 - right)
    return gains


def _left_over(stem: str, given: Mapping[str, Any]) -> float:
    if given.get("gain") is not None:
        return _number("palsy.gain", given["gain"], 0.0, 1.0)
    grade = given.get("grade")
    number = GRADES.get(grade.upper()) if isinstance(grade, str) else grade
    if isinstance(number, bool) or not isinstance(number, int) or number not in GRADES.values():
        raise UnknownName("House-Brackmann grade", str(grade), GRADES)
    zone = "forehead" if stem.startswith(FOREHEAD) else "eye" if stem in EYE else "face"
    return GAIN_BY_GRADE[zone][number - 1]


def _shares(name: str, value: object) -> tuple[float, float]:
    if not isinstance(value, Mapping):
        share = _number(f"relaxed.{name}", value, 0.0, 1.0)
        return share, share
    for side in value:
        if side not in ("left", "right"):
            raise UnknownName("side", str(side), ("left", "right"))
    left, right = (
        _number(f"relaxed.{name}.{s}", value.get(s, 0.0), 0.0, 1.0) for s in ("left", "right")
    )
    return left, right


def _recipe(rig: Rig, changes: Mapping[str, Any]) -> Recipe:
    if rig.recipe is None:
        raise InvalidValue(
            f"the {rig.name} rig is nobody's face, so that its tissue does not age. "
            "Derive from 'standard' or from a person"
        )
    person = _mapping("recipe", changes.get("recipe"))
    return Recipe.of(person, rig.recipe) if person else rig.recipe


def _mapping(name: str, value: object) -> Mapping[str, Any] | None:
    if value is not None and not isinstance(value, Mapping):
        raise InvalidValue(f"{name} is {value!r}; expected an object")
    return value


def _number(name: str, value: object, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InvalidValue(f"{name} is {value!r}; expected a finite number")
    if not low <= value <= high:
        raise InvalidValue(f"{name} is {value:g}; it must lie between {low:g} and {high:g}")
    return float(value)
