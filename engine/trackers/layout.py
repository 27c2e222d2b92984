"""What a header means: which columns are units, time, face, head and gaze, and in what units."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from ..arrays import FloatArray

Reader = Callable[[FloatArray], FloatArray]
SCORE_SMOOTH = 1.5
"""Cutoff at rest of the filter of scores, Hz: they flicker where a face does not. Ours."""


@dataclass(frozen=True)
class UnitColumn:
    """One column and what it moves.

    Attributes:
        column: Its name in the header.
        key: "AU12", "L12" or "T28".
        share: Intensity of the unit at the column's full scale.
    """

    column: str
    key: str
    share: float = 1.0


@dataclass(frozen=True)
class AxisColumn:
    """A column that turns the eyes by itself: degrees of an axis, "gaze.yaw", at full scale."""

    column: str
    axis: str
    degrees: float


@dataclass(frozen=True)
class Turn:
    """Columns that say how the head is turned, or where the eyes look.

    Attributes:
        columns: Their names in the header.
        read: From their values, shape (n, columns), to rotations, shape (n, 3, 3), or lines of
            sight, shape (n, 3).
        in_space: Of a gaze, whether it is where the person looks, whatever the head does.
        settle: What chooses `read` by the values of the first rows, where the header does not.
    """

    columns: tuple[str, ...]
    read: Reader
    in_space: bool = False
    settle: Callable[[FloatArray], Reader] | None = None

    def settled(self, values: FloatArray) -> Turn:
        """Return it with its reader chosen by the first rows' values, shape (n, columns)."""
        return self if self.settle is None else replace(self, read=self.settle(values))


@dataclass(frozen=True)
class TimeColumn:
    """What tells the time.

    Attributes:
        column: Its name in the header.
        kind: "seconds", "milliseconds", "timecode", or "number" for a time whose unit its own
            steps must tell.
    """

    column: str
    kind: str


@dataclass(frozen=True)
class Layout:
    """A tracker's table, understood.

    Attributes:
        tracker: "OpenFace 2".
        version: Which of its layouts this is.
        units: The columns that move units; several may move one.
        axes: The columns that move the eyes one by one.
        full: What the columns of units hold at full intensity.
        decided: Whether `full` is certain; if not, values above 1 in the first rows make it 5.
        scores: Whether the values are a classifier's scores and not intensities.
        time, frame: What tells the time, and the number of the video's frame.
        coarse_time: A column of whole seconds, "MM:SS", which tells the rate of the frames.
        face: Which face of several a row is of.
        confidence, success: How good a row is, 0..1, and whether the tracker found a face.
        head, gaze: How the head is turned and where the eyes look.
        smooth: Cutoff of the filter where none is asked for, Hz; 0 is off.
        ignored: Why columns are not used, by group of them; of others, that they are not needed.
        notes: Sentences about what was understood.
    """

    tracker: str
    version: str
    units: tuple[UnitColumn, ...]
    axes: tuple[AxisColumn, ...] = ()
    full: float = 1.0
    decided: bool = True
    scores: bool = False
    time: TimeColumn | None = None
    frame: str | None = None
    coarse_time: str | None = None
    face: str | None = None
    confidence: str | None = None
    success: str | None = None
    head: Turn | None = None
    gaze: Turn | None = None
    smooth: float = 0.0
    ignored: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def unit_columns(self) -> tuple[str, ...]:
        """The columns that are intensities, each once."""
        named = [*(each.column for each in self.units), *(each.column for each in self.axes)]
        return tuple(dict.fromkeys(named))

    @property
    def number_columns(self) -> tuple[str, ...]:
        """Every column that is read as a number, each once, units first."""
        named = [*self.unit_columns, self.frame, self.confidence, self.success]
        if self.time is not None and self.time.kind != "timecode":
            named.append(self.time.column)
        for turn in (self.head, self.gaze):
            named += [] if turn is None else turn.columns
        return tuple(dict.fromkeys(name for name in named if name is not None))

    @property
    def text_columns(self) -> tuple[str, ...]:
        """Every column that is read as text."""
        named = [self.face, self.coarse_time]
        if self.time is not None and self.time.kind == "timecode":
            named.append(self.time.column)
        return tuple(dict.fromkeys(name for name in named if name is not None))
