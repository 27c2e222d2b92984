"""Speech over a smile: it moves the mouth, and cheeks and eyes keep smiling."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Keyframe, Model, Rig, Simulator, builtin_rig
from engine.measure import CHEEK, CORNER, LOWER_LID, UPPER_LID

RIG: Rig = builtin_rig("standard")
SMILE = Keyframe(layer="emotion", action_units={"AU6": 0.8, "AU12": 0.8})
MOUTHS = {
    "aa": {"AU25": 0.6, "AU26": 0.6},
    "oo": {"AU18": 0.8, "AU22": 0.4, "AU26": 0.2},
    "ee": {"AU20": 0.5, "AU25": 0.6},
    "ch": {"AU22": 0.8, "AU25": 0.5, "AU16": 0.3},
    "pp": {"AU24": 0.7},
    "ff": {"AU28": 0.5, "AU10": 0.3},
    "mm": {"AU23": 0.6, "AU17": 0.4},
}
"""Mouths of speech, as units."""
LID_SHARE, CHEEK_SHARE = 0.95, 0.65
"""How much of its way in the smile a point keeps at least; a dropping jaw takes the cheek along."""


def settled() -> Simulator:
    """Return faces that smile, each with another mouth in `speech`, and one without."""
    simulator = Simulator(RIG, model=Model.for_rig(RIG, integrator="verlet"), threads=1)
    for name in ("silent", *MOUTHS):
        simulator.add(name)
        simulator.apply(name, SMILE)
        if name in MOUTHS:
            simulator.apply(name, Keyframe(layer="speech", action_units=MOUTHS[name]))
    for _ in range(70):
        simulator.step()
    return simulator


@pytest.fixture(scope="module")
def faces() -> dict[str, np.ndarray]:
    """Displacements of each face."""
    simulator = settled()
    return {name: simulator.frame(name).displacements for name in simulator.faces}


def kept(faces: dict[str, np.ndarray], mouth: str, point: str) -> float:
    """Return the share of its way in the smile that a point keeps."""
    index = RIG.head.point(point)
    smile, now = faces["silent"][index], faces[mouth][index]
    return float(now @ smile / (smile @ smile))


@pytest.mark.parametrize("mouth", MOUTHS)
def test_cheeks_and_eyes_keep_the_smile(faces: dict[str, np.ndarray], mouth: str) -> None:
    for lid in (UPPER_LID, LOWER_LID):
        assert LID_SHARE < kept(faces, mouth, lid) < 1.05
    assert CHEEK_SHARE < kept(faces, mouth, CHEEK) < 1.1


@pytest.mark.parametrize("mouth", MOUTHS)
def test_the_mouth_is_shaped_and_its_corner_stays_up(
    faces: dict[str, np.ndarray], mouth: str
) -> None:
    lips = [RIG.head.point(name) for name in ("M0_0", "M0_10", "M1_5.L")]
    assert np.linalg.norm(faces[mouth][lips] - faces["silent"][lips], axis=1).max() > 0.5
    assert faces[mouth][RIG.head.point(CORNER)][1] > 2.0


def test_speech_claims_what_it_moves_and_nothing_else() -> None:
    simulator = settled()
    zygomatic = RIG.muscle_names.index("zygomatic_major.L")
    silent = simulator.frame("silent").activations[zygomatic]
    for mouth in MOUTHS:
        assert simulator.frame(mouth).activations[zygomatic] == pytest.approx(silent, abs=1e-3)


def test_the_smile_returns_when_speech_ends() -> None:
    simulator = settled()
    corner = RIG.head.point(CORNER)
    simulator.apply("oo", Keyframe(layer="speech", fade=0.3, replace=True))
    ways, before = [], simulator.frame("oo").displacements[corner]
    for _ in range(90):
        simulator.step()
        now = simulator.frame("oo").displacements[corner]
        ways.append(np.linalg.norm(now - before) * 60.0)
        before = now
    smile = simulator.frame("silent").displacements[corner]
    assert np.abs(before - smile).max() < 0.3
    assert max(ways) < 100.0
