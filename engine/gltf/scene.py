"""The scene that every moving GLB shares: a head on its neck, with skull, jaw and eyes as nodes.

    risorius
    └── head            turns about the neck
        ├── skull       upper teeth and gum, caruncles
        ├── jaw         at the hinge: lower teeth and gum, tongue
        ├── eye.L       at the eyeball's centre: ball and cornea
        └── eye.R

Skin, strands and tissue hang under `head` too. Every node but the pivots has the head's frame.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..head.head import Head, Part
from ..head.parts.tongue import FULL_THRUST
from ..jaw import JawHinge
from .accessors import metres
from .builder import GlbBuilder
from .drawn import unit_normals
from .library import Array
from .materials import look_name
from .targets import add_targets
from .tongue import TARGET_NAME, TONGUE, out_target

NECK_PIVOT = np.array([0.0, -90.0, -10.0])
"""Point that head yaw, pitch and roll turn about, head frame, mm: the middle of the neck."""

EYE_NODES = ("eye.L", "eye.R")


@dataclass(frozen=True, eq=False)
class Pivot:
    """A node that others hang from: its glTF index and its origin in the head's frame [mm]."""

    node: int
    origin: FloatArray


def file_extras(*, rig_id: str, rig_name: str) -> dict[str, object]:
    """Return what every file says of itself."""
    return {"license": "CC0-1.0", "rig": rig_id, "name": rig_name, "units": "m"}


def add_pivots(builder: GlbBuilder, head: Head, jaw: JawHinge) -> dict[str, Pivot]:
    """Add root, head, skull, jaw and eye nodes; return the pivots by name."""
    root = builder.node("risorius")
    pivots = {"head": Pivot(builder.node("head", parent=root, translation=NECK_PIVOT), NECK_PIVOT)}
    nowhere = np.zeros(3)
    pivots["skull"] = add_pivot(builder, "skull", nowhere, pivots["head"])
    pivots["jaw"] = add_pivot(
        builder,
        "jaw",
        np.array(jaw.center),
        pivots["head"],
        extras={"role": "jaw", "slide_per_degree": jaw.slide * 1e-3},
    )
    for name, eye in zip(EYE_NODES, head.eyes, strict=False):
        extras = {"role": "eye", "radius": eye.radius * 1e-3}
        pivots[name] = add_pivot(builder, name, eye.center, pivots["head"], extras=extras)
    return pivots


def add_pivot(
    builder: GlbBuilder,
    name: str,
    origin: FloatArray,
    parent: Pivot,
    extras: Mapping[str, object] | None = None,
) -> Pivot:
    """Add a node at `origin`, head frame [mm], under `parent`."""
    node = builder.node(name, parent=parent.node, translation=origin - parent.origin, extras=extras)
    return Pivot(node, origin)


def add_rigid_parts(
    builder: GlbBuilder,
    head: Head,
    pivots: Mapping[str, Pivot],
    *,
    skip: Sequence[str] = (),
    drawn_as: Callable[[Part], Part] = lambda part: part,
) -> dict[str, int]:
    """Add the parts that move with a bone or an eye, relative to their pivots; return the nodes.

    Those that follow a pivot in `skip` are left out, for a caller that has more to say about them.
    The tongue has a morph target, by which it is put out. Each is drawn as `drawn_as` says.
    """
    nodes = {}
    for part in rigid_parts(head):
        if part.follows in skip:
            continue
        part = drawn_as(part)
        pivot = pivots[part.follows]
        attributes = part_attributes(part, origin=pivot.origin)
        grid = builder.packing.grid(attributes["POSITION"])
        out = part.name == TONGUE
        primitive = builder.primitive(
            attributes,
            part.triangles,
            material=look_name(part),
            targets=add_targets(builder, [out_target(part)], smallest=1e-3, grid=grid)
            if out
            else (),
            grid=grid,
        )
        extras: dict[str, object] = {"role": "part", "material": part.material}
        if out:
            extras["thrust"] = FULL_THRUST * 1e-3
        nodes[part.name] = builder.node(
            part_node_name(part),
            parent=pivot.node,
            mesh=builder.mesh(part.name, [primitive], target_names=(TARGET_NAME,) if out else ()),
            extras=extras,
            grid=grid,
        )
    return nodes


def rigid_parts(head: Head) -> Sequence[Part]:
    """Return the parts that follow a bone or an eye."""
    return [part for part in head.parts if part.follows != "skin"]


def part_node_name(part: Part) -> str:
    """Return the part's node name; "eye.L" is the pivot, so its ball is "ball.L"."""
    return part.name.replace("eye.", "ball.") if part.name in EYE_NODES else part.name


def part_attributes(part: Part, *, origin: FloatArray | float = 0.0) -> dict[str, Array]:
    """Return the part's vertex attributes, positions relative to `origin` [mm]."""
    attributes: dict[str, Array] = {
        "POSITION": metres(part.vertices - origin),
        "NORMAL": unit_normals(part.normals).astype(np.float32),
    }
    if part.material != "cornea":  # it is clear: its colour is the material's
        attributes["COLOR_0"] = part.colors.clip(0, 1).astype(np.float32)
    if part.uvs is not None:
        attributes["TEXCOORD_0"] = part.uvs.astype(np.float32)
    if part.hair is not None:
        attributes["_HAIR"] = part.hair.astype(np.float32)
    return attributes


def skin_attributes(head: Head, *, vertices: FloatArray | None = None) -> dict[str, Array]:
    """Return the skin's vertex attributes, at rest or at `vertices` [mm]."""
    drawn = head.drawn
    attributes: dict[str, Array] = {
        "POSITION": metres(drawn.vertices if vertices is None else vertices),
        "NORMAL": unit_normals(drawn.normals).astype(np.float32),
        "COLOR_0": drawn.colors.clip(0, 1).astype(np.float32),
        "_HAIR": drawn.hair.astype(np.float32),
    }
    if drawn.uvs is not None:
        attributes["TEXCOORD_0"] = drawn.uvs.astype(np.float32)
    return attributes
