"""A tracker's file that is to be read, for a process that reads it apart from live faces."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from engine import Rig, Timeline, Track, TrackOptions, read_track, track_timeline

from .errors import Unprocessable

LONGEST_REPORT = 250_000
"""Characters of what is kept of a file: OpenFace's 714 columns take five thousand."""


@dataclass(frozen=True)
class TrackFile:
    """What a tracker wrote, and how it is read."""

    path: Path
    options: TrackOptions

    def told(self) -> Mapping[str, Any]:
        """Read it to its end and return its `track`: what became of its rows.

        Raises:
            EngineError, Unprocessable: If it cannot be read, or reported.
            OSError: If it is not there.
        """
        return _told(read_track(self.path, self.options))

    def performed(self, rig: Rig) -> tuple[Timeline, Mapping[str, Any]]:
        """Return what a rig plays of it, and what `told` says, of this rig.

        Raises:
            EngineError, Unprocessable: If it cannot be read, or reported.
            OSError: If it is not there.
        """
        track = read_track(self.path, self.options).on(rig)
        return track_timeline(track), _told(track)


def _told(track: Track) -> Mapping[str, Any]:
    """Return the report of a track as plain data.

    Raises:
        Unprocessable: If it would fill the database.
    """
    report = track.report.to_json()
    if len(json.dumps(report)) > LONGEST_REPORT:
        message = "the names of the file's columns and faces are too long to be reported"
        raise Unprocessable("invalid_track", message)
    return {"track": report}
