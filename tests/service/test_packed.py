"""Packed frames: what goes in comes out, by its base or whole, and nothing else is accepted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from engine import Frame, JawHinge, Pose, builtin_rig
from service.benching.lively import lively_frames
from service.outgoing import Outgoing
from service.packed import NoBase, decode_packed, encode_packed
from service.protocol import MalformedFrame, SurfaceFrame, decode_frame

number = st.floats(-1000, 1000, width=32)
two_surfaces = st.integers(0, 60).flatmap(
    lambda vertices: arrays(np.int16, (2, vertices, 3), elements=st.integers(-32767, 32767))
)


def frame_of(steps: np.ndarray, tick: int = 7, thrust: float = 0.0) -> SurfaceFrame:
    return SurfaceFrame(
        tick=tick,
        asleep=False,
        jaw_quaternion=(0.125, 0.0, 0.0, 1.0),
        jaw_offset=(0.5, 0.25, 0.0),
        gaze=(1.0, 2.0, 3.0, 4.0),
        head=(5.0, 6.0, 7.0),
        steps=steps,
        head_thrust=thrust,
    )


@given(two_surfaces, st.integers(1, 2**16 - 1), st.integers(0, 2**32 - 1), number)
@settings(deadline=None)
def test_a_frame_survives_the_wire_by_its_base_and_whole(
    surfaces: np.ndarray, back: int, tick: int, thrust: float
) -> None:
    base = frame_of(surfaces[0], (tick - back) % 2**32)
    frame = frame_of(surfaces[1], tick, thrust)
    for each in (base, None):
        read = decode_packed(encode_packed(frame, each), each)
        np.testing.assert_array_equal(read.steps, frame.steps)
        assert (read.tick, read.head_thrust) == (tick, thrust)
        assert (read.jaw_quaternion, read.jaw_offset) == (frame.jaw_quaternion, frame.jaw_offset)
        assert (read.gaze, read.head) == (frame.gaze, frame.head)


def test_whoever_has_another_base_is_told_and_takes_the_next_whole_frame() -> None:
    frames = [frame_of(np.full((5, 3), n, np.int16), tick=n) for n in range(4)]
    change = encode_packed(frames[3], frames[2])
    for held in (None, frames[1], frame_of(np.zeros((4, 3), np.int16), tick=2)):
        with pytest.raises(NoBase, match="needs that of 1 ticks before"):
            decode_packed(change, held)
        np.testing.assert_array_equal(decode_packed(encode_packed(frames[3]), held).steps, 3)


def test_a_base_too_long_ago_or_of_another_head_counts_as_none() -> None:
    frame = frame_of(np.ones((5, 3), np.int16), tick=2**16)
    for base in (
        frame_of(frame.steps, tick=0),
        frame_of(np.ones((4, 3), np.int16), tick=2**16 - 1),
    ):
        np.testing.assert_array_equal(decode_packed(encode_packed(frame, base)).steps, frame.steps)


def test_bytes_that_are_no_packed_frame_are_refused() -> None:
    data = encode_packed(frame_of(np.ones((5, 3), np.int16), thrust=0.5))
    for broken, match in (
        (data[:40], "at least 68"),
        (data[:70], "thrusts end at 76"),
        (data[:-1], "planes|inflated"),
        (data + b"\0", "planes"),
        (data[:1] + b"\2" + data[2:], "kind 2 version 2"),
        (b"\1" + data[1:], "kind 1"),
        (data[:64] + b"\4" + data[65:], "planes"),
        (data[:76] + b"\xff" * 40, "inflated"),
    ):
        with pytest.raises(MalformedFrame, match=match):
            decode_packed(broken)


def engine_frame(tick: int, value: float) -> Frame:
    return Frame(tick, np.full((6, 3), value), np.zeros(2), Pose(), asleep=False, diverged=False)


@pytest.fixture
def jaw() -> JawHinge:
    return builtin_rig("standard").jaw


def test_each_form_of_a_frame_is_made_once_for_all(jaw: JawHinge) -> None:
    outgoing = Outgoing()
    first, second = engine_frame(1, 0.5), engine_frame(2, 0.7)
    whole = outgoing.packed(first, jaw, None)
    assert outgoing.packed(first, jaw, None) is whole
    assert outgoing.plain(first, jaw) is outgoing.plain(first, jaw)
    change = outgoing.packed(second, jaw, 1)
    assert outgoing.packed(second, jaw, 1) is change
    read = decode_packed(change, decode_packed(whole))
    np.testing.assert_array_equal(read.steps, decode_frame(outgoing.plain(second, jaw)).steps)


def test_a_base_that_is_no_more_known_gets_a_whole_frame(jaw: JawHinge) -> None:
    outgoing = Outgoing()
    for tick in range(1, 9):
        outgoing.packed(engine_frame(tick, 0.1 * tick), jaw, None)
    now = engine_frame(9, 1.0)
    for base in (None, 1, 9, 10):
        assert decode_packed(outgoing.packed(now, jaw, base)).tick == 9
    with pytest.raises(NoBase):
        decode_packed(outgoing.packed(now, jaw, 7))


def test_of_two_frames_of_one_tick_neither_is_a_base(jaw: JawHinge) -> None:
    outgoing = Outgoing()
    for value in (0.1, 0.2):
        again = engine_frame(1, value)
        for _ in range(2):
            outgoing.packed(again, jaw, None)
    assert decode_packed(outgoing.packed(engine_frame(2, 0.3), jaw, 1)).tick == 2


def test_lively_motion_takes_a_megabit_a_second_at_most() -> None:
    frames = lively_frames(builtin_rig("standard"), 3.0)
    sizes, held = [], None
    for frame in frames:
        data = encode_packed(frame, held)
        same_steps = decode_packed(data, held)
        np.testing.assert_array_equal(same_steps.steps, frame.steps)
        sizes.append(len(data))
        held = frame
    a_second = [sum(sizes[first : first + 60]) for first in range(len(sizes) - 60)]
    assert 8 * max(a_second) < 0.7e6
    assert np.abs(frames[-1].steps).max() > 100
