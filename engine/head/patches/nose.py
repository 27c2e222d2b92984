"""The nose: rows b1 (glabella) to b8 (under the tip), the wing, the column and the nostril."""

from __future__ import annotations

import numpy as np

from .half import HalfCage

# Column 3 of the upper rows is the inner corner of the orbit's outer ring.
SIDE_OF_ROW = {1: "E4_2", 2: "E4_1", 3: "E4_0", 4: "E4_15"}

# The wing: a groove all round (b5_2 to b8_2 towards the tip, b5_3, b6_3, M4_3 towards the cheek),
# the ring A8, A5, A4, A3, A9 inside it, and the lobule A6, A7 with its rim R1, R2, R3.
WING = (
    ("b5_2", "b6_2", "A5", "A4"),
    ("b5_2", "A4", "A3", "b5_3"),
    ("A4", "A5", "A6", "A3"),
    ("b6_2", "b7_2", "A8", "A5"),
    ("A5", "A8", "A7", "A6"),
    ("b7_2", "b8_2", "R2", "A8"),
    ("A8", "R2", "R1", "A7"),
    ("b5_3", "A3", "A9", "b6_3"),
    ("A3", "A6", "A7", "A9"),
    ("b6_3", "A9", "R3", "M4_3"),
    ("A9", "A7", "R1", "R3"),
    ("M4_3", "R3", "M4_2"),
)
COLUMELLA = (("b8_0", "K0", "K1", "b8_1"), ("K0", "M4_0", "M4_1", "K1"))
UNDERSIDE = ("b8_1", "K1", "M4_1", "M4_2", "R3", "R1", "R2", "b8_2")
"""What surrounds the nostril, spoke by spoke: tip, column, sill, wing."""
SPOKES = len(UNDERSIDE)
OF_WING = (3, 4, 5, 6)

# The vestibule's two inner rings: share of the way to the middle, and the way up and back, mm.
VESTIBULE = (("H2", -0.06, (0.0, 4.0, -1.0)), ("H3", 0.4, (-1.0, 9.0, -3.5)))


def add_nose(half: HalfCage) -> None:
    """Add the faces of dorsum, tip, wing, column and nostril."""
    _add_dorsum(half)
    for corners in WING:
        half.face("ala", *corners)
    for corners in COLUMELLA:
        half.face("columella", *corners)
    _add_nostril(half)


def _row_point(row: int, column: int) -> str:
    if column < 3 or row in (5, 6):
        return f"b{row}_{column}"
    return SIDE_OF_ROW[row]


def _add_dorsum(half: HalfCage) -> None:
    for row in range(1, 8):
        # From row 5 on the wing takes the outer column's place.
        for column in range(3 if row < 5 else 2):
            half.face(
                "nose" if row < 5 else "nose_tip",
                _row_point(row, column),
                _row_point(row + 1, column),
                _row_point(row + 1, column + 1),
                _row_point(row, column + 1),
            )


def _add_nostril(half: HalfCage) -> None:
    rim = np.array([half.points[f"H1_{spoke}"] for spoke in range(SPOKES)])
    center = rim.mean(axis=0)
    for row, inwards, shift in VESTIBULE:
        for spoke, point in enumerate(rim):
            half.place(f"{row}_{spoke}", point + (center - point) * inwards + np.array(shift))
    for spoke in range(SPOKES):
        after = (spoke + 1) % SPOKES
        half.face(
            "ala" if spoke in OF_WING else "columella",
            UNDERSIDE[spoke],
            f"H1_{spoke}",
            f"H1_{after}",
            UNDERSIDE[after],
        )
        half.face("nostril", f"H1_{spoke}", f"H2_{spoke}", f"H2_{after}", f"H1_{after}")
        half.face("nostril", f"H2_{spoke}", f"H3_{spoke}", f"H3_{after}", f"H2_{after}")
    for spoke in range(SPOKES // 2 - 1):
        opposite = SPOKES - 1 - spoke
        half.face(
            "nostril",
            f"H3_{spoke}",
            f"H3_{spoke + 1}",
            f"H3_{opposite - 1}",
            f"H3_{opposite}",
        )
