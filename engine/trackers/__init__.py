"""Files of face trackers, read as tracks and played as timelines (docs/trackers.md)."""

from .options import NEUTRAL_QUANTILE, TrackOptions
from .playing import track_timeline
from .reading import read_track
from .report import ClockReport, TrackReport, UnitReport
from .track import Track

__all__ = [
    "NEUTRAL_QUANTILE",
    "ClockReport",
    "Track",
    "TrackOptions",
    "TrackReport",
    "UnitReport",
    "read_track",
    "track_timeline",
]
