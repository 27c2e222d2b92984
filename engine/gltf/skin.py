"""The mesh of skin and strands with its morph targets, as rig and clip files share it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray, IntArray
from .accessors import metres
from .builder import GlbBuilder
from .drawn import DrawnFace
from .materials import look_name
from .motion import Piece
from .packing import Grid
from .scene import Pivot, part_attributes, skin_attributes
from .targets import Target, add_targets


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


def add_piece(
    builder: GlbBuilder,
    face: DrawnFace,
    parent: Pivot,
    piece: Piece,
    *,
    names: Sequence[str],
    moves: Sequence[npt.NDArray[np.floating]],
    turns: Sequence[npt.NDArray[np.floating]],
    smallest: float,
    smallest_turn: float | None = None,
    grid: Grid | None = None,
    rows: Sequence[IntArray] | None = None,
) -> int:
    """Add one mesh that changes its form, the skin or strands; return its node.

    Args:
        builder: The file.
        face: Whose it is.
        parent: Where the node hangs.
        piece: The mesh.
        names: Of the morph targets, length k.
        moves: Displacement [mm] per target, shape (v, 3) each.
        turns: Change of the normals per target, shape (v, 3) each; none for strands.
        smallest: Moves below this are taken as none [mm].
        smallest_turn: Normals that change by less are taken as still; as `add_targets` has it.
        grid: Where its vertices are stored, if not on the grid of the file's packing.
        rows: Vertices among which each target moves any, if not all of them.
    """
    if piece.part is None:
        attributes = skin_attributes(face.head, vertices=piece.rest)
        triangles, material, look = face.head.drawn.triangles, "skin", "skin"
    else:
        attributes = {**part_attributes(piece.part), "POSITION": metres(piece.rest)}
        triangles, material = piece.part.triangles, piece.part.material
        look = look_name(piece.part)
    grid = grid or builder.packing.grid(attributes["POSITION"])
    targets = [{"POSITION": metres(move)} for move in moves]
    for target, turn in zip(targets, turns, strict=False):
        target["NORMAL"] = turn.astype(np.float32)
    primitive = builder.primitive(
        attributes,
        triangles,
        material=look,
        targets=add_targets(
            builder,
            targets,
            smallest=smallest,
            smallest_turn=smallest_turn,
            grid=grid,
            rows=rows,
        ),
        grid=grid,
    )
    return builder.node(
        piece.name,
        parent=parent.node,
        mesh=builder.mesh(piece.name, [primitive], target_names=names),
        translation=-parent.origin,
        extras={"role": "skin" if piece.part is None else "strands", "material": material},
        grid=grid,
    )


def turn_of(face: DrawnFace, displacements: FloatArray) -> FloatArray:
    """Return the change of the skin's normals under displaced tissue, shape (d, 3)."""
    return face.normal_change(face.skin(displacements))
