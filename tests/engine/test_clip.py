"""Recording: the live face bit for bit, at any frame rate."""

from __future__ import annotations

import weakref
from dataclasses import replace

import numpy as np
import pytest
from recorded import FPS, TIMELINE, live_frames, standard_clip

import engine.clip
import engine.settling
from engine.clip import Cancelled, clip_of, nearest_tick, record
from engine.errors import Diverged, InvalidValue, UnknownName
from engine.frame import Frame, Pose
from engine.rig import Model, builtin_rig
from engine.settling import settled, settled_units
from engine.simulator import Simulator
from engine.timeline import Keyframe, Timeline


def test_clip_is_the_live_face_bit_for_bit() -> None:
    clip = standard_clip()
    live = live_frames(clip.rig, TIMELINE)
    assert len(clip) == FPS + 1
    for index in range(len(clip)):
        frame = live[nearest_tick(index, FPS)]
        np.testing.assert_array_equal(
            clip.displacements[index], frame.displacements.astype(np.float32)
        )
        np.testing.assert_array_equal(clip.activations[index], frame.activations.astype("f4"))
        assert clip.poses[index] == frame.pose


def test_clip_starts_at_rest_and_moves() -> None:
    clip = standard_clip()
    assert clip.poses[0] == Pose()
    assert not clip.displacements[0].any()
    assert np.abs(clip.displacements[-1]).max() > 3
    assert max(pose.jaw_pitch for pose in clip.poses) > 3
    assert clip.duration == pytest.approx(TIMELINE.duration)


@pytest.mark.parametrize("fps", [1, 7, 24, 25, 30, 40, 60])
def test_frames_show_the_nearest_tick(fps: int) -> None:
    ticks = np.array([nearest_tick(index, fps) for index in range(4 * fps)])
    assert np.abs(ticks / 60 - np.arange(4 * fps) / fps).max() <= 0.5 / 60 + 1e-12
    assert np.ptp(np.diff(ticks)) <= 1  # no stutter


@pytest.mark.parametrize("fps", [0, 61, -5])
def test_impossible_frame_rate_is_refused(fps: int) -> None:
    with pytest.raises(InvalidValue, match=str(fps)):
        record(builtin_rig("standard"), TIMELINE, fps=fps)


def test_unknown_command_is_refused() -> None:
    timeline = Timeline((Keyframe(action_units={"AU99": 1.0}),), duration=0.1)
    with pytest.raises(UnknownName, match="AU99"):
        record(builtin_rig("standard"), timeline)


def test_progress_ends_at_one_and_cancelling_stops() -> None:
    rig, shares = builtin_rig("standard"), []
    short = Timeline((), duration=0.2)
    record(rig, short, fps=20, progress=shares.append)
    assert shares == sorted(shares)
    assert len(shares) == 5
    assert shares[-1] == 1.0
    shares.clear()
    with pytest.raises(Cancelled, match="frame 2 of 5"):
        record(rig, short, fps=20, progress=shares.append, cancelled=lambda: len(shares) == 2)


def test_frames_are_kept_without_the_bank_that_they_are_seen_in(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = builtin_rig("standard")
    shown, alive = [], []
    frame_of = Simulator.frame

    def watched(self: Simulator, face: str) -> Frame:
        frame = frame_of(self, face)
        seen = frame.displacements
        shown.append(weakref.ref(seen if seen.base is None else seen.base))
        alive.append(sum(each() is not None for each in shown))
        return frame

    monkeypatch.setattr(Simulator, "frame", watched)
    short = Timeline((Keyframe(action_units={"AU12": 1.0}),), duration=0.5)
    clip = record(rig, short, fps=30, model=replace(Model.for_rig(rig), integrator="verlet"))
    assert len(alive) == len(clip) == 16
    assert max(alive) <= 2, "the last and this one"


def test_a_clip_has_a_frame() -> None:
    with pytest.raises(InvalidValue, match="0 frames"):
        clip_of(builtin_rig("standard"), 30, [])


def test_divergence_is_not_passed_on_as_a_clip(monkeypatch: pytest.MonkeyPatch) -> None:
    step = Simulator.step

    def broken(self: Simulator) -> dict[str, Frame]:
        frames = step(self)
        return {
            name: Frame(frame.tick, frame.displacements, frame.activations, frame.pose, False, True)
            for name, frame in frames.items()
        }

    monkeypatch.setattr(engine.clip.Simulator, "step", broken)
    with pytest.raises(Diverged, match=r"at 0\.02 s"):
        record(builtin_rig("standard"), TIMELINE)


def test_settled_faces_do_not_see_each_other() -> None:
    rig = builtin_rig("standard")
    smile, frown = Keyframe(action_units={"AU12": 1.0}), Keyframe(action_units={"AU4": 1.0})
    together = settled(rig, [smile, frown], seconds=0.2)
    (alone,) = settled(rig, [frown], seconds=0.2)
    np.testing.assert_array_equal(together[1].displacements, alone.displacements)
    assert np.abs(together[0].displacements - alone.displacements).max() > 0.5
    assert alone.tick == 12


def test_a_face_that_has_arrived_is_stepped_no_more() -> None:
    rig = builtin_rig("standard")
    keyframes = [Keyframe(action_units={"AU12": 1.0}), Keyframe(action_units={"AU45": 1.0})]
    shares: list[float] = []
    whole = settled(rig, keyframes, seconds=0.75)
    smile, blink = settled(rig, keyframes, seconds=0.75, still_mm=0.02, progress=shares.append)
    assert blink.tick < smile.tick < whole[0].tick
    assert shares[-1] == 1.0
    for early, late in zip((smile, blink), whole, strict=True):
        assert np.linalg.norm(early.displacements - late.displacements, axis=1).max() < 0.1


def test_settled_units_are_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = builtin_rig("standard")
    first = settled_units(rig)
    assert len(first) == len(rig.action_units)

    def never(*_: object, **__: object) -> None:
        raise AssertionError("simulated again")

    monkeypatch.setattr(engine.settling, "settled", never)
    for stored, frame in zip(settled_units(rig), first, strict=True):
        np.testing.assert_array_equal(stored.displacements, frame.displacements)
        np.testing.assert_array_equal(stored.activations, frame.activations)
        assert (stored.pose, stored.tick) == (frame.pose, frame.tick)
        assert (stored.asleep, stored.diverged) == (frame.asleep, frame.diverged)
