"""Steady motion to measure in: each face takes up a new random mix of action units in turn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from engine import Keyframe, Rig, random_mixes

TICKS_BETWEEN = 15
"""Ticks between two commands to a face."""
FADE = 0.2
"""Time in which a face takes a command up, s."""
SEED = 2001
_POOL = 512
"""Mixes that are drawn; a face comes back to its first after two minutes."""
_STRIDE = 37
"""How far neighbours stand apart in the pool, without a common factor with it."""


class Motion:
    """Commands for any number of faces, the same each time, and no two faces alike.

    Faces take turns: at each tick a fifteenth of them gets a command. At tick 0 all do.
    """

    def __init__(self, rig: Rig, faces: int) -> None:
        self._faces = faces
        self._mixes = [
            replace(mix, fade=FADE, replace=True) for mix in random_mixes(rig, _POOL, SEED)
        ]

    def due(self, tick: int) -> Iterator[tuple[int, Keyframe]]:
        """Yield each face that gets a command at `tick`, and the command."""
        for face in range(self._faces):
            if tick == 0 or (tick + face) % TICKS_BETWEEN == 0:
                turn = (tick + face) // TICKS_BETWEEN
                yield face, self._mixes[(_STRIDE * face + turn) % _POOL]
