"""The lids and the orbit: six rings of sixteen spokes round the eye.

Spoke 0 is the inner corner, 4 the top, 8 the outer corner, 12 the bottom. From inside out: EB the
hidden back of the lids, E0 and E1 the back and front edge of the lid margin, E2 the crease of the
upper lid, E3 the orbital fold, E4 the brow above and the rim of the orbit below.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from .half import HalfCage

SPOKES = 16
EYE_CENTER = np.array([31.0, 0.0, 72.3])
EYE_RADIUS = 12.0

# Distances from the eye's centre, mm: the drawn eye has 12, its cornea stands 1.25 out.
FRONT_EDGE_RADIUS = 13.1
BACK_EDGE_RADIUS = 12.45
LID_BACK_RADIUS = 13.3

# How much of a lid's full thickness the margin has at each spoke; thin at the corners.
MARGIN_THICKNESS = (
    0.2, 0.5, 0.8, 1.0, 1.0, 1.0, 0.9, 0.6, 0.2, 0.6, 0.9, 1.0, 1.0, 1.0, 0.8, 0.5,
)  # fmt: skip

BANDS = (
    ("EB", "E0", "lid_inner"),
    ("E0", "E1", "lid_margin"),
    ("E1", "E2", "eyelid"),
    ("E2", "E3", "orbital"),
    ("E3", "E4", "orbital"),
)


def add_eye(half: HalfCage) -> None:
    """Derive the hidden rings from the authored front edge E1 and add the lid and orbit faces."""
    for spoke in range(SPOKES):
        front = lift_to_ball(half.points[f"E1_{spoke}"], FRONT_EDGE_RADIUS)
        back = _back_edge(front, spoke)
        half.place(f"E1_{spoke}", front)
        half.place(f"E0_{spoke}", back)
        half.place(f"EB_{spoke}", _lid_back(back, spoke))
    for inner, outer, region in BANDS:
        for spoke in range(SPOKES):
            _add_face(half, inner, outer, spoke, region)


def lift_to_ball(point: FloatArray, radius: float) -> FloatArray:
    """Return `point` moved forward until it is `radius` from the eye's centre, if it is inside."""
    offset = point - EYE_CENTER
    depth = radius**2 - offset[0] ** 2 - offset[1] ** 2
    lifted = point.copy()
    if depth > 0:
        lifted[2] = max(lifted[2], EYE_CENTER[2] + np.sqrt(depth))
    return lifted


def _back_edge(front: FloatArray, spoke: int) -> FloatArray:
    thickness = MARGIN_THICKNESS[spoke]
    inwards = {0: 1.0, 8: -1.0}.get(spoke, 0.0)
    rise = 0.35 if spoke > 8 else 0.25
    back = front + np.array([inwards, rise * thickness, -1.7 * thickness - 0.5])
    offset = back - EYE_CENTER
    distance = float(np.linalg.norm(offset))
    return np.asarray(EYE_CENTER + offset * max(1.0, BACK_EDGE_RADIUS / distance))


def _lid_back(back_edge: FloatArray, spoke: int) -> FloatArray:
    offset = back_edge - EYE_CENTER
    if spoke in (0, 8):
        inwards = {0: 0.0, 8: -0.8}[spoke]
        return np.asarray(back_edge + np.array([inwards, 0.0, -6.0]))
    across, up = offset[0] * 1.12, offset[1] * 1.9
    depth = LID_BACK_RADIUS**2 - across**2 - up**2
    back = np.array([across, up, np.sqrt(depth) if depth > 4 else 2.0])
    # Farther out at the side it would come through the thin skin when that is pulled inwards.
    return np.asarray(EYE_CENTER + back * min(1.0, LID_BACK_RADIUS / float(np.linalg.norm(back))))


def _add_face(half: HalfCage, inner: str, outer: str, spoke: int, region: str) -> None:
    following = (spoke + 1) % SPOKES
    side = "upper" if spoke < 8 else "lower"
    is_brow = outer == "E4" and 2 <= spoke <= 6
    half.face(
        "brow" if is_brow else f"{side}_{region}",
        f"{inner}_{spoke}",
        f"{outer}_{spoke}",
        f"{outer}_{following}",
        f"{inner}_{following}",
    )
