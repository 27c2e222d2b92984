"""The cage: what is authored, how it is mirrored, wound and faired."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np

from engine.head.cage import authored_cage, build_cage, mirrored_faces
from engine.head.fairing import HELD, trust
from engine.head.standard import Sculpture, sculpt


def test_authored_points_say_where_they_come_from() -> None:
    note = json.loads(authored_cage())["note"]
    assert "authored by hand" in note
    assert "no mesh" in note


def test_size() -> None:
    cage = build_cage()
    assert cage.points.shape == (1790, 3)
    assert cage.faces.shape == (1760, 4)
    assert (cage.faces[:, 3] < 0).sum() == 4


def test_faces_are_wound_alike(sculpture: Sculpture) -> None:
    sides = Counter()
    for face in sculpture.cage.faces:
        corners = [int(corner) for corner in face if corner >= 0]
        sides.update(zip(corners, corners[1:] + corners[:1], strict=True))
    assert max(sides.values()) == 1


def test_forehead_faces_forward(sculpture: Sculpture) -> None:
    cage = sculpture.cage
    a, b, c = sculpture.points[cage.faces[cage.regions.index("forehead"), :3]]
    assert np.cross(b - a, c - a)[2] > 0


def test_second_half_of_faces_mirrors_the_first(sculpture: Sculpture) -> None:
    cage = sculpture.cage
    half = len(cage.faces) // 2
    np.testing.assert_array_equal(cage.faces[half:], mirrored_faces(cage.faces[:half], cage.mirror))
    assert cage.regions[:half] == cage.regions[half:]


def test_faired_points_are_exactly_symmetric(sculpture: Sculpture) -> None:
    points, mirror = sculpture.points, sculpture.cage.mirror
    np.testing.assert_array_equal(points[mirror], points * [-1, 1, 1])
    midline = mirror == np.arange(len(mirror))
    assert (points[midline, 0] == 0).all()
    assert (np.abs(points[~midline, 0]) > 0.5).all()


def test_fairing_holds_the_face_and_frees_the_skull() -> None:
    sculpture = sculpt(fine=False)
    cage = sculpture.cage
    moved = np.linalg.norm(sculpture.points - cage.points, axis=1)
    held = np.array([trust(name) == HELD and name[0] in "EMb" for name in cage.names])
    assert moved[held].max() < 0.5
    assert moved[~held].max() < 14.0
    assert moved[~held].max() > 1.0


def test_sided_names_are_unique(sculpture: Sculpture) -> None:
    names = sculpture.cage.sided_names
    assert len(set(names)) == len(names)
    assert {"M1_5.L", "M1_5.R", "M0_0"} <= set(names)
