"""Lids that units of other regions only touch: there they add to what lies beneath.

A lowered brow weighs on the upper lid a little, and a raised one draws its fold up. That is no word
about whether the eye is open: a blink goes on under it, and closed eyes stay closed.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .arrays import BoolArray
from .held import Held
from .muscle import LidMuscle
from .rig import Rig

TOUCH = 0.1
"""Weight at a unit's full intensity below which it only touches a lid: the brows' units, 1, 2 and
4, have 0.04 to 0.07, the lids' own 0.2 and more."""


def touched(rig: Rig, held: Held) -> BoolArray:
    """Return which channels are lids that what is held only touches, shape (channels,)."""
    units = [rig.resolve_unit(key) for key in held.action_units]
    only = np.zeros(rig.channels.count, bool)
    for index, name, stem, side in _lids_of(rig):
        if name not in held.muscles:
            weights = (
                abs(unit.muscles.get(stem, unit.muscles.get(name, 0.0)))
                for unit, of in units
                if of in ("", side)
            )
            only[index] = 0.0 < max(weights, default=0.0) < TOUCH
    return only


@lru_cache(maxsize=16)
def _lids_of(rig: Rig) -> list[tuple[int, str, str, str]]:
    """Return index, name, name without side, and side of the lids' muscles."""
    return [
        (index, muscle.name, *muscle.name.partition(".")[::2])
        for index, muscle in enumerate(rig.muscles)
        if isinstance(muscle, LidMuscle)
    ]
