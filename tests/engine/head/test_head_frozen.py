"""The face's points and faces are frozen: muscles, landmarks, fields and people hang on them.

A person moves the points; nothing may rename one, take one out or join them differently.
"""

from __future__ import annotations

import hashlib
from collections import Counter

from engine.head.cage import build_half

ROWS = {
    **{row: 16 for row in ("EB", "E0", "E1", "E2", "E3", "E4")},  # lids and orbit
    **{row: 11 for row in ("S1", "S2", "S3", "S4", "M0", "M1", "M2", "M3", "M4")},  # mouth
    **{f"b{row}": 3 for row in (1, 2, 3, 4, 7, 8)},  # dorsum and tip of the nose
    "b5": 4,
    "b6": 4,
    **{name: 1 for name in ("A3", "A4", "A5", "A6", "A7", "A8", "A9")},  # its wing
    **{name: 1 for name in ("R1", "R2", "R3", "K0", "K1")},  # the wing's rim, the column
    **{row: 8 for row in ("H1", "H2", "H3")},  # nostril
    **{row: 8 for row in ("G1", "G2", "G3", "G4")},  # forehead
    **{f"C{column}": 10 for column in (4, 5, 6, 7, 8)},  # cheek and chin
}
FACES = 302
FINGERPRINT = "a8aef27307d7439b"


def test_points_of_the_face() -> None:
    found = Counter(name.split("_")[0] for name in build_half().points)
    assert {row: found[row] for row in ROWS} == ROWS


def test_faces_of_the_face() -> None:
    half = build_half()
    rows = set(ROWS)
    faces = sorted(
        f"{region}: {' '.join(sorted(corners))}"
        for region, corners in zip(half.regions, half.faces, strict=True)
        if {name.split("_")[0] for name in corners} <= rows
    )
    assert len(faces) == FACES
    assert hashlib.sha256("\n".join(faces).encode()).hexdigest()[:16] == FINGERPRINT
