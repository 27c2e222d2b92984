"""The binary frame: what goes in comes out, and nothing else is accepted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from service.protocol import (
    GRID_METRES,
    MalformedFrame,
    SurfaceFrame,
    decode_frame,
    encode_frame,
)

number = st.floats(-1000, 1000, width=32)
steps = arrays(
    np.int16,
    array_shapes(min_dims=1, max_dims=1, max_side=200).map(lambda shape: (*shape, 3)),
    elements=st.integers(-32767, 32767),
    fill=st.just(0),
)
frames = st.builds(
    SurfaceFrame,
    tick=st.integers(0, 2**32 - 1),
    asleep=st.booleans(),
    jaw_quaternion=st.tuples(number, number, number, number),
    jaw_offset=st.tuples(number, number, number),
    gaze=st.tuples(number, number, number, number),
    head=st.tuples(number, number, number),
    steps=steps,
    head_thrust=number,
    tongue_thrust=number,
)


@given(frames)
@settings(deadline=None)
def test_a_frame_survives_the_wire(frame: SurfaceFrame) -> None:
    read = decode_frame(encode_frame(frame))
    np.testing.assert_array_equal(read.steps, frame.steps)
    for field in (
        "tick",
        "asleep",
        "jaw_quaternion",
        "jaw_offset",
        "gaze",
        "head",
        "head_thrust",
        "tongue_thrust",
    ):
        assert getattr(read, field) == getattr(frame, field)


@given(frames, st.data())
@settings(deadline=None)
def test_a_cut_frame_is_refused(frame: SurfaceFrame, data: st.DataObject) -> None:
    encoded = encode_frame(frame)
    cut = data.draw(st.integers(0, len(encoded) - 1))
    with pytest.raises(MalformedFrame):
        decode_frame(encoded[:cut])


@given(st.binary(max_size=300))
@settings(deadline=None)
def test_foreign_bytes_are_refused_or_read(data: bytes) -> None:
    try:
        decode_frame(data)
    except MalformedFrame:
        return


def test_the_grid_is_at_most_20_micrometres() -> None:
    assert GRID_METRES <= 20e-6
