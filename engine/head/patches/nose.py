"""The nose: rows b1 (glabella) to b8 (under the tip), the wing, the column and the nostril."""

from __future__ import annotations

import numpy as np

from .half import HalfCage

# Column 3 of the upper rows is the inner corner of the orbit's outer ring.
SIDE_OF_ROW = {1: "E4_2", 2: "E4_1", 3: "E4_0", 4: "E4_15"}

WING = (
    ("b5_2", "b6_2", "A6", "b5_3"),
    ("b5_3", "A6", "A7", "b6_3"),
    ("b6_2", "b7_2", "A7", "A6"),
    ("b6_3", "A7", "R1", "M4_3"),
    ("b7_2", "b8_2", "R1", "A7"),
    ("M4_3", "R1", "M4_2"),
)
COLUMELLA = (("b8_0", "K0", "K1", "b8_1"), ("K0", "M4_0", "M4_1", "K1"))
UNDERSIDE = ("b8_1", "K1", "M4_1", "M4_2", "R1", "b8_2")


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
    rim = np.array([half.points[f"H1_{spoke}"] for spoke in range(6)])
    center = rim.mean(axis=0)
    for spoke, point in enumerate(rim):
        half.place(f"H2_{spoke}", point + (center - point) * 0.12 + np.array([-0.5, 4.5, 0.8]))
        half.place(f"H3_{spoke}", point + (center - point) * 0.5 + np.array([-1.2, 9.5, 0.5]))
    for spoke in range(6):
        after = (spoke + 1) % 6
        half.face(
            "ala" if spoke in (3, 4) else "columella",
            UNDERSIDE[spoke],
            f"H1_{spoke}",
            f"H1_{after}",
            UNDERSIDE[after],
        )
        half.face("nostril", f"H1_{spoke}", f"H2_{spoke}", f"H2_{after}", f"H1_{after}")
        half.face("nostril", f"H2_{spoke}", f"H3_{spoke}", f"H3_{after}", f"H2_{after}")
    half.face("nostril", "H3_0", "H3_1", "H3_2", "H3_3")
    half.face("nostril", "H3_0", "H3_3", "H3_4", "H3_5")
