"""The warp: a smooth map of the built-in head's space that makes it another person's head."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from ...arrays import FloatArray
from ..head import Head
from ..recipe import Recipe
from .fields import Anchors, field_at, field_of, rows_of
from .fit import amplitudes_of
from .modes import LIDS, MODES

RIGID_RADIUS = 15.2
"""Within this distance of the eye's centre all of the eye moves as one piece, mm."""
FREE_RADIUS = 36.0
"""Beyond it the eye's motion is not felt, mm."""
FAR_RADIUS = 3.0 * FREE_RADIUS
"""Beyond it nothing that moves the lids is felt, mm."""
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
        eye = self.anchors["eye"]
        near = np.abs(np.abs(points[:, 0]) - eye[0]) < FAR_RADIUS
        near &= np.abs(points[:, 1:] - eye[1:]).max(axis=1) < FAR_RADIUS
        lids = np.zeros_like(points)
        lids[near] = field_of(self._rows(True), points[near])
        return placed(points, field_of(self._rows(False), points), lids, self.eye_shift, eye)

    @cached_property
    def eye_shift(self) -> FloatArray:
        """How far the left eyeball moves, mm, shape (3,); the right one moves as its image."""
        return np.asarray(field_of(self._rows(False), self.anchors["eye"][None, :])[0])

    def teeth_shift(self) -> FloatArray:
        """How far teeth and tongue move: as the line where the lips meet, mm, shape (3,)."""
        seam = np.array([self.anchors[name] for name in ("M0_0", "M0_10")])
        shift = (self(seam) - seam).mean(axis=0)
        shift[0] = 0.0
        return np.asarray(shift)

    def _rows(self, lids: bool) -> FloatArray:
        """Return the terms of what moves the lids, or of all that moves eyes as a whole."""
        terms = [
            (amplitude, MODES[name])
            for name, amplitude in self.amplitudes.items()
            if amplitude and (name in LIDS) == lids
        ]
        return rows_of(terms, self.anchors)


def placed(
    points: FloatArray, whole: FloatArray, lids: FloatArray, shift: FloatArray, eye: FloatArray
) -> FloatArray:
    """Return where points (k, 3) come to lie.

    Args:
        points: On the built-in head, mm.
        whole: Displacement by all that moves an eye as a whole, mm, shape (k, 3).
        lids: Displacement by what moves the lids over the ball, mm, shape (k, 3).
        shift: Of the left eye as a whole, mm, shape (3,).
        eye: Centre of the left eye on the built-in head, mm, shape (3,).
    """
    moved = points + whole
    folded = np.column_stack([np.abs(points[:, 0]), points[:, 1:]])
    near = np.flatnonzero(np.abs(folded - eye).max(axis=1) < FREE_RADIUS)
    here = points[near]
    side = np.where(here[:, :1] < 0, _MIRROR, 1.0)
    offset = here * side - eye
    distance = np.linalg.norm(offset, axis=1)
    rigid = _ease((FREE_RADIUS - distance) / (FREE_RADIUS - RIGID_RADIUS))[:, None]
    moved[near] += rigid * (here + shift * side - moved[near])
    moved += lids
    inner = distance < LOOSE_RADIUS
    close, distance, side = near[inner], distance[inner], side[inner]
    offset = moved[close] * side - (eye + shift)
    length = np.linalg.norm(offset, axis=1)
    kept = _ease((LOOSE_RADIUS - distance) / (LOOSE_RADIUS - BALL_RADIUS))
    wanted = length + kept * (distance - length)
    wanted = np.maximum(wanted, np.minimum(distance, LEAST_RADIUS))
    moved[close] = (eye + shift + offset * (wanted / length)[:, None]) * side
    return moved


def warp_of(recipe: Recipe, reference: Head) -> Warp:
    """Return the warp from the built-in head to a person.

    Args:
        recipe: The person.
        reference: The built-in head at any level.
    """
    anchors = anchors_of(reference)
    landmarks = reference.landmark_places
    names, places = list(landmarks), np.array(list(landmarks.values()))

    eye = anchors["eye"]
    probed = np.vstack([places, eye])

    # Every mode moves a place in proportion: so its effect on each landmark is found once.
    @cache
    def effect(name: str) -> FloatArray:
        return field_at(MODES[name], probed, anchors)

    def warped(amplitudes: Mapping[str, float]) -> dict[str, FloatArray]:
        whole, lids = np.zeros_like(probed), np.zeros_like(probed)
        for name, amplitude in amplitudes.items():
            if name in LIDS:
                lids += amplitude * effect(name)
            else:
                whole += amplitude * effect(name)
        return dict(zip(names, placed(places, whole[:-1], lids[:-1], whole[-1], eye), strict=True))

    return Warp(amplitudes_of(recipe, warped), anchors)


def anchors_of(reference: Head) -> dict[str, FloatArray]:
    """Return the named points of the left half and the midline of the built-in head, mm."""
    anchors: dict[str, FloatArray] = {}
    for name, place in zip(reference.names, reference.points, strict=True):
        stem, _, side = name.partition(".")
        if side != "R":
            anchors[stem] = place
    for name, place in reference.landmark_places.items():
        stem, _, side = name.partition(".")
        if side != "R":
            anchors[stem] = place
    anchors["eye"] = reference.eyes[0].center
    return anchors


def _ease(share: FloatArray) -> FloatArray:
    """Return the step of fifth degree from 0 to 1, its first two derivatives 0 at both ends."""
    t = np.clip(share, 0.0, 1.0)
    return np.asarray(t**3 * (t * (6.0 * t - 15.0) + 10.0))
