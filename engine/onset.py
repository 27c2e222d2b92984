"""How long each channel takes to follow a command: a fade of all, or each unit's own time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .arrays import FloatArray
from .channels import GROUPS
from .rig import Rig
from .timeline import Keyframe, ticks


def fade_lengths(
    rig: Rig, before: Mapping[str, float], after: Mapping[str, float], keyframe: Keyframe
) -> FloatArray:
    """Return the ticks that each channel takes from one set of units to another, (channels,).

    With no fade, a channel takes the onset of the unit that moves it most as it rises, and
    the offset as it falls; what the command names by itself is there at once.
    """
    channels = rig.channels
    if keyframe.fade is not None:
        return np.full(channels.count, float(ticks(keyframe.fade)))
    lengths, most = np.zeros(channels.count), np.zeros(channels.count)
    for key in sorted({*before, *after}):
        change = after.get(key, 0.0) - before.get(key, 0.0)
        if change == 0.0:
            continue
        unit, _ = rig.resolve_unit(key)
        moved = np.abs(rig.contraction({key: abs(change)}))
        leads = moved > most
        lengths[leads] = ticks(unit.onset if change > 0.0 else unit.offset)
        most = np.maximum(most, moved)
    # What units move only together, by a rule, goes with the slowest of them.
    lengths[most == 0.0] = lengths.max()
    for name in keyframe.muscles:
        lengths[channels.muscle_names.index(name)] = 0.0
    for group in GROUPS:
        for axis in getattr(keyframe, group):
            lengths[channels.index(group, axis)] = 0.0
    return lengths
