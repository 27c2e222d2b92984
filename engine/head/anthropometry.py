"""Distances between landmarks, and what they are in people: norms by sex.

Population: North American White young adults, 19 to 25 years (Farkas, "Anthropometry of the Head
and Face", 1994; fourteen of the rows again in Farkas et al., "International Anthropometric Study
of Facial Morphology in Various Ethnic Groups/Races", J. Craniofac. Surg. 16, 2005). The figures are
those commonly quoted from these tables; no copy of them was at hand to check them line by line.
`UNCHECKED` names the rows for which quotations differ by more than a standard error.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray

MEASUREMENTS: Mapping[str, tuple[str, str]] = {
    "tr-n": ("tr", "n"),  # height of the forehead
    "n-gn": ("n", "gn"),  # height of the face
    "n-sn": ("n", "sn"),  # height of the nose
    "sn-gn": ("sn", "gn"),  # height of the lower face
    "sn-sto": ("sn", "sto"),  # height of the upper lip
    "ls-sto": ("ls", "sto"),  # red of the upper lip
    "sto-li": ("sto", "li"),  # red of the lower lip
    "sn-prn": ("sn", "prn"),  # protrusion of the nose
    "al-al": ("al.L", "al.R"),  # width of the nose
    "ch-ch": ("ch.L", "ch.R"),  # width of the mouth
    "en-en": ("en.L", "en.R"),  # between the inner corners of the eyes
    "ex-ex": ("ex.L", "ex.R"),  # between the outer corners
    "en-ex": ("en.L", "ex.L"),  # length of the eye fissure
    "ps-pi": ("ps.L", "pi.L"),  # height of the eye fissure
    "zy-zy": ("zy.L", "zy.R"),  # width of the face
    "go-go": ("go.L", "go.R"),  # width of the jaw
    "eu-eu": ("eu.L", "eu.R"),  # width of the head
    "g-op": ("g", "op"),  # length of the head
    "v-gn": ("v", "gn"),  # height of head and face
}
"""Landmarks at the ends of each measurement, named as in `landmarks.py`."""

PROJECTED = ("v-gn",)
"""Measurements that are taken along the vertical, not from point to point."""


class Norm(NamedTuple):
    """A measurement in a population, mm."""

    mean: float
    sd: float


_MEN: Mapping[str, Norm] = {
    "tr-n": Norm(67.1, 7.5),
    "n-gn": Norm(124.7, 5.7),
    "n-sn": Norm(54.8, 3.3),
    "sn-gn": Norm(72.6, 4.5),
    "sn-sto": Norm(22.3, 2.1),
    "ls-sto": Norm(8.0, 1.4),
    "sto-li": Norm(9.3, 1.6),
    "sn-prn": Norm(19.5, 1.9),
    "al-al": Norm(34.9, 2.1),
    "ch-ch": Norm(54.5, 3.0),
    "en-en": Norm(33.3, 2.7),
    "ex-ex": Norm(91.2, 3.0),
    "en-ex": Norm(31.3, 1.2),
    "ps-pi": Norm(10.8, 0.9),
    "zy-zy": Norm(139.1, 5.3),
    "go-go": Norm(105.6, 6.7),
    "eu-eu": Norm(151.1, 5.6),
    "g-op": Norm(196.5, 7.0),
    "v-gn": Norm(230.0, 9.0),
}
_WOMEN: Mapping[str, Norm] = {
    "tr-n": Norm(63.0, 6.0),
    "n-gn": Norm(111.4, 4.8),
    "n-sn": Norm(50.6, 3.1),
    "sn-gn": Norm(64.3, 4.0),
    "sn-sto": Norm(20.1, 2.0),
    "ls-sto": Norm(8.7, 1.3),
    "sto-li": Norm(9.4, 1.5),
    "sn-prn": Norm(19.7, 1.6),
    "al-al": Norm(31.4, 2.0),
    "ch-ch": Norm(50.2, 3.5),
    "en-en": Norm(31.8, 2.3),
    "ex-ex": Norm(87.8, 3.2),
    "en-ex": Norm(30.7, 1.2),
    "ps-pi": Norm(10.9, 1.2),
    "zy-zy": Norm(130.0, 4.6),
    "go-go": Norm(94.5, 5.0),
    "eu-eu": Norm(144.1, 5.0),
    "g-op": Norm(186.5, 6.0),
    "v-gn": Norm(217.0, 7.5),
}
UNCHECKED = ("ps-pi", "eu-eu", "g-op", "v-gn")


def norms(sex: float) -> Mapping[str, Norm]:
    """Return the norm of each measurement at `sex`, 0 female to 1 male, between them in proportion.

    The population is named at the head of this file.
    """
    return {
        name: Norm(
            (1 - sex) * woman.mean + sex * _MEN[name].mean,
            (1 - sex) * woman.sd + sex * _MEN[name].sd,
        )
        for name, woman in _WOMEN.items()
    }


def measured(landmarks: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return each measurement, mm, between landmarks such as `Head.landmark_places`.

    Raises:
        KeyError: A landmark is missing, as on meshes from files.
    """
    spans = {
        name: landmarks[first] - landmarks[second] for name, (first, second) in MEASUREMENTS.items()
    }
    return {
        name: float(abs(span[1]) if name in PROJECTED else np.linalg.norm(span))
        for name, span in spans.items()
    }
