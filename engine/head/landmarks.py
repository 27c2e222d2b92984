"""Anthropometric landmarks: which point of the cage stands for each.

Names after Farkas, "Anthropometry of the Head and Face", 1994.
"""

from __future__ import annotations

import numpy as np

from ..arrays import IntArray
from .cage import Cage

MIDLINE = {
    "v": "T3_0",  # vertex, the top of the head
    "tr": "G4_0",  # trichion, the hairline
    "g": "G1_0",  # glabella
    "n": "b2_0",  # sellion, the root of the nose
    "prn": "b7_0",  # pronasale, its tip
    "sn": "M4_0",  # subnasale
    "ls": "M2_0",  # labiale superius, border of the upper lip
    "sto": "M0_0",  # stomion
    "li": "M2_10",  # labiale inferius
    "sl": "M4_10",  # sublabiale, the fold over the chin
    "pg": "C4_10",  # pogonion
    "gn": "C5_10",  # gnathion, the chin's lowest point
    "op": "W5_14",  # opisthocranion
}
PAIRED = {
    "en": "E1_0",  # inner corner of the eye
    "ex": "E1_8",  # outer corner
    "ps": "E1_4",  # middle of the upper lid's edge
    "pi": "E1_12",  # middle of the lower lid's edge
    "al": "A7",  # widest point of the nose
    "ch": "M1_5",  # corner of the mouth
    "zy": "W9_2",  # cheekbone
    "go": "W15_3",  # angle of the jaw
    "eu": "W4_4",  # widest point of the head
    "t": "P5_18",  # tragion, the notch over the tragus
    "sa": "P4_2",  # superaurale, the ear's top
    "sba": "P4_11",  # subaurale, its lowest point
    "pra": "P4_18",  # preaurale, its front edge
    "pa": "P4_6",  # postaurale, its back edge
    "obs": "P1_0",  # otobasion superius, where its front edge leaves the head
}


def landmark_vertices(cage: Cage, drawn: IntArray) -> dict[str, int]:
    """Return the drawn vertex of each landmark that the mesh has ("prn", "ch.L", "ch.R").

    Args:
        cage: The cage.
        drawn: Level vertex of each drawn vertex, shape (d,).
    """
    wanted = {name: cage.left[point] for name, point in MIDLINE.items()}
    for name, point in PAIRED.items():
        left = cage.left[point]
        wanted[f"{name}.L"] = left
        wanted[f"{name}.R"] = int(cage.mirror[left])
    place = np.full(max(int(drawn.max()) + 1, len(cage.points)), -1)
    # The first of several at one place.
    place[drawn[::-1]] = np.arange(len(drawn))[::-1]
    return {name: int(place[point]) for name, point in wanted.items() if place[point] >= 0}
