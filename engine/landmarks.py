"""The 68 landmarks of the iBUG 300-W markup, as points of the built-in heads.

Order and meaning: Sagonas et al., "300 Faces in-the-Wild Challenge", 2013. Trackers number them
from the face's own right; 0-16 run along the jaw, 17-26 the brows, 27-35 the nose, 36-47 the eyes,
48-67 the lips. The jaw's points are silhouettes in a picture and fixed points of skin here.
"""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .errors import UnknownName
from .head import Head
from .head.landmarks import MIDLINE, PAIRED

_RIGHT_JAW = ("W9_2", "W11_1", "W12_1", "W13_1", "C8_6", "C7_7", "C6_8", "C5_9")
_RIGHT_BROW = ("E4_6", "E4_5", "E4_4", "E4_3", "E4_2")
_NOSE = ("b2_0", "b3_0", "b5_0", "b7_0", "R1.R", "M4_1.R", "M4_0", "M4_1.L", "R1.L")
_RIGHT_EYE = ("E1_8", "E1_5", "E1_3", "E1_0", "E1_13", "E1_11")
_LEFT_EYE = ("E1_0", "E1_3", "E1_5", "E1_8", "E1_11", "E1_13")
_OUTER_LIPS = ("M1_5.R", "M2_3.R", "M2_1.R", "M2_0", "M2_1.L", "M2_3.L")
_OUTER_LIPS_BELOW = ("M1_5.L", "M2_7.L", "M2_9.L", "M2_10", "M2_9.R", "M2_7.R")
_INNER_LIPS = ("M0_5.R", "M0_2.R", "M0_0", "M0_2.L", "M0_5.L", "M0_8.L", "M0_10", "M0_8.R")


def _of_side(points: tuple[str, ...], side: str) -> tuple[str, ...]:
    return tuple(f"{point}.{side}" for point in points)


LANDMARKS_68: tuple[str, ...] = (
    *_of_side(_RIGHT_JAW, "R"),
    "C5_10",
    *_of_side(_RIGHT_JAW[::-1], "L"),
    *_of_side(_RIGHT_BROW, "R"),
    *_of_side(_RIGHT_BROW[::-1], "L"),
    *_NOSE,
    *_of_side(_RIGHT_EYE, "R"),
    *_of_side(_LEFT_EYE, "L"),
    *_OUTER_LIPS,
    *_OUTER_LIPS_BELOW,
    *_INNER_LIPS,
)
"""Cage point of each landmark, in order."""


def named_point(head: Head, name: str) -> int:
    """Return the tissue point that a landmark's name stands for.

    Args:
        head: A built-in head.
        name: A cage point ("M1_5.L"), one of the 68 by its number ("48"), or an anthropometric
            landmark ("ch.L", "prn").

    Raises:
        UnknownName: With the nearest names there are.
    """
    if name.isdecimal() and int(name) < len(LANDMARKS_68):
        return head.point(LANDMARKS_68[int(name)])
    stem, _, side = name.partition(".")
    cage = MIDLINE.get(name) or (f"{PAIRED[stem]}.{side}" if stem in PAIRED and side else name)
    if cage in head.names and cage:
        return head.point(cage)
    known = {point for point in head.names if point}
    known |= {mark for mark, point in MIDLINE.items() if point in known}
    known |= {
        f"{mark}.{each}"
        for mark, point in PAIRED.items()
        for each in "LR"
        if f"{point}.{each}" in known
    }
    numbers = map(str, range(len(LANDMARKS_68)))
    raise UnknownName("landmark", name, known.union(numbers) if known else ())


def landmarks_68(head: Head, displacements: FloatArray) -> FloatArray:
    """Return the 68 landmarks of a displaced tissue surface, head frame, mm, shape (68, 3).

    Args:
        head: A built-in head.
        displacements: Of its tissue surface from rest, mm, shape (s, 3).

    Raises:
        UnknownName: If the head has no named points.
    """
    index = [head.point(name) for name in LANDMARKS_68]
    return np.asarray(head.points[index] + displacements[index])
