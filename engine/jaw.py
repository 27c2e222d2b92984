"""The jaw: a hinge that turns the skull side of the lower face (paper section 4.5)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray


@dataclass(frozen=True)
class JawHinge:
    """The joint of jaw and skull, and the slide that goes with its turning.

    Attributes:
        center: Where the turn's axis crosses the midplane, head frame, mm. It lies in the ramus,
            some 15 mm under the condyle, which slides down and forward as the jaw turns about it.
        slide: How far the centre itself slides forward per degree of opening, mm. Real jaws slide
            about 0.3 to 0.5 mm a degree; less pushes the chin into the throat.
    """

    center: tuple[float, float, float] = (0.0, -30.0, 4.0)
    slide: float = 0.35

    def transform(
        self, pitch: float, yaw: float = 0.0, thrust: float = 0.0
    ) -> tuple[FloatArray, FloatArray]:
        """Return rotation R, shape (3, 3), and translation t, mm: x' = R (x - center) + center + t.

        Args:
            pitch: Opening, degrees.
            yaw: Turn of the chin to the face's left, degrees; the negative of the paper's φy.
            thrust: Forward thrust, mm.
        """
        rotation = jaw_rotation(math.radians(pitch), -math.radians(yaw))
        return rotation, np.array([0.0, 0.0, self.slide * pitch + thrust])

    def move(
        self, points: FloatArray, share: FloatArray, pitch: float, yaw: float, thrust: float
    ) -> FloatArray:
        """Return `points`, shape (k, 3), each moved by its `share`, shape (k,), of the jaw's pose.

        The share scales the angles, not the displacement, so that tissue between jaw and skull
        turns by less instead of shrinking towards the hinge.
        """
        relative = points - np.array(self.center)
        moved = self.turn(relative, share, pitch, yaw)
        moved[:, 2] += share * (self.slide * pitch + thrust)
        return np.asarray(moved + np.array(self.center))

    def turn(self, vectors: FloatArray, share: FloatArray, pitch: float, yaw: float) -> FloatArray:
        """Return `vectors`, shape (k, 3), each turned by its `share` of pitch and yaw, degrees."""
        phi_x = math.radians(pitch) * share
        phi_y = -math.radians(yaw) * share
        x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
        sin_x, cos_x, sin_y, cos_y = np.sin(phi_x), np.cos(phi_x), np.sin(phi_y), np.cos(phi_y)
        level = sin_x * y + cos_x * z
        return np.stack(  # Eq. 18, row by row
            [cos_y * x - sin_y * level, cos_x * y - sin_x * z, sin_y * x + cos_y * level], axis=1
        )


def jaw_rotation(phi_x: float, phi_y: float) -> FloatArray:
    """Return the matrix of Eq. 18 for turns `phi_x` (opens) and `phi_y` (to the right), radians."""
    sin_x, cos_x, sin_y, cos_y = (
        math.sin(phi_x),
        math.cos(phi_x),
        math.sin(phi_y),
        math.cos(phi_y),
    )
    return np.array(
        [
            [cos_y, -sin_x * sin_y, -cos_x * sin_y],
            [0.0, cos_x, -sin_x],
            [sin_y, sin_x * cos_y, cos_x * cos_y],
        ]
    )
