"""The lips and the sock behind them: rings of spokes round the mouth.

Spoke 0 is the upper midline, 5 the corner, 10 the lower midline; upper and lower lip share only the
corner. From inside out: S4, S3, S2, S1 the sock, M0 the contact line, M1 the crest of the lip, M2
its border, M3 the skin beside it, M4 from the nose's base round to the groove over the chin.
"""

from __future__ import annotations

from .half import HalfCage

LAST_SPOKE = 10
CORNER = 5
MIDDLE_HEIGHT = -71.5

BANDS = (
    ("S4", "S3", "mouth_inner"),
    ("S3", "S2", "mouth_inner"),
    ("S2", "S1", "mouth_inner"),
    ("S1", "M0", "{side}_lip_inner"),
    ("M0", "M1", "{side}_lip"),
    ("M1", "M2", "{side}_lip"),
    ("M2", "M3", "perioral_{side}"),
)


def add_mouth(half: HalfCage) -> None:
    """Derive the sock from the contact line and add the faces of sock, lips and surroundings."""
    _place_sock(half)
    for spoke in range(LAST_SPOKE):
        side = "upper" if spoke < CORNER else "lower"
        for inner, outer, region in BANDS:
            _add_face(half, inner, outer, spoke, region.format(side=side))
        _add_face(half, "M3", "M4", spoke, _outer_region(spoke))
    for spoke in range(CORNER - 1):
        opposite = LAST_SPOKE - spoke
        half.face(
            "mouth_inner",
            f"S4_{spoke}",
            f"S4_{spoke + 1}",
            f"S4_{opposite - 1}",
            f"S4_{opposite}",
        )
    half.face("mouth_inner", "S4_4", "S4_5", "S4_6")


def _place_sock(half: HalfCage) -> None:
    for spoke in range(LAST_SPOKE + 1):
        x, y, z = half.points[f"M0_{spoke}"]
        up = 1 if spoke <= CORNER else -1
        opening = up * min(1.0, abs(CORNER - spoke) / 2)
        inwards = -0.3 if abs(spoke - CORNER) <= 1 else 0.0
        half.place(f"S1_{spoke}", [x + inwards, y + 1.2 * opening, z - 4])
        behind = 5 if spoke == CORNER else 8
        half.place(f"S2_{spoke}", [x * 0.98, MIDDLE_HEIGHT + 9 * opening, z - behind])
        half.place(f"S3_{spoke}", [x * 0.97, MIDDLE_HEIGHT + 13 * opening, z * 0.75 - 2])
        half.place(f"S4_{spoke}", [x * 0.95, MIDDLE_HEIGHT + 15 * opening, 45 + (z - 88) / 2])


def _outer_region(spoke: int) -> str:
    if spoke == 0:
        return "philtrum"
    if spoke < CORNER:
        return "perioral_upper"
    return "chin" if spoke > 7 else "perioral_lower"


def _add_face(half: HalfCage, inner: str, outer: str, spoke: int, region: str) -> None:
    half.face(
        region,
        f"{inner}_{spoke}",
        f"{outer}_{spoke}",
        f"{outer}_{spoke + 1}",
        f"{inner}_{spoke + 1}",
    )
