"""What a user should know of a track, in sentences: what is doubtful, and what option helps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from .layout import Layout
from .report import TrackReport

HIGH_AT_REST = 0.15
"""A unit whose lowest tenth lies above this may be a person's neutral. Ours."""
LOW_PEAK = 0.6
"""A clip in which no unit goes beyond this looks pale. Ours: most are, for trackers seldom tell
more than half."""
BRIGHT = 0.8
"""Peak that a suggested gain leads to. Ours."""
FLICKER = 15.0
"""Intensity a second that no living unit but a blink goes. Ours."""


def notes_of(report: TrackReport, layout: Layout, quiet: Mapping[str, float]) -> Iterator[str]:
    """Yield the sentences.

    Args:
        report: Of the track.
        layout: Of its file.
        quiet: Each unit's intensity in the lowest tenth of the frames.
    """
    yield from layout.notes
    yield from report.clock.doubts
    yield from (f"the clock {what} ({count} times)" for what, count in report.clock.repairs.items())
    yield from _about_faces(report)
    yield from _about_rows(report)
    stuck = report.stuck
    if stuck:
        yield f"{', '.join(stuck)}: the same in every row, and played as such"
    yield from _about_units(report, quiet)
    if layout.scores:
        yield (
            "the file has a classifier's scores, not intensities: a high one says that a unit is "
            "there, not how strong it is"
        )


def _about_faces(report: TrackReport) -> Iterator[str]:
    own = report.faces.get(report.face, 0)
    most = max(report.faces, key=lambda name: report.faces[name], default=report.face)
    if len(report.faces) > 1:
        yield f"of {len(report.faces)} faces, {report.face!r} is played"
    if report.faces.get(most, 0) > own:
        yield f"face {most!r} has more rows: face={most} plays it"


def _about_rows(report: TrackReport) -> Iterator[str]:
    if report.gaps:
        yield (
            f"{report.gaps} gaps of up to {report.longest_gap:.3g} s have no face: it rests in them"
        )
    if report.left_out > 1.0:
        yield (
            f"{report.left_out:.0f} s of it lie beyond the longest clip and are not played; ask "
            "for a longer one, or cut the file"
        )
    if report.held:
        yield f"{report.held} values a little beyond their range were held to it"


def _about_units(report: TrackReport, quiet: Mapping[str, float]) -> Iterator[str]:
    if report.neutral is None:
        high = [f"{name} {low:.2f}" for name, low in quiet.items() if low > HIGH_AT_REST]
        if high:
            yield (
                f"even in the lowest tenth of the frames there is {', '.join(high)}: if the face "
                "was neutral then, neutral=0.1 takes it off"
            )
    peak = max((unit.played for unit in report.units.values()), default=0.0)
    if report.gain == 1.0 and 0.0 < peak < LOW_PEAK:
        gain = f"gain={BRIGHT / peak:.1f}"
        yield f"no unit goes beyond {peak:.2f}; {gain} makes the strongest {BRIGHT:g}"
    fast = [name for name, unit in report.units.items() if unit.played_speed > FLICKER]
    fast = [name for name in fast if not name.endswith("45")]
    if fast and not report.smoothing:
        yield f"{', '.join(fast)} flicker, faster than a face goes; smooth=1.5 calms them"
