"""What commands set: one number a muscle, then jaw, gaze, head and tongue, in a fixed order."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

JAW = ("pitch", "yaw", "thrust")
GAZE = ("yaw", "pitch", "vergence")
HEAD = ("yaw", "pitch", "roll", "thrust")
TONGUE = ("thrust",)
GROUPS = {"jaw": JAW, "gaze": GAZE, "head": HEAD, "tongue": TONGUE}
LIMITS = {
    ("jaw", "pitch"): (-2.0, 35.0),
    ("jaw", "yaw"): (-10.0, 10.0),
    ("jaw", "thrust"): (-2.0, 8.0),
    ("gaze", "yaw"): (-45.0, 45.0),
    ("gaze", "pitch"): (-35.0, 35.0),
    ("gaze", "vergence"): (-30.0, 60.0),
    ("head", "yaw"): (-80.0, 80.0),
    ("head", "pitch"): (-60.0, 60.0),
    ("head", "roll"): (-50.0, 50.0),
    ("head", "thrust"): (-40.0, 60.0),
    ("tongue", "thrust"): (0.0, 45.0),
}
"""Degrees, and mm of thrust: the range of a living neck, eye, jaw and tongue.

Vergence is the angle between the two lines of sight: positive crosses the eyes.
"""
MIRRORED = frozenset({("jaw", "yaw"), ("gaze", "yaw"), ("head", "yaw"), ("head", "roll")})
"""Axes whose sign changes with the side."""


@dataclass(frozen=True)
class Channels:
    """Where each number of a command stands in a face's vector.

    Attributes:
        muscle_names: The rig's muscles, first in the vector.
    """

    muscle_names: tuple[str, ...]

    @cached_property
    def count(self) -> int:
        """Length of the vector."""
        return len(self.muscle_names) + sum(len(axes) for axes in GROUPS.values())

    @property
    def muscle_count(self) -> int:
        """Number of muscles."""
        return len(self.muscle_names)

    def index(self, group: str, axis: str) -> int:
        """Return the place of, say, ("jaw", "pitch")."""
        return self._places[group, axis]

    @cached_property
    def _places(self) -> dict[tuple[str, str], int]:
        axes = [(group, axis) for group, names in GROUPS.items() for axis in names]
        return {axis: self.muscle_count + place for place, axis in enumerate(axes)}
