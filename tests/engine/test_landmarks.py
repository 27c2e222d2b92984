"""The 68 landmarks stand where the markup says, on both built-in heads."""

from __future__ import annotations

import numpy as np
import pytest

from engine import landmarks_68
from engine.landmarks import LANDMARKS_68


@pytest.mark.parametrize("name", ["standard_rig", "paper_rig"])
def test_the_markup_is_laid_out_as_trackers_number_it(name, request):
    head = request.getfixturevalue(name).head
    points = landmarks_68(head, np.zeros_like(head.points))
    assert points.shape == (68, 3)
    assert len(set(LANDMARKS_68)) == 68
    x, y, z = points.T
    assert (np.diff(x[:17]) > 0.0).all(), "the jaw runs from the face's right to its left"
    assert y[8] == y[:17].min(), "its middle is the chin"
    assert (np.diff(x[17:27]) > 0).all(), "the brows run from right to left"
    assert (np.diff(y[27:31]) < 0).all(), "the bridge of the nose runs down"
    assert z[30] == z.max(), "its tip is foremost"
    assert x[36:42].max() < 0 < x[42:48].min(), "the face's right eye comes first"
    assert y[37] > y[41], "its upper lid before its lower"
    assert y[44] > y[46]
    assert x[48] == x[48:].min(), "the lips start at the right corner"
    assert x[54] == x[48:].max()
    assert y[51] > y[62] > y[66] > y[57], "upper border, both edges, lower border"


def test_mirrored_landmarks_mirror(standard_rig):
    head = standard_rig.head
    points = landmarks_68(head, np.zeros_like(head.points))
    assert points[:17] == pytest.approx(points[16::-1] * [-1, 1, 1])
    assert points[36:40] == pytest.approx(points[[45, 44, 43, 42]] * [-1, 1, 1])
