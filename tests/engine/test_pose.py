"""The tongue put out, and the other poses that only turn or shift what is rigid."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Keyframe, Rig, Simulator, builtin_rig
from engine.gltf.pose import motions
from engine.gltf.tongue import posed_tongue
from engine.head.parts.tongue import FULL_THRUST, tongue_out


def settled(rig: Rig, **units: float):
    simulator = Simulator(rig)
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units=units))
    for _ in range(60):
        simulator.step()
    return simulator.frame("face")


@pytest.mark.parametrize("name", ["standard", "mei"])
def test_it_comes_out_between_the_lips_and_stays_in_one_piece(name):
    rig = builtin_rig(name)
    part = next(p for p in rig.head.parts if p.name == "tongue")
    frame = settled(rig, AU19=1.0)
    vertices, normals = posed_tongue(part, frame.pose)
    placed = motions(rig.head, rig.jaw, frame.pose)["jaw"].move(vertices)
    lips = [rig.head.point(p) for p in ("M0_0", "M0_10")]
    upper, lower = (rig.head.points + frame.displacements)[lips]
    tip = placed[placed[:, 2].argmax()]
    assert tip[2] > max(upper[2], lower[2]) + 5.0
    assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-6
    # What passes the line of the lips passes between them, and is narrower than the mouth.
    there = placed[np.abs(placed[:, 2] - lower[2]) < 3.0]
    assert lower[1] - 2.5 < there[:, 1].min()
    assert there[:, 1].max() < upper[1]
    assert np.abs(there[:, 0]).max() < 20.0
    root = part.vertices[:, 2].argmin()
    assert np.abs(tongue_out(part.vertices)[root]).max() < 0.5


def test_half_a_thrust_is_half_the_way(standard_rig):
    part = next(p for p in standard_rig.head.parts if p.name == "tongue")
    frame = settled(standard_rig, AU19=0.5)
    assert frame.pose.tongue_thrust == pytest.approx(FULL_THRUST / 2, abs=0.01)
    moved = posed_tongue(part, frame.pose)[0] - part.vertices
    assert moved == pytest.approx(0.5 * tongue_out(part.vertices), abs=0.01)


def test_eyes_cross_and_the_head_goes_forward(standard_rig):
    frame = settled(standard_rig, AU57=1.0, AU61=0.5, AU66=0.5)
    pose = frame.pose
    assert pose.head_thrust == pytest.approx(35.0, abs=0.1)
    assert pose.gaze_left[0] == pytest.approx(16.0 - 11.0, abs=0.1)
    assert pose.gaze_right[0] == pytest.approx(16.0 + 11.0, abs=0.1)
    assert motions(standard_rig.head, standard_rig.jaw, pose)["head"].shift[2] == pose.head_thrust
    assert np.abs(frame.displacements).max() < 0.05


def test_one_sided_units_go_to_their_side(standard_rig):
    index = standard_rig.channels.index("jaw", "yaw")
    yaws = [standard_rig.contraction({key: 1.0})[index] for key in ("AU30", "L30", "R30")]
    assert yaws[0] == yaws[1] == -yaws[2] > 5.0
    assert "left" in standard_rig.check(Keyframe(action_units={"AU30": 1.0}))[0]
    assert standard_rig.check(Keyframe(action_units={"R30": 1.0})) == []


def test_lids_go_with_the_eyes_unless_they_are_shut(standard_rig):
    from engine.measure import LOWER_LID, UPPER_LID, settle

    units = ({"AU64": 1.0}, {"AU63": 1.0}, {"AU43": 1.0}, {"AU43": 1.0, "AU64": 1.0})
    down, up, shut, shut_down = settle(standard_rig, [Keyframe(action_units=u) for u in units])
    assert down.u(UPPER_LID)[1] < -2.5
    assert down.u(LOWER_LID)[1] < -0.5
    assert down.gap(UPPER_LID, LOWER_LID) > 2.0
    assert up.u(UPPER_LID)[1] > 1.0
    assert shut_down.displacements == pytest.approx(shut.displacements, abs=0.05)
