"""What may be asked of the reading of a tracker's file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import InvalidValue
from ..timeline import MAX_SECONDS

NEUTRAL_QUANTILE = 0.1
"""The share of a clip's frames taken to lie at or below a person's neutral face. Ours: low enough
for a clip that speaks or smiles most of the time, and no single noisy frame."""


@dataclass(frozen=True, kw_only=True)
class TrackOptions:
    """How a tracker's file is read.

    Attributes:
        fps: Rows a second, for a file without a clock that can be believed.
        gain: Factor on every intensity, after the neutral face is taken off.
        neutral: What the tracker says of the person at rest, to be taken off: None takes nothing
            off; a number is that quantile of the clip, 0.1 for each unit's lowest tenth; two are
            the first and last of the frames on which the face is neutral.
        smooth: Cutoff of the one-euro filter at rest, Hz: lower is smoother, 0 is off; None leaves
            it to the tracker: on for classifiers' scores, off for intensities.
        face: Which face of several, as the file names them; None takes the one seen most.
        min_confidence: Rows of a lower confidence are dropped.
        max_gap: Seconds without a row that are filled in a straight line, or two and a half of the
            file's usual steps if these are longer; over longer gaps the face goes to rest and comes
            back.
        head: Whether the head moves.
        gaze: Whether the eyes move.
        full_scale: What the file calls full intensity, where the header leaves it open.
        au_map: Unit by column, {"AU01_r": "AU1"}, for a file that numbers units by index.
        max_seconds: Longest track; rows beyond it are only counted.
    """

    fps: float | None = None
    gain: float = 1.0
    neutral: float | tuple[int, int] | None = None
    smooth: float | None = None
    face: str | int | None = None
    min_confidence: float = 0.5
    max_gap: float = 0.5
    head: bool = True
    gaze: bool = True
    full_scale: float | None = None
    au_map: Mapping[str, str] | None = None
    max_seconds: float = MAX_SECONDS

    def __post_init__(self) -> None:
        _within("fps", self.fps, 1.0, 1000.0)
        _within("gain", self.gain, 0.0, 100.0)
        _within("smooth", self.smooth, 0.0, 30.0)
        _within("min_confidence", self.min_confidence, 0.0, 1.0)
        _within("max_gap", self.max_gap, 0.0, 60.0)
        _within("full_scale", self.full_scale, 1e-6, 1e6)
        _within("max_seconds", self.max_seconds, 1.0 / 60.0, MAX_SECONDS)
        if isinstance(self.neutral, tuple):
            first, last = self.neutral
            if not 0 <= first <= last:
                raise InvalidValue(
                    f"neutral is the frames {first} to {last}; expected a first one of 0 or more "
                    "and a last one not before it"
                )
        else:
            _within("neutral", self.neutral, 0.0, 1.0)


def _within(name: str, value: float | None, least: float, most: float) -> None:
    if value is not None and not (math.isfinite(value) and least <= value <= most):
        raise InvalidValue(f"{name} is {value!r}; expected a number from {least:g} to {most:g}")
