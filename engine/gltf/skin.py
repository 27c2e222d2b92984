"""The mesh of skin and strands with its morph targets, as rig and clip files share it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray
from .builder import GlbBuilder, metres
from .drawn import DrawnFace
from .materials import look_name
from .scene import Pivot, part_attributes, skin_attributes

SMALLEST_TURN = 5e-3
"""Normals that change by less are taken as still: a third of a degree."""

Target = Mapping[str, npt.NDArray[np.float32]]
"""Change of "POSITION" [m] and "NORMAL", shape (n, 3)."""


def add_skin(
    builder: GlbBuilder,
    face: DrawnFace,
    parent: Pivot,
    *,
    names: Sequence[str],
    moves: Sequence[npt.NDArray[np.floating]],
    turns: Sequence[npt.NDArray[np.floating]],
    smallest: float,
) -> int:
    """Add one node whose mesh has skin and strands as primitives; return the node.

    Args:
        builder: The file.
        face: Skin and strands.
        parent: Where the node hangs.
        names: Of the morph targets, length k.
        moves: Displacement [mm] of skin, then strands, per target, shape (v, 3) each.
        turns: Change of the skin's normals per target, shape (d, 3) each.
        smallest: Moves below this are taken as none [mm].
    """
    rest = face.rest_positions()
    skin, *strands = face.pieces()
    targets: list[Target] = [
        {"POSITION": metres(move[skin]), "NORMAL": turn.astype(np.float32)}
        for move, turn in zip(moves, turns, strict=True)
    ]
    primitives = [
        builder.primitive(
            skin_attributes(face.head, vertices=rest[skin]),
            face.head.drawn.triangles,
            material="skin",
            targets=add_targets(builder, targets, smallest=smallest),
        )
    ]
    for part, piece in zip(face.strands, strands, strict=True):
        riding = [{"POSITION": metres(move[piece])} for move in moves]
        primitives.append(
            builder.primitive(
                {**part_attributes(part), "POSITION": metres(rest[piece])},
                part.triangles,
                material=look_name(part),
                targets=add_targets(builder, riding, smallest=smallest),
            )
        )
    return builder.node(
        "skin",
        parent=parent.node,
        mesh=builder.mesh("skin", primitives, target_names=names),
        translation=-parent.origin,
        extras={"role": "skin", "material": "skin"},
    )


def add_targets(
    builder: GlbBuilder, targets: Sequence[Target], *, smallest: float
) -> list[dict[str, int]]:
    """Store morph targets, without moves below `smallest` [mm] and turns that do not show."""
    stored = []
    for target in targets:
        kept = {
            "POSITION": builder.delta(target["POSITION"], smallest=smallest * 1e-3, bounds=True)
        }
        if "NORMAL" in target:
            kept["NORMAL"] = builder.delta(target["NORMAL"], smallest=SMALLEST_TURN)
        stored.append(kept)
    return stored


def turn_of(face: DrawnFace, displacements: FloatArray) -> FloatArray:
    """Return the change of the skin's normals under displaced tissue, shape (d, 3)."""
    return face.normal_change(face.skin(displacements))
