"""How the cost of a face grows with its mesh: the built-in skin, its triangles split finer."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine import Rig
from engine.arrays import FloatArray, IntArray
from engine.head import head_from_mesh
from engine.lanes import WIDTH
from engine.rig import rig_from_head
from engine.tissue.layers import sheet_of

from .crowd import moving

SPLITS = (1, 2, 3, 4)
"""Parts that each edge is split into."""
_GRID_MM = 1e-6
"""Distance under which two points of split triangles are one."""


def measure_meshes(
    rig: Rig, *, seconds: float, splits: tuple[int, ...] = SPLITS
) -> list[dict[str, Any]]:
    """Return what a face costs in a full bank, one row a mesh.

    Each is the skin of `rig` taken as a mesh from a file would be: no lids, lips, teeth or jaw to
    meet, the muscles at the same places. The substeps are those that its tissue asks for.

    Args:
        rig: Whose skin.
        seconds: Time that each row is measured for.
        splits: Parts that each edge is split into, a row each.
    """
    points, triangles = _skin(rig)
    rows = []
    for parts in splits:
        head = head_from_mesh(*split(points, triangles, parts), name=f"skin in {parts}")
        finer = rig_from_head(head, parameters=rig.parameters)
        row = moving(finer, WIDTH, seconds=seconds)
        count = len(head.triangles)
        rows.append(
            {
                "triangles": count,
                "nodes": 3 * head.sheet_count,
                **{name: row[name] for name in ("substeps", "awake", "diverged", "face_tick_us")},
                "ns_per_triangle_substep": round(
                    1000 * row["face_tick_us"] / (count * row["substeps"]), 2
                ),
                "faces_per_core_60hz": row["faces_per_core_60hz"],
            }
        )
    return rows


def split(points: FloatArray, triangles: IntArray, parts: int) -> tuple[FloatArray, IntArray]:
    """Return a mesh whose triangles are each split into `parts` squared.

    Args:
        points: Positions, mm, shape (v, 3).
        triangles: Vertex indices, shape (t, 3).
        parts: Parts of each edge, at least 1.
    """
    places = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
    at = {place: index for index, place in enumerate(places)}
    weights = np.array([(parts - i - j, i, j) for i, j in places]) / parts
    upright = [(at[i, j], at[i + 1, j], at[i, j + 1]) for i, j in places if i + j < parts]
    turned = [
        (at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]) for i, j in places if i + j < parts - 1
    ]
    spread = np.einsum("wc,tcx->twx", weights, points[triangles]).reshape(-1, 3)
    finer = np.arange(len(triangles))[:, None, None] * len(places) + np.array(upright + turned)
    _, first, same = np.unique(
        np.round(spread / _GRID_MM), axis=0, return_index=True, return_inverse=True
    )
    return spread[first], same.ravel()[finer.reshape(-1, 3)]


def _skin(rig: Rig) -> tuple[FloatArray, IntArray]:
    """Return points and triangles of the tissue's surface, its quadrilaterals cut in two."""
    sheet = sheet_of(rig.head)
    quads = sheet.polygons[sheet.polygons[:, 3] >= 0]
    return sheet.points, np.concatenate([sheet.polygons[:, :3], quads[:, [0, 2, 3]]])
