"""Lids: between their muscles and the skin, and onto each other."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Keyframe, Simulator
from engine.lids import GRID, MEETING, stand_lids
from engine.measure import CHEEK, INNER_BROW, LOWER_LID, OUTER_BROW, UPPER_LID, Face, settle
from engine.skull import turn_lids
from engine.tissue.contact import lids_of


def test_the_skin_of_a_turned_ring_has_turned_as_far(standard_rig):
    """ψ of skin that turns about the eye as a whole is the turn, signed as lids are."""
    head = standard_rig.head
    lids = lids_of(head)
    x = np.tile(head.points[: head.sheet_count], (3, 1))
    assert lids.skin_angles(x.T) == pytest.approx(np.zeros(4))
    turn = np.radians(5.0)
    y, z = lids.skin_place
    x[lids.skin, 1] = np.cos(turn) * y - np.sin(turn) * z + lids.skin_center[0]
    x[lids.skin, 2] = np.sin(turn) * y + np.cos(turn) * z + lids.skin_center[1]
    assert lids.skin_angles(x.T) == pytest.approx([5.0, -5.0, 5.0, -5.0])
    # The sign is that of turn_lids: a lid at +5 degrees goes where that skin went.
    moved = turn_lids(lids, head.points[lids.nodes], np.array([5.0, 0.0, 0.0, 0.0]))
    upper = (lids.channel == 0) & (lids.share > 0.0)
    assert (moved[upper, 1] < head.points[lids.nodes[upper], 1]).all()


WIDE = np.array([80.0, 80.0])


def test_a_lid_stands_where_muscle_and_skin_balance():
    held = np.array([[10.0, 4.0], [0.0, 0.0]])
    skin = np.array([0.0, 0.0, 5.0, -5.0])
    stood = stand_lids(held, 0.0, skin, np.array([0.1, 0.3]), WIDE)
    assert stood == pytest.approx(np.array([[9.0, 2.8], [0.5, -1.5]]), abs=GRID)
    assert (stand_lids(held, 0.0, skin, np.zeros(2), WIDE) == held).all()


def test_lids_follow_the_gaze_while_they_are_open():
    own = np.array([[0.0, 0.0], [40.0, 0.0]])
    down = stand_lids(own, -10.0, np.zeros(4), np.zeros(2), WIDE)
    assert down == pytest.approx(np.array([[8.0, -2.5], [40.0, 0.0]]))
    up = stand_lids(own, 10.0, np.zeros(4), np.zeros(2), WIDE)
    assert up == pytest.approx(np.array([[-4.0, 1.0], [40.0, 0.0]]))


def test_shut_lids_do_not_pass_each_other():
    own = np.array([[45.0, 8.0], [10.0, 8.0]])
    met = stand_lids(own, 0.0, np.zeros(4), np.zeros(2), np.array([40.0, 40.0]))
    assert met == pytest.approx(np.array([[MEETING * 40.0 - 8.0, 8.0], [10.0, 8.0]]))


def test_the_cheek_lifts_the_lower_lid_and_the_brow_the_upper(standard_rig):
    """Without the skin's push the same muscles leave the lids where they are."""
    free = standard_rig.derive(tissue={"upper_lid_skin": 0.0, "lower_lid_skin": 0.0})
    cheek = Keyframe(muscles={f"orbicularis_oculi.{side}": 1.4 for side in "LR"})
    brow = Keyframe(muscles={f"frontalis_lateral.{side}": 1.2 for side in "LR"})
    raised, lifted = settle(standard_rig, [cheek, brow])
    without, unlifted = settle(free, [cheek, brow])
    assert raised.u(CHEEK)[1] > 2.0
    assert raised.u(LOWER_LID)[1] > without.u(LOWER_LID)[1] + 0.4
    assert abs(without.u(LOWER_LID)[1]) < 0.05
    assert lifted.u(UPPER_LID)[1] > unlifted.u(UPPER_LID)[1] + 0.15


def test_shut_eyes_are_shut_along_their_whole_length(standard_rig):
    shut, blink, tight, pushed = settle(
        standard_rig,
        [
            Keyframe(action_units={"AU43": 1.0}),
            Keyframe(action_units={"AU45": 1.0}),
            Keyframe(action_units={"AU43": 1.0, "AU7": 1.0}),
            Keyframe(action_units={"AU43": 1.0, "AU6": 1.0}),
        ],
    )
    for face in (shut, blink):
        assert_shut(face, 0.1)
    # A lower lid that is raised meets the upper one higher, where the fissure has another shape.
    for face in (tight, pushed):
        assert_shut(face, 0.2)
        assert face.gap(UPPER_LID, LOWER_LID) < 0.1


def assert_shut(face: Face, most: float) -> None:
    """Check that the lids leave at most `most` mm, and pass each other by no more than 0.15 mm."""
    gaps = [
        face.gap(f"E1_{spoke}.{side}", f"E1_{16 - spoke}.{side}")
        for spoke in range(1, 8)
        for side in "LR"
    ]
    assert max(gaps) < most
    assert min(gaps) > -0.15


def test_a_face_with_pushed_lids_falls_asleep(standard_rig):
    simulator = Simulator(standard_rig)
    simulator.add("face")
    simulator.apply("face", Keyframe(emotion=("happiness", 1.0)))
    for _ in range(240):
        simulator.step()
    assert simulator.frame("face").asleep


@pytest.mark.parametrize("unit", ["AU42", "AU43", "AU45"])
def test_closing_the_eyes_leaves_the_brows_where_they_are(standard_rig, unit):
    """A shut lid unfolds; the brow over it stays."""
    shut = settle(standard_rig, [Keyframe(action_units={unit: 1.0})])[0]
    for brow in (INNER_BROW, "E4_4.L", OUTER_BROW):
        assert abs(shut.u(brow)[1]) < 1.0, brow
