"""Teeth, gums and tongue stay behind the skin of lips and chin, whatever the action units do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Keyframe, Recipe, Rig, Simulator, rig_from_recipe
from engine.arrays import BoolArray, FloatArray, IntArray
from engine.frame import Frame
from engine.gltf.drawn import DrawnFace
from engine.gltf.pose import motions

UNITS = "AU10 AU12 AU14 AU15 AU16 AU17 AU18 AU20 AU22 AU23 AU24 AU25 AU26 AU27 AU28".split()
POSES: Mapping[str, Mapping[str, float]] = {
    **{unit: {unit: 1.0} for unit in UNITS},
    "smile": {"AU6": 1.0, "AU12": 1.0, "AU25": 1.0},
    "bared": {"AU10": 1.0, "AU16": 1.0, "AU25": 1.0},
    "laugh": {"AU12": 1.0, "AU27": 1.0},
}
IN_THE_MOUTH = ("teeth", "gum", "tongue")
INSIDE = ("mouth_inner", "upper_lip_inner", "lower_lip_inner")
REACH = 8.0
"""How far behind a vertex that stands out the skin is looked for [mm]: no tooth is thicker."""
BACK = 62.0
"""Depth of the middle of the arches [mm]: from there all crowns face outwards."""


def settled(rig: Rig, poses: Mapping[str, Mapping[str, float]]) -> dict[str, Frame]:
    """Return the face in each pose."""
    simulator = Simulator(rig)
    for name, units in poses.items():
        simulator.add(name)
        simulator.apply(name, Keyframe(action_units=dict(units)))
    for _ in range(60):
        simulator.step()
    return {name: simulator.frame(name) for name in poses}


def behind(
    start: FloatArray, way: FloatArray, vertices: FloatArray, triangles: IntArray
) -> BoolArray:
    """Tell which ways (k, 3) from their starts cross a triangle that faces back at the start."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    middle = (a + b + c) / 3
    radius = float(np.linalg.norm(np.stack([a, b, c]) - middle, axis=2).max())
    length = float(np.linalg.norm(way, axis=1).max())
    near = cKDTree(middle).query_ball_point(start + way / 2, length / 2 + radius)
    who = np.repeat(np.arange(len(start)), [len(found) for found in near])
    which = np.concatenate([np.array(found, dtype=np.int64) for found in near])
    one, two = b[which] - a[which], c[which] - a[which]
    across = np.cross(way[who], two)
    slope = np.einsum("ij,ij->i", one, across)
    facing = slope > 1e-9  # the way runs against the triangle's normal
    scale = 1 / np.where(facing, slope, 1.0)
    off = start[who] - a[which]
    u = np.einsum("ij,ij->i", off, across) * scale
    turned = np.cross(off, one)
    v = np.einsum("ij,ij->i", way[who], turned) * scale
    t = np.einsum("ij,ij->i", two, turned) * scale
    crossed = facing & (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)
    found = np.zeros(len(start), dtype=bool)
    found[who[crossed]] = True
    return found


def standing_out(rig: Rig, frame: Frame) -> dict[str, int]:
    """Return how many vertices of each part of the mouth have outer skin behind them."""
    head = rig.head
    skin = DrawnFace.of(head).skin(frame.displacements)
    names = np.array(head.drawn.region_names)[head.drawn.regions]
    outer = ~np.isin(names[head.drawn.triangles], INSIDE).any(axis=1)
    moved = motions(head, rig.jaw, frame.pose)
    found = {}
    for part in head.parts:
        if not part.name.startswith(IN_THE_MOUTH):
            continue
        vertices = moved[part.follows].move(part.vertices)
        axis = np.column_stack(
            [0 * vertices[:, 0], vertices[:, 1], np.minimum(vertices[:, 2], BACK)]
        )
        inwards = axis - vertices
        inwards *= REACH / np.maximum(np.linalg.norm(inwards, axis=1, keepdims=True), 1e-9)
        count = int(behind(vertices, inwards, skin, head.drawn.triangles[outer]).sum())
        if count:
            found[part.name] = count
    return found


def test_a_tooth_before_the_lips_would_be_found(standard_rig: Rig) -> None:
    head = standard_rig.head
    lips = head.landmarks["ls"]
    start = head.drawn.vertices[[lips, lips]] + [[0.0, 0.0, 2.0], [0.0, 0.0, -12.0]]
    way = np.tile([0.0, 0.0, -REACH], (2, 1))
    found = behind(start, way, head.drawn.vertices, head.drawn.triangles)
    assert found.tolist() == [True, False]


def test_nothing_of_the_mouth_comes_through_the_skin(standard_rig: Rig) -> None:
    poses = {
        name: units
        for name, units in POSES.items()
        if all(unit in standard_rig.action_units for unit in units)
    }
    assert len(poses) >= 14
    frames = settled(standard_rig, poses)
    through = {name: standing_out(standard_rig, frame) for name, frame in frames.items()}
    assert not {name: found for name, found in through.items() if found}


@pytest.mark.parametrize("recipe", [Recipe(sex=0.0, mouth_width=-2.0, lip_fullness=-1.0)])
def test_nor_does_it_in_a_small_mouth(recipe: Recipe) -> None:
    rig = rig_from_recipe(recipe, level="medium")
    chosen = ("AU12", "AU15", "AU18", "AU20", "AU24", "AU27", "smile", "bared")
    frames = settled(rig, {name: POSES[name] for name in chosen})
    through = {name: standing_out(rig, frame) for name, frame in frames.items()}
    assert not {name: found for name, found in through.items() if found}
