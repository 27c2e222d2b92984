"""Idle life: what a face does while nobody asks anything of it.

Blinks, the eyes' wanderings, the head's sway and brief expressions, each an endless sequence of
keyframes by seed: a function of the seed and of ticks, and of nothing else. They go into the lowest
layer, so whatever anybody commands overrides them.
"""

from .life import LETS_GO_OF_LIFE, MOST_LIFE, Idle, end_of_life, idle_keyframes
from .saying import IDLE

__all__ = ["IDLE", "LETS_GO_OF_LIFE", "MOST_LIFE", "Idle", "end_of_life", "idle_keyframes"]
