"""How far the lids turn: by their muscles, with the gaze, pushed by the skin, and onto each other.

A lid's margin is a stiff plate, the tarsus, hung between its muscles and the skin around it. It
turns about the eyeball to where they balance: with κ the skin's share of the stiffness, θ_m the
angle at which levator and orbicularis would hold it and ψ the skin's own angle about the eye,

    k_m (θ_m - θ) + k_s (ψ - θ) = 0,    θ = (1 - κ) θ_m + κ ψ,    κ = k_s / (k_m + k_s).

So a raised cheek lifts the lower lid, and a brow the upper one. ψ is an angle of the tissue, which
has inertia and damping of its own: the plate, a tenth of a gram, has none.
"""

from __future__ import annotations

import math

from .arrays import FloatArray
from .compiling import kernel

FOLLOWS_DOWN, FOLLOWS_UP = (0.80, 0.25), (0.40, 0.10)
"""Turn of upper and lower lid per degree that the eye looks down or up.

The upper lid goes with the gaze, nearly all the way down and half the way up, the lower one a
little (Becker and Fuchs 1988); the shares are smaller here, for a lid at rest covers less iris.
"""
SHUT_ANGLE = 40.0
"""Turn of the upper lid at which it is shut, degrees: a shut lid does not follow the eye."""
MEETING = 0.99
"""Share of their opening after which shut lids touch: their margins are round."""
GRID = 2.0**-8
"""Step in which the skin turns a lid, degrees, 1 µm: so that lids at rest are at rest."""


@kernel
def follow_gaze(angles: FloatArray, pitch: float) -> None:
    """Turn the lids on as the eyes look up or down.

    Args:
        angles: Degrees by the lids' own muscles, shape (2, 2), overwritten: side, then upper
            (positive closes) and lower (positive raises).
        pitch: Of both eyes, degrees, up positive.
    """
    upper, lower = FOLLOWS_DOWN if pitch < 0.0 else FOLLOWS_UP
    for side in range(2):
        shut = min(max(angles[side, 0] / SHUT_ANGLE, 0.0), 1.0)
        angles[side, 0] -= (1.0 - shut) * upper * pitch
        angles[side, 1] += (1.0 - shut) * lower * pitch


@kernel
def give_to_skin(angles: FloatArray, skin: FloatArray, shares: FloatArray) -> None:
    """Turn the lids on as the skin around them pushes.

    Args:
        angles: Without the skin, degrees, shape (2, 2), overwritten: side, then upper and lower.
        skin: ψ, degrees, in the same order, shape (4,).
        shares: κ of the upper and of the lower lid, shape (2,).
    """
    for side in range(2):
        for lid in range(2):
            pushed = shares[lid] * (skin[2 * side + lid] - angles[side, lid])
            angles[side, lid] += math.floor(pushed / GRID + 0.5) * GRID


@kernel
def meet(angles: FloatArray, opening: FloatArray) -> None:
    """Stop lids that would pass each other: the upper one, which travels farther, on the lower.

    Args:
        angles: Degrees, shape (2, 2), overwritten: side, then upper and lower.
        opening: Of the eyes at rest, degrees, shape (2,).
    """
    for side in range(2):
        angles[side, 0] = min(angles[side, 0], MEETING * opening[side] - angles[side, 1])


@kernel
def stand_lids(
    own: FloatArray, pitch: float, skin: FloatArray, shares: FloatArray, opening: FloatArray
) -> FloatArray:
    """Return where the lids stand, degrees, shape (2, 2): side, then upper and lower.

    Args:
        own: By their own muscles.
        pitch: Of both eyes, degrees.
        skin: Turn of the skin around each, degrees, shape (4,); see `Lids.skin_angles`.
        shares: κ of upper and lower, shape (2,).
        opening: Of the eyes at rest, degrees, shape (2,).
    """
    angles = own.copy()
    follow_gaze(angles, pitch)
    give_to_skin(angles, skin, shares)
    meet(angles, opening)
    return angles
