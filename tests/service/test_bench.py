"""The measurements: every figure is there and makes sense; none is held to a number of seconds."""

from __future__ import annotations

import json

from service.bench import measure, table


def test_every_figure_is_measured() -> None:
    figures = measure(effort=0.05)
    json.dumps(figures, allow_nan=False)
    assert {"processor", "cores", "python", "numba"} <= set(figures["machine"])
    for name in (
        "substep_milliseconds",
        "faces_per_core_60hz",
        "clip_times_real_time",
        "encode_milliseconds",
        "frame_bytes",
    ):
        assert figures[name] > 0
    batches = figures["tick_milliseconds_by_faces"]
    assert set(batches) == {"1", "4", "16"}
    assert batches["16"] > batches["1"]
    assert figures["encode_milliseconds"] < figures["tick_milliseconds"]
    assert table(figures).row_count > 8
