"""Where cropped hair grows: inside an outline drawn on the head's profile."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray
from .anatomy import smoothstep
from .noise import noise

# The hairline in the profile plane as (z, y), mm: forehead, temple, sideburn, round the ear, nape;
# closed far outside the head.
OUTLINE = np.array([
    (101, 73), (89, 72.5), (78, 69.5), (67, 65), (57, 55), (49, 43), (44, 34), (33, 23), (25, 8),
    (19, -8), (15, -24), (9, -30), (3, -26), (-3, -14), (-12, -8), (-27, -12), (-36, -30),
    (-42, -58), (-50, -80), (-75, -88), (-120, -88), (-120, 140), (110, 140),
], dtype=float)  # fmt: skip
EAR_CENTER = np.array([-14.0, -6.0])
EAR_RADII = np.array([8.0, 12.0])
FADE = (-7.0, 11.0)
"""Distance inside the outline [mm] over which hair grows from none to full."""
SIDES = 0.66
"""How densely hair grows at the sideburns and the nape, where it is cut shortest."""
SIDES_BELOW = (42.0, -35.0)
"""Heights [mm] between which it thins to that."""


def hair_mask(vertices: FloatArray) -> FloatArray:
    """Return how densely hair grows at points (n, 3), 0..1, shape (n,)."""
    profile = vertices[:, [2, 1]]
    distance = distance_inside(profile, OUTLINE)
    # No hair grows under the ear.
    under_ear = np.hypot(*((profile - EAR_CENTER) / EAR_RADII).T) - 1
    distance = np.minimum(distance, under_ear * EAR_RADII.min())
    distance += 1.1 * noise(vertices, 5.0, 5)
    # The front hairline is softer and less even than the nape.
    distance += 1.6 * noise(vertices, 11.0, 6) * smoothstep(40, 75, vertices[:, 2])
    shorn = 1 - (1 - SIDES) * smoothstep(*SIDES_BELOW, vertices[:, 1])
    return np.asarray(smoothstep(*FADE, distance) * shorn)


def distance_inside(points: FloatArray, outline: FloatArray) -> FloatArray:
    """Return the distance from points (n, 2) to a closed outline (k, 2), negative outside."""
    starts, ends = outline, np.roll(outline, -1, axis=0)
    side = ends - starts
    offset = points[:, None, :] - starts
    share = np.clip((offset * side).sum(axis=2) / (side**2).sum(axis=1), 0, 1)
    gap = np.linalg.norm(offset - share[..., None] * side, axis=2).min(axis=1)
    return np.asarray(np.where(inside_outline(points, outline), gap, -gap))


def inside_outline(points: FloatArray, outline: FloatArray) -> BoolArray:
    """Return which points (n, 2) lie inside a closed outline (k, 2): an odd number of crossings."""
    x, y = points[:, :1], points[:, 1:]
    (x1, y1), (x2, y2) = outline.T, np.roll(outline, -1, axis=0).T
    spans = (y1 > y) != (y2 > y)
    rise = np.where(y2 == y1, 1.0, y2 - y1)
    crossing = x1 + (y - y1) * (x2 - x1) / rise
    return np.asarray((spans & (x < crossing)).sum(axis=1) % 2 == 1)
