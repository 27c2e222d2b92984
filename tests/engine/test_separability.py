"""Units can be told apart by what moves."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MOST_ALIKE, Separability, separability
from engine.separability import excused, similarity


@pytest.fixture(scope="module")
def found(standard_rig) -> Separability:
    return separability(standard_rig)


def test_no_two_units_look_alike(found):
    assert found.too_alike() == []


def test_every_unit_that_moves_skin_is_compared(standard_rig, found):
    rigid = {f"AU{n}" for n in (*range(51, 59), *range(61, 67))}
    assert set(found.units) == set(standard_rig.action_units) - rigid
    assert found.cosines == pytest.approx(found.cosines.T)
    assert np.diag(found.cosines) == pytest.approx(1.0)


def test_degrees_of_one_motion_are_excused_and_nothing_else():
    assert excused("AU25", "AU27")
    assert excused("AU43", "AU45")
    assert not excused("AU26", "AU43")
    assert not excused("AU23", "AU24")
    alike = similarity(["AU23", "AU24", "AU25", "AU26"], np.ones((4, 3)))
    pairs = {(one, other) for one, other, _ in alike.too_alike()}
    assert ("AU23", "AU24") in pairs
    assert ("AU25", "AU26") not in pairs
    assert MOST_ALIKE == 0.9


def test_similarity_is_the_cosine():
    found = similarity(["A", "B", "C"], np.array([[1.0, 0.0], [3.0, 3.0], [0.0, -2.0]]))
    assert found.cosines[0, 1] == pytest.approx(np.sqrt(0.5))
    assert found.pairs()[0][:2] == ("A", "B")
    assert found.cosines[1, 2] == pytest.approx(-np.sqrt(0.5))
