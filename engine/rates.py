"""How fast muscles, lids, jaw, eyes, head and tongue may go, whatever a command asks for."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .muscle import LidMuscle
from .rig import Rig
from .timeline import TICKS_PER_SECOND

MUSCLE_RATE = 12.0
"""Activation a second: full force in a twelfth, 83 ms. Ours, at which the corner of the mouth goes
into a smile at 100 to 200 mm/s at most."""
LID_RATE = 30.0
"""Activation a second: an eye shut in a thirtieth. Ours, for a lid's margin of 250 to 350 mm/s, as
at a quick blink."""
AXIS_RATES = {
    ("jaw", "pitch"): 150.0,
    ("jaw", "yaw"): 60.0,
    ("jaw", "thrust"): 60.0,
    ("gaze", "yaw"): 600.0,
    ("gaze", "pitch"): 600.0,
    ("gaze", "vergence"): 200.0,
    ("head", "yaw"): 300.0,
    ("head", "pitch"): 300.0,
    ("head", "roll"): 300.0,
    ("head", "thrust"): 300.0,
    ("tongue", "thrust"): 300.0,
}
"""Degrees or mm a second. Saccades level out at 500 to 700 degrees a second (Bahill, Clark and
Stark 1975). The rest is ours: the jaw's opens the teeth at 260 mm/s, a quick chewer's."""


def strides(rig: Rig) -> FloatArray:
    """Return the most that each channel of `rig` goes in a tick, shape (channels,)."""
    channels = rig.channels
    rates = np.full(channels.count, MUSCLE_RATE)
    for index, muscle in enumerate(rig.muscles):
        if isinstance(muscle, LidMuscle):
            rates[index] = LID_RATE
    for (group, axis), rate in AXIS_RATES.items():
        rates[channels.index(group, axis)] = rate
    return rates / TICKS_PER_SECOND
