"""The surface file: what a stranger needs to draw the stream.

Its tissue mesh is in stream order; the sparse map to the drawn skin, the lid contact and the
strands' roots are buffers, named in the nodes' extras by their accessor's index.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..head.head import BULGE_HEIGHT, BULGE_POWER, BULGE_RADIUS, LID_GAP, Head
from ..head.wrinkles import wrinkles_of
from ..rig import Rig
from ..textures import texture_names
from .accessors import compact_indices, metres
from .builder import GlbBuilder
from .drawn import DrawnFace, SkinNormals, roots_of
from .materials import look_name
from .scene import (
    Pivot,
    add_pivots,
    add_rigid_parts,
    file_extras,
    part_attributes,
    skin_attributes,
)

STREAM_RATE = 60
"""Frames a second of the stream."""
STREAM_GRID = 2e-5
"""Step of the stream's displacement grid, m."""


def surface_to_glb(rig: Rig) -> bytes:
    """Return the surface file of `rig` as GLB: tissue, skin, map, parts, all at rest."""
    extras = file_extras(rig_id=rig.id, rig_name=rig.name)
    # Served beside it, so that the face moves before they are baked.
    textures = {Path(name).stem: f"textures/{name}" for name in texture_names(rig)}
    if textures:
        extras["textures"] = textures
    builder = GlbBuilder({**extras, "rate": STREAM_RATE, "grid": STREAM_GRID})
    pivots = add_pivots(builder, rig.head, rig.jaw)
    _add_tissue(builder, rig.head, pivots["head"])
    _add_skin(builder, rig.head, pivots["head"])
    _add_strands(builder, rig.head, pivots["head"])
    add_rigid_parts(builder, rig.head, pivots)
    return builder.to_bytes()


def _add_tissue(builder: GlbBuilder, head: Head, parent: Pivot) -> None:
    normals = SkinNormals.of(head.triangles, len(head.points))(head.points)
    attributes = {"POSITION": metres(head.points), "NORMAL": normals.astype(np.float32)}
    primitive = builder.primitive(attributes, head.triangles, material="skin")
    builder.node(
        "tissue",
        parent=parent.node,
        mesh=builder.mesh("tissue", [primitive]),
        translation=-parent.origin,
        extras={
            "role": "tissue",
            "material": "skin",
            "names": list(head.names),
            "simulated": head.sheet_count,
            "polygons": len(head.polygons),
        },
    )


def _add_skin(builder: GlbBuilder, head: Head, parent: Pivot) -> None:
    primitive = builder.primitive(skin_attributes(head), head.drawn.triangles, material="skin")
    builder.node(
        "skin",
        parent=parent.node,
        mesh=builder.mesh("skin", [primitive]),
        translation=-parent.origin,
        extras={
            "role": "skin",
            "material": "skin",
            "map": _map_buffers(builder, head),
            "lids": _lid_buffers(builder, head),
            "eyes": _eyes(head),
            "landmarks": {name: int(vertex) for name, vertex in head.landmarks.items()},
            "regions": builder.accessor(head.drawn.regions.astype(np.uint16)),
            "region_names": list(head.drawn.region_names),
            **_seams(builder, head),
            **_wrinkles(builder, head),
        },
    )


def _seams(builder: GlbBuilder, head: Head) -> dict[str, int]:
    """Store the first drawn vertex at each one's place: doubles share their triangles' normals."""
    if head.drawn.seams is None:
        return {}
    return {"seams": builder.accessor(compact_indices(head.drawn.seams))}


def _wrinkles(builder: GlbBuilder, head: Head) -> dict[str, dict[str, int]]:
    """Store the gauges and, row by row like the map, how they spread over the drawn skin.

    A gauge's strength is clamp(gain (1 - length / rest)) between its streamed points; a drawn
    vertex is wrinkled by clamp(sum of weights[k] * strength[indices[k]]).
    """
    wrinkles = wrinkles_of(head)
    if wrinkles is None:
        return {}
    rows = wrinkles.spread
    numbers = {
        "first": compact_indices(wrinkles.first),
        "second": compact_indices(wrinkles.second),
        "rest": metres(wrinkles.rest),
        "gain": wrinkles.gain.astype(np.float32),
        "indptr": rows.indptr.astype(np.uint32),
        "indices": compact_indices(rows.indices),
        "weights": rows.data.astype(np.float32),
    }
    return {"wrinkles": {name: builder.accessor(values) for name, values in numbers.items()}}


def _map_buffers(builder: GlbBuilder, head: Head) -> dict[str, int]:
    """Store the map row by row: drawn[i] moves by sum of weights[k] * tissue[indices[k]].

    k runs from indptr[i] to indptr[i + 1] - 1.
    """
    rows = head.drawn.map.tocsr()
    return {
        "indptr": builder.accessor(rows.indptr.astype(np.uint32)),
        "indices": builder.accessor(compact_indices(rows.indices)),
        "weights": builder.accessor(rows.data.astype(np.float32)),
        "columns": int(rows.shape[1]),
    }


def _lid_buffers(builder: GlbBuilder, head: Head) -> dict[str, int] | None:
    lids = head.drawn.lids
    if not len(lids.vertices):  # glTF has no empty accessors
        return None
    return {
        "vertices": builder.accessor(lids.vertices.astype(np.uint32)),
        "eyes": builder.accessor(lids.eyes.astype(np.uint16)),
        "clearance": builder.accessor(metres(lids.clearance)),
    }


def _eyes(head: Head) -> list[dict[str, object]]:
    return [
        {
            "center": [float(value) for value in eye.center * 1e-3],
            "radius": eye.radius * 1e-3,
            "ball_radius_drawn": (eye.radius + LID_GAP) * 1e-3,
            "bulge": BULGE_HEIGHT * 1e-3,
            "bulge_radius": BULGE_RADIUS * 1e-3,
            "bulge_power": BULGE_POWER,
        }
        for eye in head.eyes
    ]


def _add_strands(builder: GlbBuilder, head: Head, parent: Pivot) -> None:
    for part in DrawnFace.of(head).strands:
        primitive = builder.primitive(
            part_attributes(part), part.triangles, material=look_name(part)
        )
        builder.node(
            part.name,
            parent=parent.node,
            mesh=builder.mesh(part.name, [primitive]),
            translation=-parent.origin,
            extras={
                "role": "strands",
                "material": part.material,
                "roots": builder.accessor(roots_of(part).astype(np.uint32)),
            },
        )
