"""The five letters of FACS' intensity as numbers: in even steps, or by FACS' uneven bands."""

from __future__ import annotations

from collections.abc import Mapping

from ..errors import UnknownName

LETTERS: Mapping[str, float] = {"A": 0.2, "B": 0.4, "C": 0.6, "D": 0.8, "E": 1.0}
"""FACS intensities A (trace) to E (maximum) in even steps, as trackers count them."""
BANDED: Mapping[str, float] = {"A": 0.10, "B": 0.20, "C": 0.55, "D": 0.90, "E": 1.00}
"""The same by the bands of the FACS manual's scale, which are uneven: trace and slight are
narrow, marked and severe are wide. The manual draws them and gives no numbers; these are ours."""
SCALES: Mapping[str, Mapping[str, float]] = {"linear": LETTERS, "banded": BANDED}
"""How letters are read, by name."""
UNSCORED = "C"
"""Letter of a unit that is written without one, or with `*`: the middle of the scale."""


def scale_named(name: str) -> Mapping[str, float]:
    """Return the intensity of each letter on a scale.

    Raises:
        UnknownName: If there is no such scale.
    """
    if name not in SCALES:
        raise UnknownName("scale", name, SCALES)
    return SCALES[name]


def letter_of(intensity: float, scale: str = "linear") -> str | None:
    """Return the letter that stands for exactly this intensity on a scale, None if none does.

    Raises:
        UnknownName: If there is no such scale.
    """
    for letter, value in scale_named(scale).items():
        if value == intensity:
            return letter
    return None


def nearest_letter(intensity: float, scale: str = "linear") -> str:
    """Return the letter whose intensity is nearest on a scale; of two as near, the lower.

    Raises:
        UnknownName: If there is no such scale.
    """
    letters = scale_named(scale)
    return min(letters, key=lambda letter: abs(letters[letter] - intensity))
