"""The warp: a smooth map of the built-in head's space that makes it another person's head."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ..head import Head
from ..recipe import Recipe
from .fields import Anchors, field_at
from .fit import amplitudes_of
from .modes import LIDS, MODES

RIGID_RADIUS = 15.2
"""Within this distance of the eye's centre all of the eye moves as one piece, mm."""
FREE_RADIUS = 36.0
"""Beyond it the eye's motion is not felt, mm."""
BALL_RADIUS = 13.5
"""Within this distance lids keep theirs from the eye's centre, mm; beyond, less and less."""
LOOSE_RADIUS = 16.5
LEAST_RADIUS = 13.2
"""Nothing that was farther comes nearer, mm."""
_MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Warp:
    """The map from the built-in head to a person.

    Attributes:
        amplitudes: Of the modes, mm; none is the identity.
        anchors: Where named points of the built-in head lie, mm.
    """

    amplitudes: Mapping[str, float]
    anchors: Anchors

    @property
    def is_identity(self) -> bool:
        """Whether nothing moves."""
        return not self.amplitudes

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return where points (k, 3) of the built-in head lie on the person, mm."""
        if self.is_identity:
            return points
        moved = points + self._whole(points)
        eye = self.anchors["eye"]
        side = np.where(points[:, :1] < 0, _MIRROR, 1.0)
        offset = points * side - eye
        distance = np.linalg.norm(offset, axis=1)
        rigid = _ease((FREE_RADIUS - distance) / (FREE_RADIUS - RIGID_RADIUS))[:, None]
        shift = self.eye_shift
        moved = moved + rigid * (points + shift * side - moved)
        return self._lids(points, moved, eye + shift, side, distance)

    @property
    def eye_shift(self) -> FloatArray:
        """How far the left eyeball moves, mm, shape (3,); the right one moves as its image."""
        return np.asarray(self._whole(self.anchors["eye"][None, :])[0])

    def teeth_shift(self) -> FloatArray:
        """How far teeth and tongue move: as the line where the lips meet, mm, shape (3,)."""
        seam = np.array([self.anchors[name] for name in ("M0_0", "M0_10")])
        shift = (self(seam) - seam).mean(axis=0)
        shift[0] = 0.0
        return np.asarray(shift)

    def _whole(self, points: FloatArray) -> FloatArray:
        """Return the displacement that moves eyes as a whole, mm."""
        total = np.zeros_like(points)
        for name, amplitude in self.amplitudes.items():
            if name not in LIDS and amplitude:
                total += amplitude * field_at(MODES[name], points, self.anchors)
        return total

    def _lids(
        self,
        points: FloatArray,
        moved: FloatArray,
        center: FloatArray,
        side: FloatArray,
        distance: FloatArray,
    ) -> FloatArray:
        """Return `moved` with the lids moved over the ball, at the distance they had from it."""
        near = np.flatnonzero(distance < 3.0 * FREE_RADIUS)
        total = np.zeros((len(near), 3))
        for name in LIDS:
            amplitude = self.amplitudes.get(name, 0.0)
            if amplitude:
                total += amplitude * field_at(LIDS[name], points[near], self.anchors)
        result = moved.copy()
        result[near] += total
        close = distance < LOOSE_RADIUS
        offset = result[close] * side[close] - center
        length = np.linalg.norm(offset, axis=1)
        kept = _ease((LOOSE_RADIUS - distance[close]) / (LOOSE_RADIUS - BALL_RADIUS))
        wanted = length + kept * (distance[close] - length)
        wanted = np.maximum(wanted, np.minimum(distance[close], LEAST_RADIUS))
        result[close] = (center + offset * (wanted / length)[:, None]) * side[close]
        return result


def warp_of(recipe: Recipe, reference: Head) -> Warp:
    """Return the warp from the built-in head to a person.

    Args:
        recipe: The person.
        reference: The built-in head at any level.
    """
    anchors = anchors_of(reference)
    landmarks = {name: reference.drawn.vertices[i] for name, i in reference.landmarks.items()}
    names, places = list(landmarks), np.array(list(landmarks.values()))

    def warped(amplitudes: Mapping[str, float]) -> dict[str, FloatArray]:
        return dict(zip(names, Warp(amplitudes, anchors)(places), strict=True))

    return Warp(amplitudes_of(recipe, warped), anchors)


def anchors_of(reference: Head) -> dict[str, FloatArray]:
    """Return the named points of the left half and the midline of the built-in head, mm."""
    anchors: dict[str, FloatArray] = {}
    for name, place in zip(reference.names, reference.points, strict=True):
        stem, _, side = name.partition(".")
        if side != "R":
            anchors[stem] = place
    for name, index in reference.landmarks.items():
        stem, _, side = name.partition(".")
        if side != "R":
            anchors[stem] = reference.drawn.vertices[index]
    anchors["eye"] = reference.eyes[0].center
    return anchors


def _ease(share: FloatArray) -> FloatArray:
    """Return the step of fifth degree from 0 to 1, its first two derivatives 0 at both ends."""
    t = np.clip(share, 0.0, 1.0)
    return np.asarray(t**3 * (t * (6.0 * t - 15.0) + 10.0))
