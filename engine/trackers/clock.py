"""When each row was: the file's clock where it can be believed, else its frames at a rate."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..errors import InvalidTrack
from .layout import Layout
from .table import Chunk

DEFAULT_FPS = 30.0
"""Rows a second where nothing tells: most cameras'."""
FASTEST, SLOWEST = 1.0 / 480.0, 2.0
"""Seconds between rows that a tracker of faces may have. Ours: the fastest phones' video, and the
slowest that is still a motion."""
_USUAL = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 120.0)
_APP_FPS = 60.0
"""Live Link Face's, where the timecodes do not tell."""
_TIMECODE = re.compile(r"(\d{1,3}):(\d{1,2}):(\d{1,2})[:;](\d{1,3})(?:\.(\d{1,9}))?")
_MINUTES = re.compile(r"(?:(\d{1,3}):)?(\d{1,3}):(\d{1,2})(?:\.\d+)?")
_UNITS = {"seconds": 1.0, "milliseconds": 1e-3, "microseconds": 1e-6}


@dataclass
class Clock:
    """Tells the time of rows, one chunk after another.

    Attributes:
        source: What it goes by, a sentence's end.
        column: Where its readings stand among a chunk's numbers; None counts rows.
        scale: Seconds of one step of these readings.
        timecode: The column of timecodes that it goes by instead, and their frames a second.
        step: Seconds between rows, as is usual in this file.
        repairs: What was mended, counted.
        doubts: What the user should know.
    """

    source: str
    column: int | None
    scale: float
    step: float
    timecode: tuple[str, float] | None = None
    repairs: dict[str, int] = field(default_factory=dict)
    doubts: list[str] = field(default_factory=list)
    start: float | None = None
    _offset: float = 0.0
    _last: float = -np.inf
    _rows: int = 0

    def times(self, chunk: Chunk, rows: BoolArray) -> tuple[FloatArray, BoolArray]:
        """Return the seconds of some rows since the first, and which of them come after the last.

        Args:
            chunk: Rows of a file.
            rows: Which of them are of the face, shape (rows,).

        Raises:
            InvalidTrack: For a row whose time is missing.
        """
        raw = self._raw(chunk, rows)
        if len(raw) == 0:
            return raw, np.zeros(0, dtype=bool)
        if self.start is None:
            self.start = float(raw[0])
        times = raw - self.start + self._offset
        if times[0] > self._last and (np.diff(times) > 0.0).all():
            self._last = float(times[-1])
            return times, np.ones(len(times), dtype=bool)
        return self._mended(times)

    def _mended(self, times: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return times that rise: a clock that jumps back goes on, one that stands is left out."""
        keep = np.ones(len(times), dtype=bool)
        shift = 0.0
        for index, time in enumerate(times):
            now = time + shift
            if now < self._last - 1e-9:
                shift += self._last + self.step - now
                now = self._last + self.step
                self._count("jumped back and was continued")
            elif now <= self._last:
                keep[index] = False
                self._count("stood still; rows of the same moment were left out")
            times[index] = now
            self._last = max(self._last, float(now))
        self._offset += shift
        return times, keep

    def _count(self, what: str) -> None:
        self.repairs[what] = self.repairs.get(what, 0) + 1

    def _raw(self, chunk: Chunk, rows: BoolArray) -> FloatArray:
        if self.timecode is not None:
            column, fps = self.timecode
            words = [w for w, own in zip(chunk.texts[column], rows, strict=True) if own]
            return timecode_seconds(words, fps, chunk.first)
        if self.column is None:
            count = int(rows.sum())
            self._rows += count
            return np.arange(self._rows - count, self._rows, dtype=np.float64) * self.scale
        raw = _readings(chunk, rows, self.column)
        return np.asarray(raw * self.scale)


def settled_clock(layout: Layout, sample: Chunk, rows: BoolArray, fps: float | None) -> Clock:
    """Return the clock of a file, by its first rows.

    Args:
        layout: What the columns mean.
        sample: The first rows.
        rows: Which of them are of the face.
        fps: Rows a second, where the file does not tell or tells nonsense.
    """
    names = layout.number_columns
    if layout.time is not None and layout.time.kind == "timecode":
        rate = fps or _timecode_rate(sample.texts[layout.time.column])
        column = layout.time.column
        return Clock("timecodes", None, 1.0, 1.0 / rate, timecode=(column, rate))
    doubts = []
    place: int | None
    if layout.time is not None:
        place = names.index(layout.time.column)
        step = _usual_step(_readings(sample, rows, place))
        unit = _unit(step, layout.time.kind)
        if unit is not None:
            clock = Clock("timestamps", place, _UNITS[unit], step * _UNITS[unit])
            if unit != layout.time.kind and layout.time.kind != "number":
                clock.doubts.append(f"its timestamps were taken for {unit}")
            return clock
        doubts.append(f"steps of {step:g} in the timestamps are no rate of a camera")
    rate, told = _rate(layout, sample, rows, fps)
    if not told:
        doubts.append(f"nothing tells the rate: {rate:g} rows a second were assumed; give fps")
    step = 1.0
    place = None
    if layout.frame is not None:
        place = names.index(layout.frame)
        step = _usual_step(_readings(sample, rows, place))
        if not 0.0 < step < 1e4:
            place, step = None, 1.0
    source = "frame numbers" if place is not None else "the order of the rows"
    return Clock(f"{source} at {rate:g} a second", place, 1.0 / rate, step / rate, doubts=doubts)


def timecode_seconds(words: Sequence[str], fps: float, first: int = 1) -> FloatArray:
    """Return the seconds of timecodes "HH:MM:SS:FF.sub", shape (n,).

    Raises:
        InvalidTrack: For one that is none.
    """
    seconds = np.empty(len(words))
    for index, word in enumerate(words):
        match = _TIMECODE.fullmatch(word)
        if match is None:
            raise InvalidTrack(
                f"row {first + index}: the timecode is {word[:24]!r}; expected such as "
                "'17:03:21:58.482'"
            )
        hours, minutes, secs, frames, part = match.groups()
        whole = int(frames) + (float(f"0.{part}") if part else 0.0)
        seconds[index] = 3600 * int(hours) + 60 * int(minutes) + int(secs) + whole / fps
    return seconds


def _readings(chunk: Chunk, rows: BoolArray, column: int) -> FloatArray:
    """Return what a clock's column reads in some rows.

    Raises:
        InvalidTrack: For a row in which it is no moment.
    """
    raw = chunk.numbers[rows, column]
    bad = ~(np.abs(raw) < 1e15)
    if bad.any():
        row = chunk.first + int(np.flatnonzero(rows)[int(np.argmax(bad))])
        raise InvalidTrack(
            f"row {row}: its time or frame is {raw[bad][0]}; expected a number of seconds or a "
            "frame's number in every row"
        )
    return np.asarray(raw)


def _usual_step(readings: FloatArray) -> float:
    """Return the median of a clock's steps forward; 1 of a single reading, 0 of one that stands."""
    steps = np.diff(readings)
    steps = steps[steps > 0.0]
    if len(steps):
        return float(np.median(steps))
    return 0.0 if len(readings) > 1 else 1.0


def _unit(step: float, kind: str) -> str | None:
    """Return the unit in which a step is one between a camera's frames."""
    told = [kind] if kind in _UNITS else []
    for unit in dict.fromkeys([*told, "seconds", "milliseconds", "microseconds"]):
        least = FASTEST if unit in told or not told else 1.0 / 240.0
        most = SLOWEST if unit in told else 0.5
        if least <= step * _UNITS[unit] <= most:
            return unit
    return None


def _rate(layout: Layout, sample: Chunk, rows: BoolArray, fps: float | None) -> tuple[float, bool]:
    """Return frames a second, and whether anything tells them."""
    if fps is not None:
        return fps, True
    if layout.coarse_time is not None and layout.frame is not None:
        frames = sample.numbers[rows, layout.number_columns.index(layout.frame)]
        words = [w for w, own in zip(sample.texts[layout.coarse_time], rows, strict=True) if own]
        told = _coarse_rate(frames, words)
        if told is not None:
            return told, True
    return DEFAULT_FPS, False


def _coarse_rate(frames: FloatArray, words: Sequence[str]) -> float | None:
    """Return the rate of frames whose times are told in whole seconds, None where they do not."""
    matches = [_MINUTES.fullmatch(word) for word in words]
    if not matches or None in matches:
        return None
    parts = [[int(part or 0) for part in match.groups()] for match in matches if match]
    seconds = np.array([3600 * h + 60 * m + s for h, m, s in parts], dtype=float)
    turns = np.flatnonzero(np.diff(seconds) > 0.0) + 1
    if len(turns) < 2:
        return None
    first, last = turns[0], turns[-1]
    rate = (frames[last] - frames[first]) / (seconds[last] - seconds[first])
    nearest = min(_USUAL, key=lambda each: abs(each - rate))
    if abs(nearest - rate) < 0.05 * nearest:
        return nearest
    return float(rate) if 1.0 <= rate <= 480.0 else None


def _timecode_rate(words: Sequence[str]) -> float:
    """Return the frames a second of timecodes, told where they run over a second's end."""
    matches = [match for word in words if (match := _TIMECODE.fullmatch(word))]
    if len({match[3] for match in matches}) < 2:
        return _APP_FPS
    most = max(int(match[4]) for match in matches)
    return next((rate for rate in _USUAL if rate > most), _APP_FPS)
