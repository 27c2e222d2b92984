"""How far the lids turn: by their muscles, with the gaze, pushed by the skin, and onto each other.

A lid's margin is a stiff plate, the tarsus, hung between its muscles and the skin around it. It
turns about the eyeball to where they balance: with κ the skin's share of the stiffness, θ_m the
angle at which levator and orbicularis would hold it and ψ the skin's own angle about the eye,

    k_m (θ_m - θ) + k_s (ψ - θ) = 0,    θ = (1 - κ) θ_m + κ ψ,    κ = k_s / (k_m + k_s).

So a raised cheek lifts the lower lid, and a brow the upper one. ψ is an angle of the tissue, which
has inertia and damping of its own: the plate, a tenth of a gram, has none.
"""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .tissue import Lids

LID_FOLLOWS = {"down": (0.80, 0.25), "up": (0.40, 0.10)}
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


def lids_with_gaze(angles: FloatArray, pitch: float) -> FloatArray:
    """Return the turn of the lids as the eyes look up or down, degrees, shape (2, 2).

    Args:
        angles: By the lids' own muscles: side, then upper (positive closes) and lower (positive
            raises).
        pitch: Of both eyes, degrees, up positive.
    """
    if pitch == 0.0:
        return angles
    upper, lower = LID_FOLLOWS["down" if pitch < 0.0 else "up"]
    followed = angles.copy()
    share = 1.0 - np.clip(angles[:, 0] / SHUT_ANGLE, 0.0, 1.0)
    followed[:, 0] -= share * upper * pitch
    followed[:, 1] += share * lower * pitch
    return followed


def lids_with_skin(
    angles: FloatArray, lids: Lids, x: FloatArray, share: tuple[float, float]
) -> FloatArray:
    """Return the turn of the lids as the skin around them pushes, degrees, shape (2, 2).

    Args:
        angles: Without the skin: side, then upper and lower.
        lids: The head's, with the skin that pushes.
        x: Positions of the nodes, mm, shape (3, nodes).
        share: κ of the upper and of the lower lid.
    """
    if len(lids.skin) == 0 or share == (0.0, 0.0):
        return angles
    kappa = np.array(share)
    skin = lids.skin_angles(x).reshape(2, 2)
    return np.asarray(angles + np.round(kappa * (skin - angles) / GRID) * GRID)


def lids_meeting(angles: FloatArray, opening: FloatArray) -> FloatArray:
    """Return the turn of lids that do not pass each other, degrees, shape (2, 2).

    The upper one, which travels farther, stops on the lower.

    Args:
        angles: Side, then upper and lower, degrees.
        opening: Of the eyes at rest, degrees, shape (2,).
    """
    met = angles.copy()
    met[:, 0] = np.minimum(angles[:, 0], MEETING * opening - angles[:, 1])
    return met
