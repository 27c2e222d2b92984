"""A tracker's file becomes a track, in one pass and in memory that does not grow with its rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..arrays import BoolArray, Float32Array, FloatArray
from ..errors import InvalidTrack
from .clock import settled_clock
from .faces import Faces, chosen_face
from .gate import Gate
from .layout import Layout
from .neutral import Neutral, neutral_of, without_neutral
from .one_euro import OneEuro
from .openface import FULL
from .options import NEUTRAL_QUANTILE, TrackOptions
from .recognize import recognized
from .resample import Resampler
from .signals import Signals
from .statistics import Gaps, Peaks
from .summary import Counted, summary
from .table import Chunk, joined
from .text import text_lines
from .track import Track

SAMPLE_ROWS = 2048
"""First rows by which is settled what a header leaves open: face, clock, scale."""
SPARSE = 2.5
"""Usual steps that are no gap: of a file with a row a second, too, one may be missing. Ours."""
ROUNDING = 0.001
"""Seconds: OpenFace writes 0.033 and 0.067 for the frames of a video of 30 a second."""
RATES = (30, 60)
"""Frames a second of a track: two ticks or one lie between frames."""


def read_track(source: BinaryIO | Path, options: TrackOptions | None = None) -> Track:
    """Read a tracker's file, told apart by its header, columns found by their names.

    Rows stream through: memory is bounded by the first `SAMPLE_ROWS`, the longest track that is
    asked for and a line, whatever the file's length. Its rows beyond that track are checked and
    counted still.

    Args:
        source: An open binary file, or the path of one.
        options: How it is read.

    Raises:
        InvalidTrack: If it cannot be read; the message says what was given, what was expected and
            what to do.
        OSError: If the path cannot be opened.
    """
    options = options or TrackOptions()
    if isinstance(source, Path):
        with source.open("rb") as file:
            return _read(file, options)
    return _read(source, options)


def _read(file: BinaryIO, options: TrackOptions) -> Track:
    source, layout = recognized(text_lines(file), options)
    layout = replace(
        layout,
        head=layout.head if options.head else None,
        gaze=layout.gaze if options.gaze else None,
        axes=layout.axes if options.gaze else (),
    )
    chunks = source.chunks(layout.number_columns, layout.text_columns)
    sample, rest = _sampled(chunks)
    reading = _Reading(layout, sample, options)
    for chunk in chain([sample], rest):
        reading.take(chunk)
    return reading.track(source.header)


def _sampled(chunks: Iterator[Chunk]) -> tuple[Chunk, Iterator[Chunk]]:
    first: list[Chunk] = []
    while sum(map(len, first)) < SAMPLE_ROWS and (chunk := next(chunks, None)) is not None:
        first.append(chunk)
    if not first:
        raise InvalidTrack(
            "the file has a header and no rows below it; expected one row for each frame"
        )
    return joined(first), chunks


class _Reading:
    """The rows so far: what is settled, what is counted, and the frames that they gave."""

    def __init__(self, layout: Layout, sample: Chunk, options: TrackOptions) -> None:
        self._layout, self._options = layout, options
        self._doubts: list[str] = []
        self._gate = Gate(layout, layout.full, options.min_confidence)
        self._gate.full = self._full(sample, self._gate.good(sample))
        self._faces = Faces(layout, chosen_face(layout, sample, self._gate, options.face))
        own = Faces(layout, self._faces.chosen).own(sample)
        self._clock = settled_clock(layout, sample, own, options.fps)
        good = own & self._gate.good(sample)
        self._signals = Signals(layout, self._gate.full, sample, good)
        self.rate = track_rate(self._clock.step)
        self._smooth = layout.smooth if options.smooth is None else options.smooth
        signals = len(self._signals.resting)
        max_gap = max(options.max_gap, SPARSE * self._clock.step)
        self._resampler = Resampler(
            self.rate,
            max(1, int(options.max_seconds * self.rate + 1e-6)),
            max_gap,
            self._signals.resting,
        )
        self._filter = OneEuro(self.rate, self._smooth) if self._smooth else None
        self._gaps, self._peaks = Gaps(max_gap), Peaks(signals, max_gap)
        self._frames: list[Float32Array] = []
        self._seen: list[BoolArray] = []
        self._rows, self._own_rows, self._end = 0, 0, 0.0
        self._neutral = Neutral(options.neutral)

    def take(self, chunk: Chunk) -> None:
        """Take the next rows.

        Raises:
            InvalidTrack: For a row that counts and cannot be read.
        """
        self._rows += len(chunk)
        own = self._faces.own(chunk)
        if not own.any():
            return
        passed = self._gate.passed(chunk, own)[own]
        times, rising = self._clock.times(chunk, own)
        times = on_frames(times, self.rate)
        counts = passed & rising
        self._neutral.take(self._numbered(chunk, own, len(times)), times, counts)
        places = self._own_rows + np.cumsum(rising) - 1
        self._own_rows += int(rising.sum())
        self._end = max(self._end, float(times[-1]))
        numbers = chunk.numbers[own][counts]
        values = self._signals.of(numbers)
        self._gaps.take(places[counts], times[counts])
        self._peaks.take(times[counts], values)
        if len(values):
            self._keep(*self._resampler.frames(times[counts], values))

    def track(self, header: list[str]) -> Track:
        """Return what came of them.

        Raises:
            InvalidTrack: If no row counts.
        """
        self._faces.check()
        if self._peaks.rows == 0:
            why = "; ".join(f"in {n}, {reason}" for reason, n in self._gate.dropped.items())
            raise InvalidTrack(
                f"none of the {self._own_rows} rows of the face counts: {why}; give a recording in "
                "which the face is found, or a lower min_confidence"
            )
        self._gaps.finish(self._own_rows, self._end)
        self._keep(*self._resampler.finish(self._end))
        frames = np.concatenate(self._frames).astype(np.float64)
        seen = np.concatenate(self._seen)
        units = len(self._signals.units)
        raw, angles = frames[:, :units], frames[:, units:]
        neutral, told = self._neutral.found(raw, seen, self.rate)
        played = np.clip(self._options.gain * without_neutral(raw, neutral), 0.0, 1.0)
        counted = Counted(
            header=header,
            layout=self._layout,
            options=self._options,
            signals=self._signals,
            faces=self._faces,
            gate=self._gate,
            gaps=self._gaps,
            peaks=self._peaks,
            clock=self._clock,
            rows=self._rows,
            end=self._end,
            doubts=self._doubts,
        )
        kept = counted.kept()
        return Track(
            rate=self.rate,
            units=tuple(self._signals.units[index] for index in kept),
            intensities=np.ascontiguousarray(played[:, kept], dtype=np.float32),
            axes=self._signals.axes,
            angles=np.ascontiguousarray(angles, dtype=np.float32),
            report=summary(
                counted,
                played=played,
                angles=angles,
                neutral=neutral,
                neutral_told=told,
                quiet=neutral_of(raw, seen, NEUTRAL_QUANTILE),
                rate=self.rate,
                smoothing=self._smooth,
            ),
        )

    def _full(self, sample: Chunk, good: BoolArray) -> float:
        """Return what the file calls full, by the first rows where the header leaves it open."""
        if self._options.full_scale is not None:
            return self._options.full_scale
        if self._layout.decided:
            return self._layout.full
        places = [self._layout.number_columns.index(n) for n in self._layout.unit_columns]
        most = float(np.nanmax(sample.numbers[good][:, places], initial=0.0))
        if most > self._layout.full:
            self._doubts.append(
                f"intensities up to {most:g} were taken to be of 5, though files with these "
                "columns are divided by five; full_scale says it"
            )
            return FULL
        return self._layout.full

    def _numbered(self, chunk: Chunk, own: BoolArray, count: int) -> FloatArray:
        """Return the numbers of rows' frames: as the file has them, or as they come, from 0."""
        if self._layout.frame is None:
            return self._own_rows + np.arange(count, dtype=np.float64)
        place = self._layout.number_columns.index(self._layout.frame)
        return np.asarray(chunk.numbers[own, place])

    def _keep(self, frames: FloatArray, seen: BoolArray) -> None:
        if len(frames):
            if self._filter is not None:
                scales = self._signals.scales
                frames = self._filter.filtered(frames / scales) * scales
            self._frames.append(frames.astype(np.float32))
            self._seen.append(seen)


def track_rate(step: float) -> int:
    """Return the rate of a track, by its rows' usual step [s].

    Rows of 30 a second stand on that grid as they are, and slow ones lose nothing there; all
    others go to the grid of the ticks.
    """
    fps = 1.0 / step
    return RATES[0] if 29.5 <= fps <= 30.5 or fps <= 15.5 else RATES[1]


def on_frames(times: FloatArray, rate: int) -> FloatArray:
    """Return times [s] with those within `ROUNDING` of a frame at it."""
    frames = np.round(times * rate) / rate
    return np.where(np.abs(times - frames) <= ROUNDING, frames, times)
