"""The report of a track goes out as JSON and comes back as it was."""

from __future__ import annotations

import json

from tracker_files import openface, read

from engine import TrackReport
from engine.trackers.statistics import LEAST_ROWS


def test_a_report_comes_back_as_it_was() -> None:
    smile = [0.05 * row for row in range(LEAST_ROWS)]
    file = openface({"AU12_r": smile, "AU04_r": [1.0] * LEAST_ROWS}, LEAST_ROWS)
    told = read(file).report.to_json()
    assert told["stuck"] == ["AU4"]
    again = TrackReport.from_json(json.loads(json.dumps(told)))
    assert again.to_json() == told
    assert again.clock.doubts == tuple(told["clock"]["doubts"])
    assert again.units["AU12"].columns == ("AU12_r",)
