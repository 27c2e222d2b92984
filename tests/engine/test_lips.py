"""Lips that pucker stay shut, and lips that are sucked in take their red with them."""

from __future__ import annotations

import pytest

from engine import Keyframe
from engine.flesh import examine
from engine.measure import LIP_BOTTOM, LIP_TOP, Face, settle


def red_seen(face: Face, seam: str, crest: str, border: str) -> float:
    """Return the height of a lip's red as it is seen from the front, mm."""
    heights = [float(face.at(name)[1]) for name in (seam, crest, border)]
    return max(heights) - min(heights)


UPPER, LOWER = ("M0_1.L", "M1_1.L", "M2_1.L"), ("M0_9.L", "M1_9.L", "M2_9.L")


@pytest.mark.parametrize("intensity", [0.4, 1.0])
def test_puckered_lips_stay_shut(standard_rig, intensity):
    puckered = settle(standard_rig, [Keyframe(action_units={"AU18": intensity})])[0]
    assert puckered.distance(LIP_TOP, LIP_BOTTOM) < 1.2
    assert puckered.lips_forward() > 5.0 * intensity


def test_sucked_lips_take_their_red_in(standard_rig):
    rest, half, full = settle(
        standard_rig, [Keyframe(action_units={"AU28": k}) for k in (0.0, 0.5, 1.0)]
    )
    for lip, share in ((UPPER, 0.8), (LOWER, 0.9)):
        assert red_seen(full, *lip) < share * red_seen(rest, *lip)
        assert red_seen(full, *lip) < red_seen(half, *lip)
    assert -full.lips_forward() > 4.0
    # Rolled in, not pressed flat: the red's crest goes behind its border.
    assert float(full.at(UPPER[1])[2]) < float(full.at(UPPER[2])[2])
    assert examine(standard_rig, [Keyframe(action_units={"AU28": 1.0})])[0].inverted == 0
