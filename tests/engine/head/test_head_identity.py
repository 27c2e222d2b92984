"""People made of recipes: measured as asked, symmetric, unfolded, lids and lips at ease."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine.head import STANDARD, Head, Recipe, people
from engine.head.anthropometry import measured
from engine.head.identity import fields, person_from, warp_of
from engine.head.identity.fit import targets, tolerance
from engine.head.standard import reference_head

RECIPES = {
    "woman": Recipe(sex=0.0),
    "old": Recipe(age=85.0),
    "heavy": Recipe(sex=0.5, weight=2.0),
    "extreme": Recipe(nose_width=2.5, lip_fullness=2.5, face_width=-2.0, eye_spacing=2.0),
    **{name: person.recipe for name, person in people().items()},
}


@cache
def made(name: str) -> Head:
    """Return a person without hair, which takes time to grow."""
    return person_from(reference_head("high"), RECIPES[name])


def test_the_built_in_recipe_moves_nothing(head: Head) -> None:
    warp = warp_of(STANDARD, head)
    assert warp.is_identity
    assert warp(head.points) == pytest.approx(head.points, abs=1e-9)


def test_the_built_in_recipe_needs_nothing_compiled(
    head: Head, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise AssertionError("the kernel was called")

    monkeypatch.setattr(fields, "_field", fail)
    person_from(head, STANDARD)
    with pytest.raises(AssertionError):
        warp_of(replace(STANDARD, nose_width=1.0), head)


@pytest.mark.parametrize("name", RECIPES)
def test_a_person_measures_what_the_recipe_asks(head: Head, name: str) -> None:
    recipe = RECIPES[name]
    wanted = targets(recipe, measured(head.landmark_places))
    warp = warp_of(recipe, head)
    places = head.landmark_places
    moved = dict(zip(places, warp(np.array(list(places.values()))), strict=True))
    found = measured(moved)
    off = {
        measure: (found[measure], goal)
        for measure, goal in wanted.items()
        if abs(found[measure] - goal) > tolerance(goal)
    }
    assert not off


@pytest.mark.parametrize("name", RECIPES)
def test_nothing_folds(head: Head, name: str) -> None:
    person = made(name)
    for points, before, triangles in (
        (person.points, head.points, head.triangles),
        (person.drawn.vertices, head.drawn.vertices, head.drawn.triangles),
    ):
        old, new = (_cross(p, triangles) for p in (before, points))
        turned = (old * new).sum(axis=1) / (np.linalg.norm(old, axis=1) ** 2 + 1e-9)
        assert (turned > 0.05).all()


def _cross(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


@pytest.mark.parametrize("name", RECIPES)
def test_the_tissue_is_symmetric_to_the_last_bit(head: Head, name: str) -> None:
    person = made(name)
    image = person.points[person.mirror] * [-1.0, 1.0, 1.0]
    assert np.array_equal(image, person.points)


@pytest.mark.parametrize("name", RECIPES)
def test_lids_keep_off_the_ball(name: str) -> None:
    person = made(name)
    for side, eye in zip("LR", person.eyes, strict=True):
        edge = [person.point(f"E1_{spoke}.{side}") for spoke in range(16)]
        assert np.linalg.norm(person.points[edge] - eye.center, axis=1).min() >= 12.1
    rest = person.drawn.lids.project(person.drawn.vertices, person.eyes)
    assert rest == pytest.approx(person.drawn.vertices, abs=1e-9)


@pytest.mark.parametrize("name", RECIPES)
def test_lips_still_meet(head: Head, name: str) -> None:
    person = made(name)
    for spoke in range(5):
        ends = [
            person.point(f"M0_{place}" + (".L" if spoke else "")) for place in (spoke, 10 - spoke)
        ]
        gap = np.linalg.norm(np.subtract(*person.points[ends]))
        before = np.linalg.norm(np.subtract(*head.points[ends]))
        assert abs(gap - before) < 0.25


def corner_over_the_seam(person: Head) -> float:
    """Return how high the left corner of the mouth stands over the middle of its line, mm."""
    seam = person.points[[person.point("M0_0"), person.point("M0_10")]].mean(axis=0)
    return float((person.landmark_places["ch.L"] - seam)[1])


def test_a_mouth_at_rest_neither_frowns_nor_smiles(head: Head) -> None:
    """A corner 1 mm below the line's middle reads as sadness, 1 mm above it as a smile."""
    assert abs(corner_over_the_seam(head)) < 0.4
    for name in people():
        assert -0.8 < corner_over_the_seam(made(name)) < 1.1, name


def test_corners_of_the_mouth_fall_with_age() -> None:
    young, old = (
        person_from(reference_head("high"), replace(RECIPES["woman"], age=age))
        for age in (25.0, 85.0)
    )
    assert corner_over_the_seam(old) < corner_over_the_seam(young) - 0.3
