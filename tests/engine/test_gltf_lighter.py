"""Parts of lower levels: fewer vertices, as much covered, in the same place."""

from __future__ import annotations

import numpy as np
import pytest

from engine.gltf.lighter import CELLS, IN_FRONT, THINNINGS, lighter
from engine.head.geometry import triangle_areas
from engine.head.head import Part
from engine.rig import builtin_rig

PARTS = {part.name: part for part in builtin_rig("standard").at_level("medium").head.parts}
COARSE = [name for name in PARTS if name.partition(".")[0] in CELLS]


def area(part: Part) -> float:
    return float(triangle_areas(part.vertices, part.triangles).sum())


@pytest.mark.parametrize("name", [*THINNINGS, *COARSE])
def test_a_lighter_part_is_whole_and_in_its_place(name: str) -> None:
    part, light = PARTS[name], lighter(PARTS[name], "medium")
    count = len(light.vertices)
    assert count < 0.8 * len(part.vertices)
    assert len(light.normals) == len(light.colors) == count
    assert set(light.triangles.ravel()) == set(range(count))
    np.testing.assert_allclose(np.linalg.norm(light.normals, axis=1), 1.0, atol=1e-6)
    assert (triangle_areas(light.vertices, light.triangles) > 0.0).mean() > 0.99
    low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
    slack = 0.05 * (high - low).max()
    assert (light.vertices > low - slack).all()
    assert (light.vertices < high + slack).all()
    for each in (light.roots, light.uvs):
        assert each is None or len(each) == count


@pytest.mark.parametrize("name", ["hair", "hairline", "brows", "lashes", *COARSE])
def test_as_much_is_covered(name: str) -> None:
    assert 0.6 < area(lighter(PARTS[name], "medium")) / area(PARTS[name]) < 1.2


@pytest.mark.parametrize("name", [*THINNINGS, *COARSE])
def test_faces_look_the_way_they_did(name: str) -> None:
    light = lighter(PARTS[name], "medium")
    corners = light.vertices[light.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = np.einsum("ti,ti->t", across, light.normals[light.triangles].sum(axis=1))
    part = PARTS[name]
    corners = part.vertices[part.triangles]
    before = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    ways = np.einsum("ti,ti->t", before, part.normals[part.triangles].sum(axis=1))
    assert (outward > 0).mean() > (ways > 0).mean() - 0.1


@pytest.mark.parametrize("name", ["brows", "lashes", "hairline"])
def test_strands_that_are_left_ride_where_they_did(name: str) -> None:
    part, light = PARTS[name], lighter(PARTS[name], "medium")
    assert light.roots is not None
    assert part.roots is not None
    assert set(light.roots) <= set(part.roots)


def test_the_highest_level_has_all() -> None:
    for part in PARTS.values():
        assert lighter(part, "high") is part


def test_what_is_looked_at_is_as_it_was() -> None:
    for name in ("tongue", "eye.L", "cornea.L", "tear_line"):
        assert lighter(PARTS[name], "low") is PARTS[name]


@pytest.mark.parametrize("name", ["teeth.upper", "teeth.lower"])
def test_the_faces_of_front_teeth_are_as_they_were(name: str) -> None:
    part, light = PARTS[name], lighter(PARTS[name], "medium")
    faces = part.vertices[(part.vertices[:, 2] > IN_FRONT) & (part.normals[:, 2] > 0)]
    there = {tuple(place) for place in light.vertices.round(6)}
    assert len(faces) > 300
    assert {tuple(place) for place in faces.round(6)} <= there
