"""Morph targets as every file stores them: without what is too small to be seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..arrays import IntArray
from .builder import GlbBuilder
from .packing import Grid

SMALLEST_TURN = 5e-3
"""Normals that change by less are taken as still: a third of a degree."""
SMALLEST_TURN_ON_GRID = 20e-3
"""The same where normals are stored in 8 bits, of which that is two steps and a half."""

Target = Mapping[str, npt.NDArray[np.float32]]
"""Change of "POSITION" [m] and "NORMAL", shape (n, 3)."""


def add_targets(
    builder: GlbBuilder,
    targets: Sequence[Target],
    *,
    smallest: float,
    smallest_turn: float | None = None,
    grid: Grid | None = None,
    rows: Sequence[IntArray] | None = None,
) -> list[dict[str, int]]:
    """Store morph targets, without moves below `smallest` [mm] and turns that do not show.

    Args:
        builder: The file.
        targets: What to store.
        smallest: Moves below this are taken as none [mm].
        smallest_turn: Normals that change by less are taken as still; by a third of a degree, or by
            one where they are stored in 8 bits, if None.
        grid: Of their mesh.
        rows: Vertices among which each moves any; all of them, where None.
    """
    if smallest_turn is None:
        quantized = builder.packing.quantize
        smallest_turn = SMALLEST_TURN_ON_GRID if quantized else SMALLEST_TURN
    stored = []
    for number, target in enumerate(targets):
        within = None if rows is None else rows[number]
        kept = {
            "POSITION": builder.moves(
                target["POSITION"],
                smallest=smallest * 1e-3,
                grid=grid or Grid(),
                within=within,
            )
        }
        if "NORMAL" in target:
            kept["NORMAL"] = builder.turns(target["NORMAL"], smallest=smallest_turn, within=within)
        stored.append(kept)
    return stored
