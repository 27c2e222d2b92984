"""The drawn face: strands that ride their roots, and the normals they turn by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from small_face import block, small_head

from engine.gltf.drawn import DrawnFace, SkinNormals, ride_roots, roots_of


def rotation_about_y(degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


@pytest.mark.parametrize("degrees", [0, 30, 90, 150])
def test_strand_turns_with_its_roots_normal(degrees: float) -> None:
    """A root that turns about y and moves takes its strand along, rigidly."""
    part = replace(block("brows", (1, 2, 3), "hair", "skin", root=0), roots=np.zeros(4, int))
    rest, normal = np.array([[1.0, 1.0, 1.0]]), np.array([[0.0, 0.0, 1.0]])
    turn, shift = rotation_about_y(degrees), np.array([5.0, -2.0, 1.0])
    ridden = ride_roots(part, rest, normal, rest + shift, normal @ turn.T)
    expected = (part.vertices - rest) @ turn.T + rest + shift
    np.testing.assert_allclose(ridden, expected, atol=1e-12)


def test_strand_survives_a_normal_that_turns_over() -> None:
    part = replace(block("brows", (1, 2, 3), "hair", "skin", root=0), roots=np.zeros(4, int))
    rest, normal = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    ridden = ride_roots(part, rest, normal, rest, -normal)
    assert np.isfinite(ridden).all()
    assert np.abs(ridden).max() < 10


def test_strands_at_rest_are_where_they_were_made() -> None:
    face = DrawnFace.of(small_head())
    skin, brows = face.pieces()
    rest = face.rest_positions()
    np.testing.assert_allclose(rest[brows], face.strands[0].vertices, atol=1e-12)
    np.testing.assert_allclose(rest[skin], face.head.drawn.vertices, atol=1e-12)


def test_strands_follow_a_common_translation() -> None:
    face = DrawnFace.of(replace(small_head(), eyes=()))
    shift = np.array([1.0, 2.0, 3.0])
    moved = face.positions(np.tile(shift, (len(face.head.points), 1)))
    np.testing.assert_allclose(moved, face.rest_positions() + shift, atol=1e-12)


def test_normals_are_area_weighted() -> None:
    mesh = trimesh.creation.box()
    normals = SkinNormals.of(np.asarray(mesh.faces), len(mesh.vertices))
    weighted = np.zeros((len(mesh.vertices), 3))
    for face, normal, area in zip(mesh.faces, mesh.face_normals, mesh.area_faces, strict=True):
        weighted[face] += normal * area
    weighted /= np.linalg.norm(weighted, axis=1, keepdims=True)
    np.testing.assert_allclose(normals(np.asarray(mesh.vertices)), weighted, atol=1e-12)


def test_vertex_without_area_faces_forward() -> None:
    normals = SkinNormals.of(np.array([[0, 1, 2]]), 4)
    flat = normals(np.zeros((4, 3)))
    np.testing.assert_array_equal(flat, np.tile([0.0, 0.0, 1.0], (4, 1)))


def test_part_without_roots_cannot_ride() -> None:
    with pytest.raises(ValueError, match=r"teeth\.upper"):
        roots_of(block("teeth.upper", (0, 0, 0), "teeth", "skull"))
