"""Morph targets as every file stores them: without what is too small to be seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from .builder import GlbBuilder

SMALLEST_TURN = 5e-3
"""Normals that change by less are taken as still: a third of a degree."""

Target = Mapping[str, npt.NDArray[np.float32]]
"""Change of "POSITION" [m] and "NORMAL", shape (n, 3)."""


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
