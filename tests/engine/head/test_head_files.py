"""Heads from files: what is read, how it is held, and what is refused with which words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from engine.errors import InvalidHead
from engine.head import head_from_mesh, read_head


def ellipsoid(subdivisions: int = 3) -> trimesh.Trimesh:
    """Return a closed head-sized ellipsoid, mm."""
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    mesh.apply_scale([75.0, 115.0, 95.0])
    return mesh


def mask() -> trimesh.Trimesh:
    """Return the front of the ellipsoid with a hole for a mouth."""
    mesh = ellipsoid(4)
    center = mesh.triangles_center
    mouth = np.hypot(center[:, 0] / 25, (center[:, 1] + 50) / 12) < 1
    mesh.update_faces((center[:, 2] > 10) & ~mouth)
    mesh.remove_unreferenced_vertices()
    return mesh


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".glb", ".stl"])
@pytest.mark.parametrize("make", [ellipsoid, mask])
def test_formats(tmp_path: Path, suffix: str, make: object) -> None:
    mesh = make()
    path = tmp_path / f"face{suffix}"
    mesh.export(path)
    head = read_head(path)
    assert head.name == "face"
    assert head.sheet_count == len(mesh.vertices) == len(head.points)
    assert len(head.polygons) == len(mesh.faces)
    assert (head.polygons[:, 3] == -1).all()
    np.testing.assert_allclose(np.ptp(head.points, axis=0), mesh.extents, rtol=1e-5)


def test_bare_surface() -> None:
    mesh = ellipsoid()
    head = head_from_mesh(mesh.vertices, mesh.faces, name="egg")
    assert head.parts == ()
    assert head.eyes == ()
    assert head.landmarks == {}
    assert head.names == ("",) * len(mesh.vertices)
    assert head.follow.shape == (0, head.sheet_count)
    assert (head.jaw_weight == 0).all()
    assert (head.depth == 8).all()
    assert (head.anchor_weight == 0.5).all()
    moved = np.random.default_rng(1).normal(size=head.points.shape)
    np.testing.assert_allclose(head.drawn.deform(moved, head.eyes), head.points + moved)


def test_closed_mesh_is_held_at_the_rear_third() -> None:
    mesh = ellipsoid()
    head = head_from_mesh(mesh.vertices, mesh.faces, name="egg")
    depth = head.points[:, 2]
    np.testing.assert_array_equal(head.fixed, depth < -95 + 190 / 3)


def test_open_mask_is_held_along_its_outer_edge_only() -> None:
    mesh = mask()
    head = head_from_mesh(mesh.vertices, mesh.faces, name="mask")
    assert head.points[head.fixed, 2].max() < 25
    mouth = np.hypot(head.points[:, 0] / 25, (head.points[:, 1] + 50) / 12) < 1.3
    assert mouth.any()
    assert not head.fixed[mouth].any()


@pytest.mark.parametrize(("unit", "factor"), [("metres", 0.001), ("centimetres", 0.1)])
def test_units_are_recognised(unit: str, factor: float) -> None:
    mesh = ellipsoid()
    head = head_from_mesh(mesh.vertices * factor, mesh.faces, name=unit)
    np.testing.assert_allclose(np.ptp(head.points, axis=0), [150, 230, 190], rtol=0.01)


def test_winding_is_made_outward() -> None:
    mesh = ellipsoid()
    flipped = head_from_mesh(mesh.vertices, mesh.faces[:, ::-1], name="inside out")
    assert (flipped.drawn.normals * flipped.points).sum() > 0
    mixed = mesh.faces.copy()
    mixed[::3] = mixed[::3, ::-1]
    mended = head_from_mesh(mesh.vertices, mixed, name="mixed")
    assert ((mended.drawn.normals * mended.points).sum(axis=1) > 0).all()


def test_mirror_is_found_where_there_is_one() -> None:
    mesh = ellipsoid()
    head = head_from_mesh(mesh.vertices, mesh.faces, name="egg")
    images = head.points[head.mirror[head.mirror >= 0]]
    np.testing.assert_allclose(images, head.points[head.mirror >= 0] * [-1, 1, 1], atol=1.0)
    lopsided = mesh.vertices + np.random.default_rng(2).normal(0, 4, mesh.vertices.shape)
    assert (head_from_mesh(lopsided, mesh.faces, name="odd").mirror == -1).any()


def test_largest_piece_is_taken() -> None:
    both = trimesh.util.concatenate(
        [ellipsoid(), trimesh.creation.icosphere(subdivisions=3, radius=12)]
    )
    head = head_from_mesh(both.vertices, both.faces, name="head and eye")
    assert head.sheet_count == len(ellipsoid().vertices)


def refuse(vertices: np.ndarray, faces: np.ndarray, words: str) -> None:
    """Check that the mesh is refused with these words."""
    with pytest.raises(InvalidHead, match=words):
        head_from_mesh(vertices, faces, name="bad")


def test_empty_is_refused() -> None:
    refuse(np.zeros((0, 3)), np.zeros((0, 3), int), r"expected \(v, 3\)")


def test_point_cloud_is_refused(tmp_path: Path) -> None:
    points = np.random.default_rng(3).normal(size=(100, 3)) * 80
    refuse(points, np.zeros((0, 3), int), "not a point cloud")
    path = tmp_path / "cloud.ply"
    trimesh.PointCloud(points).export(path)
    with pytest.raises(InvalidHead, match=r"cloud\.ply has no triangles"):
        read_head(path)


def test_nan_is_refused() -> None:
    mesh = ellipsoid()
    broken = mesh.vertices.copy()
    broken[7, 1] = np.nan
    refuse(broken, mesh.faces, "1 vertices are not finite")


@pytest.mark.parametrize("factor", [1e-6, 30.0, 1e4])
def test_absurd_size_is_refused(factor: float) -> None:
    mesh = ellipsoid()
    refuse(mesh.vertices * factor, mesh.faces, "units large; a face is 60 to 600 mm")


def test_index_out_of_range_is_refused() -> None:
    mesh = ellipsoid()
    refuse(mesh.vertices, np.vstack([mesh.faces, [[0, 1, 9999]]]), "outside 0..641")


def test_few_triangles_are_refused() -> None:
    box = trimesh.creation.box([150, 200, 180])
    refuse(box.vertices, box.faces, "12 triangles; at least 50")


def test_degenerate_is_refused() -> None:
    mesh = ellipsoid()
    refuse(mesh.vertices, np.repeat(mesh.faces[:, :1], 3, axis=1), "degenerate")


def test_non_manifold_is_refused() -> None:
    mesh = ellipsoid()
    fin = np.vstack([mesh.vertices, [[0.0, 0.0, 140.0]]])
    faces = np.vstack([mesh.faces, [[*mesh.faces[0, :2], len(mesh.vertices)]]])
    refuse(fin, faces, "not manifold: 1 edges have more than two triangles")


def test_pinched_boundary_is_refused() -> None:
    mesh = ellipsoid()
    vertex = 100
    around = np.flatnonzero((mesh.faces == vertex).any(axis=1))
    opposite = [around[0]]
    first = set(mesh.faces[around[0]]) - {vertex}
    opposite += [face for face in around if not first & set(mesh.faces[face])][:1]
    keep = np.setdiff1d(np.arange(len(mesh.faces)), opposite)
    refuse(mesh.vertices, mesh.faces[keep], "1 vertices join two boundaries")


def test_too_large_is_refused() -> None:
    mesh = ellipsoid(6)
    refuse(mesh.vertices, mesh.faces, "simplify it to 20000 or fewer")


def test_one_sided_is_refused() -> None:
    share = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    across = np.linspace(-25, 25, 5)
    angle, offset = np.meshgrid(share, across, indexing="ij")
    radius = 80 + offset * np.cos(angle / 2)
    strip = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), offset * np.sin(angle / 2)], axis=2
    )
    faces = []
    for i in range(60):
        for j in range(4):
            here, after = [i * 5 + j, i * 5 + j + 1], [(i + 1) * 5 + j, (i + 1) * 5 + j + 1]
            if i == 59:
                after = [4 - j, 3 - j]
            faces += [[here[0], after[0], after[1]], [here[0], after[1], here[1]]]
    refuse(strip.reshape(-1, 3), np.array(faces), "one-sided")


def test_missing_and_broken_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidHead, match="cannot read"):
        read_head(tmp_path / "nobody.obj")
    noise = tmp_path / "noise.glb"
    noise.write_bytes(b"not a mesh at all")
    with pytest.raises(InvalidHead, match=r"cannot read noise\.glb as a mesh"):
        read_head(noise)
    unknown = tmp_path / "face.txt"
    unknown.write_text("hello")
    with pytest.raises(InvalidHead, match=r"face\.txt"):
        read_head(unknown)
