"""What became of a tracker's file: rows, clock, units, and what the user should look at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True)
class UnitReport:
    """One unit of a track.

    Attributes:
        columns: Where it comes from.
        peak: Its highest intensity in the rows that count, as the tracker has it, 0..1.
        peak_speed: Its fastest change between two rows, intensity a second.
        neutral: What was taken off as the face at rest.
        played: Its highest intensity as it is played.
        played_speed: Its fastest change as it is played, intensity a second.
        stuck: Whether it is the same in every row, and not 0.
    """

    columns: tuple[str, ...]
    peak: float
    peak_speed: float
    neutral: float
    played: float
    played_speed: float
    stuck: bool


@dataclass(frozen=True)
class ClockReport:
    """The time of the rows.

    Attributes:
        source: What tells it.
        start: The first reading, s: it is 0 in the clip.
        step: Seconds between rows, as usual.
        repairs: What was mended, and how often.
        doubts: What is not sure of it.
    """

    source: str
    start: float
    step: float
    repairs: Mapping[str, int]
    doubts: tuple[str, ...]


@dataclass(frozen=True)
class TrackReport:
    """What became of a tracker's file; every number of rows is of the whole file.

    Attributes:
        tracker, layout: Who wrote it, and in which form.
        columns: In the header.
        rows: Below the header.
        faces: Rows of each face; empty where the file names none.
        face: The one that is played.
        used: Rows of it that count.
        dropped: Its rows that do not, by reason.
        filled: Dropped rows bridged in a straight line.
        lost: Dropped rows in longer gaps, in which the face rests.
        gaps, longest_gap: How many of these longer gaps there are, and the longest, s.
        held: Cells a little beyond their range, held to it.
        clock: How time is told.
        rate, frames, duration: Of the track, in frames a second and s.
        left_out: Seconds beyond the longest track, not played.
        units: What is played, by unit.
        ignored: Columns that are not, by reason.
        angles: Fastest turn of head and gaze that is played, degrees a second, by axis.
        gain: Factor on every intensity.
        neutral: How the face at rest was found; None took nothing off.
        smoothing: Cutoff of the filter at rest, Hz; 0 is off.
        notes: What the user should know, in sentences.
    """

    tracker: str
    layout: str
    columns: int
    rows: int
    faces: Mapping[str, int]
    face: str
    used: int
    dropped: Mapping[str, int]
    filled: int
    lost: int
    gaps: int
    longest_gap: float
    held: int
    clock: ClockReport
    rate: int
    frames: int
    duration: float
    left_out: float
    units: Mapping[str, UnitReport]
    ignored: Mapping[str, tuple[str, ...]]
    angles: Mapping[str, float]
    gain: float
    neutral: str | None
    smoothing: float
    notes: tuple[str, ...] = field(default=())

    @property
    def stuck(self) -> tuple[str, ...]:
        """The units that are the same in every row, and not 0."""
        return tuple(name for name, unit in self.units.items() if unit.stuck)

    def to_json(self) -> dict[str, Any]:
        """Return the report as plain data, numbers rounded to what they are good for."""
        data: dict[str, Any] = _plain(asdict(self))
        return {**data, "stuck": list(self.stuck)}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> TrackReport:
        """Return the report that `to_json` made plain, with the numbers that it rounded.

        Raises:
            KeyError, TypeError: If it is none.
        """
        units = {
            name: UnitReport(**{**unit, "columns": tuple(unit["columns"])})
            for name, unit in data["units"].items()
        }
        return cls(
            **{
                **{name: value for name, value in data.items() if name != "stuck"},
                "clock": ClockReport(**{**data["clock"], "doubts": tuple(data["clock"]["doubts"])}),
                "units": units,
                "ignored": {why: tuple(names) for why, names in data["ignored"].items()},
                "notes": tuple(data["notes"]),
            }
        )


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return round(value, 4) if isinstance(value, float) else value
