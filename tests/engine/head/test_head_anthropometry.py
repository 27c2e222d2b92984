"""The standard head against published norms of the adult face."""

from __future__ import annotations

import numpy as np
import pytest

from engine.head import Head
from engine.head.anthropometry import MEASUREMENTS, measured, norms

STANDARD = norms(1.0)


@pytest.mark.parametrize("name", MEASUREMENTS)
def test_standard_head_is_the_norm(head: Head, name: str) -> None:
    """Every row, taken at the landmarks' vertices, is within 5 % or 2 mm of the men's mean."""
    mean = STANDARD[name].mean
    assert abs(measured(head.landmark_places)[name] - mean) < max(2.0, 0.05 * mean)


def test_profile(head: Head) -> None:
    """Angles and distances of the profile are those of a man's face, in the sagittal plane."""
    at = {name: place[1:] for name, place in head.landmark_places.items()}

    def angle(first: str, corner: str, second: str) -> float:
        one, other = at[first] - at[corner], at[second] - at[corner]
        cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
        return float(np.degrees(np.arccos(cosine)))

    assert 127 < angle("g", "n", "prn") < 140  # nasofrontal
    column = head.points[head.point("K0"), 1:]
    one, other = column - at["sn"], at["ls"] - at["sn"]
    cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
    assert 88 < np.degrees(np.arccos(cosine)) < 108  # nasolabial
    line = at["pg"] - at["prn"]
    ahead = np.array([-line[1], line[0]]) / np.linalg.norm(line)
    ahead *= np.sign(ahead[1])
    for spoke, nearest, farthest in (("M1_0", 1.0, 5.0), ("M1_10", 0.5, 4.0)):
        lip = head.points[head.point(spoke), 1:]
        assert nearest < -(lip - at["prn"]) @ ahead < farthest  # behind the line nose to chin


def test_frame(head: Head) -> None:
    """The pupil line is y = 0, the nose points along +z, the left is +x."""
    at = head.landmark_places
    assert abs(at["en.L"][1]) < 2
    assert abs(at["ex.L"][1]) < 2
    assert at["ex.L"][0] > 0
    assert at["prn"][2] == pytest.approx(head.drawn.vertices[:, 2].max(), abs=1.0)
    assert head.drawn.vertices[:, 1].min() == pytest.approx(-184, abs=2)


def test_lips_touch_but_do_not_cross(head: Head) -> None:
    for spoke in range(5):
        suffix = "" if spoke == 0 else ".L"
        upper = head.points[head.point(f"M0_{spoke}{suffix}")]
        lower = head.points[head.point(f"M0_{10 - spoke}{suffix}")]
        assert 0 < upper[1] - lower[1] < 0.3
