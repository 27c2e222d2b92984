"""The report of a track, put together from what was counted while its file streamed by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from .clock import Clock
from .columns import grouped, shortened
from .faces import Faces
from .gate import Gate
from .layout import Layout
from .notes import notes_of
from .options import TrackOptions
from .report import ClockReport, TrackReport, UnitReport
from .signals import Signals
from .statistics import Gaps, Peaks

NOT_NEEDED = "not needed"
STUCK_SCORE = 0.95
"""A classifier's score that never leaves this is no face's. Ours."""


@dataclass(frozen=True, eq=False)
class Counted:
    """What is known of a file that was read.

    Attributes:
        header: Its columns.
        layout, options: What they mean, and how they were read.
        signals, faces, gate, gaps, peaks, clock: What read and counted its rows.
        rows: Below the header.
        end: When the last row of the face is, s.
        doubts: What was not clear at its first rows.
    """

    header: Sequence[str]
    layout: Layout
    options: TrackOptions
    signals: Signals
    faces: Faces
    gate: Gate
    gaps: Gaps
    peaks: Peaks
    clock: Clock
    rows: int
    end: float
    doubts: Sequence[str]

    def kept(self) -> list[int]:
        """Return which units are played: not a classifier's that is stuck at full."""
        hopeless = self._hopeless() if self.layout.scores else []
        return [index for index in range(len(self.signals.units)) if index not in hopeless]

    def _hopeless(self) -> list[int]:
        stuck = self.peaks.stuck
        units = range(len(self.signals.units))
        return [i for i in units if stuck[i] and self.peaks.most[i] >= STUCK_SCORE]


def summary(
    counted: Counted,
    *,
    played: FloatArray,
    angles: FloatArray,
    neutral: FloatArray,
    neutral_told: str | None,
    quiet: FloatArray,
    rate: int,
    smoothing: float,
) -> TrackReport:
    """Return the report of a track.

    Args:
        counted: What is known of its file.
        played: Intensities as they are played, shape (frames, units).
        angles: Shape (frames, axes).
        neutral: What was taken off, shape (units,).
        neutral_told: How that was found.
        quiet: Each unit's lowest tenth before anything was taken off, shape (units,).
        rate: Frames a second.
        smoothing: Cutoff of the filter at rest, Hz.
    """
    names, kept = counted.signals.units, counted.kept()
    duration = len(played) / rate
    turns = zip(counted.signals.axes, _speeds(angles, rate), strict=True)
    report = TrackReport(
        tracker=counted.layout.tracker,
        layout=counted.layout.version,
        columns=len(counted.header),
        rows=counted.rows,
        faces={} if counted.layout.face is None else dict(counted.faces.rows),
        face=counted.faces.chosen,
        used=counted.peaks.rows,
        dropped=dict(counted.gate.dropped),
        filled=counted.gaps.filled,
        lost=counted.gaps.lost,
        gaps=counted.gaps.count,
        longest_gap=counted.gaps.longest,
        held=counted.gate.held,
        clock=_clock(counted.clock),
        rate=rate,
        frames=len(played),
        duration=duration,
        left_out=max(0.0, counted.end - duration),
        units=_units(counted, kept, played, neutral, rate),
        ignored=_ignored(counted, kept),
        angles={f"{group}.{axis}": float(speed) for (group, axis), speed in turns},
        gain=counted.options.gain,
        neutral=neutral_told,
        smoothing=smoothing,
    )
    low = {names[index]: float(quiet[index]) for index in kept}
    return replace(report, notes=(*counted.doubts, *notes_of(report, counted.layout, low)))


def _clock(clock: Clock) -> ClockReport:
    repairs, doubts = dict(clock.repairs), tuple(clock.doubts)
    return ClockReport(clock.source, clock.start or 0.0, clock.step, repairs, doubts)


def _units(
    counted: Counted, kept: Sequence[int], played: FloatArray, neutral: FloatArray, rate: int
) -> dict[str, UnitReport]:
    peaks, speeds, stuck = counted.peaks, _speeds(played, rate), counted.peaks.stuck
    names = counted.signals.units
    return {
        names[index]: UnitReport(
            columns=counted.signals.columns[names[index]],
            peak=float(peaks.most[index]),
            peak_speed=float(peaks.speed[index]),
            neutral=float(neutral[index]),
            played=float(played[:, index].max()),
            played_speed=float(speeds[index]),
            stuck=stuck[index],
        )
        for index in kept
    }


def _ignored(counted: Counted, kept: Sequence[int]) -> dict[str, tuple[str, ...]]:
    """Return the columns that are not played, by reason, those of one kind together."""
    layout, signals = counted.layout, counted.signals
    used = {*layout.number_columns, *layout.text_columns}
    reasons = {name.lower(): reason for name, reason in layout.ignored.items()}
    ignored: dict[str, list[str]] = {}
    for index, key in enumerate(signals.units):
        if index not in kept:
            why = f"stuck at {counted.peaks.most[index]:g} in every row, as no face is"
            ignored.setdefault(why, []).extend(signals.columns[key])
    for name, count in grouped(each for each in counted.header if each not in used).items():
        shown = f"{name} ({count})" if count > 1 else name
        ignored.setdefault(reasons.get(name.lower(), NOT_NEEDED), []).append(shown)
    return {why: shortened(names) for why, names in ignored.items()}


def _speeds(signals: FloatArray, rate: int) -> FloatArray:
    """Return the fastest change of each signal, a second, shape (signals,)."""
    if len(signals) < 2:
        return np.zeros(signals.shape[1])
    return np.asarray(np.abs(np.diff(signals, axis=0)).max(axis=0) * rate)
