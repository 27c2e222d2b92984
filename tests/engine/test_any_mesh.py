"""The three layers assemble themselves on any triangle mesh, closed or open, and then hold."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from engine import Keyframe, Simulator
from engine.head import Head, head_from_mesh, read_head
from engine.rig import rig_from_head
from engine.tissue import PAPER_PARAMETERS, TissueParameters
from engine.tissue.fields import fields_of
from engine.tissue.layers import sheet_of, stack_layers, triangle_normals

HALF_AXES = np.array([75.0, 110.0, 95.0])


def ellipsoid() -> trimesh.Trimesh:
    """Return a closed head-sized ellipsoid whose front lies where a face's would."""
    mesh = trimesh.creation.icosphere(subdivisions=3)
    mesh.apply_scale(HALF_AXES)
    mesh.apply_translation([0.0, -25.0, 5.0])
    return mesh


def open_mask() -> trimesh.Trimesh:
    """Return the ellipsoid's front, with a rim."""
    mesh = ellipsoid()
    front = mesh.triangles_center[:, 2] > 25.0
    mesh.update_faces(front)
    mesh.remove_unreferenced_vertices()
    return mesh


@pytest.fixture(scope="module", params=[ellipsoid, open_mask], ids=["ellipsoid", "open mask"])
def head(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Head:
    path = tmp_path_factory.mktemp("meshes") / "head.obj"
    request.param().export(path)
    return read_head(path)


@pytest.mark.parametrize(
    "parameters", [TissueParameters(), PAPER_PARAMETERS], ids=["full", "paper"]
)
def test_no_element_is_inside_out(head, parameters):
    sheet = sheet_of(head)
    fields = fields_of(head, sheet, parameters)
    layers = stack_layers(sheet, parameters, fields.depth, fields.dermis)
    n = head.sheet_count
    surface = triangle_normals(sheet.points, sheet.triangles)
    for layer in (1, 2):
        below = triangle_normals(layers.nodes[layer * n : (layer + 1) * n], sheet.triangles)
        assert ((below * surface).sum(axis=1) > 0.0).all()


@pytest.mark.parametrize(
    "parameters", [TissueParameters(), PAPER_PARAMETERS], ids=["full", "paper"]
)
def test_the_tissue_rests_and_a_muscle_moves_it(head, parameters):
    rig = rig_from_head(head, parameters=parameters)
    simulator = Simulator(rig)
    simulator.add("still")
    simulator.add("pulled")
    simulator.apply("pulled", Keyframe(muscles={"zygomatic_major.L": 1.0}))
    for _ in range(60):
        simulator.step()
    assert np.abs(simulator.frame("still").displacements).max() < 1e-6
    moved = simulator.frame("pulled").displacements
    farthest = int(np.linalg.norm(moved, axis=1).argmax())
    assert 0.5 < np.linalg.norm(moved[farthest]) < 40.0
    assert head.points[farthest, 0] > 0.0, "the left muscle moves the left side"
    pull = np.array([60.0, -26.0, 58.0]) - head.points[farthest]
    assert moved[farthest] @ pull > 0.0, "towards its attachment"


def test_a_finer_mesh_of_the_same_face_moves_as_far():
    def reach(subdivisions: int) -> float:
        mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
        mesh.apply_scale(HALF_AXES)
        mesh.apply_translation([0.0, -25.0, 5.0])
        head = head_from_mesh(np.array(mesh.vertices), np.array(mesh.faces), name="ellipsoid")
        simulator = Simulator(rig_from_head(head, parameters=TissueParameters()))
        simulator.add("a")
        simulator.apply("a", Keyframe(muscles={"zygomatic_major.L": 1.0}))
        for _ in range(60):
            simulator.step()
        moved = simulator.frame("a").displacements
        return float(np.sqrt((moved**2).sum(axis=1).mean()))

    # Root mean square over 1,280 and 5,120 triangles of the same surface.
    assert reach(4) == pytest.approx(reach(3), rel=0.2)
