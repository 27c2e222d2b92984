"""Rendering a tracker's file to a GLB file, for the command line, with a report of it as tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.table import Table

from engine import (
    EngineError,
    Track,
    TrackOptions,
    TrackReport,
    builtin_rig,
    read_track,
    track_timeline,
)

from .bodies import ModelChoice
from .commands import live_model
from .render_process import Order
from .rendering import ClipRefused, Outcome, Show, check_folder, maps_of, written
from .tracks import read_map, read_neutral

SUFFIXES = (".csv", ".tsv", ".txt", ".jsonl", ".ndjson")
"""Of the files that trackers write."""
DEFAULT_FPS = 30
DEFAULT_RIG = "standard"
DEFAULT_LEVEL = "medium"
_MOST_NOTES = 20


def is_track(source: Path) -> bool:
    """Return whether a file is a tracker's, by its name."""
    return source.suffix.lower() in SUFFIXES


def neutral_of(text: str) -> float | tuple[int, int] | None:
    """Return what `--neutral` means, as `read_neutral` does.

    Raises:
        ClipRefused: If it means nothing.
    """
    try:
        return read_neutral(text)
    except ValueError as error:
        raise ClipRefused(f"--{error}.") from error


def map_of(text: str) -> dict[str, str] | None:
    """Return what `--au-map` means, as `read_map` does.

    Raises:
        ClipRefused: If it means nothing.
    """
    try:
        return read_map(text)
    except ValueError as error:
        raise ClipRefused(f"--{error}.".replace("au_map", "au-map", 1)) from error


def render_track_file(
    source: Path,
    output: Path,
    *,
    options: TrackOptions,
    rig: str | None,
    fps: int | None,
    show: Show,
    textured: bool = True,
    csv: Path | None = None,
    told: Mapping[str, Any] | None = None,
) -> tuple[Outcome, TrackReport]:
    """Render a tracker's file to `output`; return what became of it, and of its rows.

    Args:
        source: What a tracker wrote.
        output: GLB file to write.
        options: How it is read; `fps` says its rows' rate too, where it has no clock.
        rig: Who performs, the standard rig if None.
        fps: Frames a second of the GLB file.
        show: Told what is being done, and the share of the work done.
        textured: Whether the file embeds the maps of skin and eyes.
        csv: File for its ground truth, if wanted.
        told: How the file tells the motion, and at which level, by field of an order.

    Raises:
        ClipRefused: If the file cannot be read, played or written.
    """
    check_folder(output)
    track = _read(source, options)
    try:
        show("building the rig", 0.0)
        chosen = builtin_rig(rig or DEFAULT_RIG)
    except EngineError as error:
        raise ClipRefused(f"{source} cannot be rendered: {error}.") from error
    track = track.on(chosen)
    order = Order(
        root=rig or DEFAULT_RIG,
        steps=(),
        timeline=track_timeline(track),
        fps=fps or DEFAULT_FPS,
        model=live_model(ModelChoice(), chosen),
        start=0.0,
        textures=maps_of(chosen, show) if textured else {},
        glb=output,
        csv=csv,
        **{"level": DEFAULT_LEVEL, **(told or {})},
    )
    return written(order, source, show), track.report


def _read(source: Path, options: TrackOptions) -> Track:
    try:
        return read_track(source, options)
    except OSError as error:
        raise ClipRefused(f"{source} cannot be read: {error.strerror}.") from error
    except EngineError as error:
        raise ClipRefused(f"{source} cannot be read: {error}.") from error


def report_tables(report: TrackReport) -> Iterator[Table]:
    """Yield the report for people: the file, its units, and what to look at."""
    yield _file(report)
    yield _units(report)
    if report.notes:
        notes = Table("to look at", show_header=True)
        for note in report.notes[:_MOST_NOTES]:
            notes.add_row(escape(note))
        yield notes


def _file(report: TrackReport) -> Table:
    lines = Table(title=escape(f"{report.tracker}: {report.layout}"), title_justify="left")
    lines.add_column("file")
    lines.add_column("")
    dropped = sum(report.dropped.values())
    faces = ", ".join(f"{name} ({rows})" for name, rows in report.faces.items())
    rows = {
        "rows": f"{report.rows:,}, of which {report.used:,} count",
        "faces": faces and f"{faces}; {report.face} is played",
        "dropped": dropped and "; ".join(f"{n}: {why}" for why, n in report.dropped.items()),
        "of these": dropped and f"{report.filled} bridged, {report.lost} in {report.gaps} gaps",
        "clock": f"{report.clock.source}, from {report.clock.start:g} s",
        "repairs": "; ".join(f"{what} ({n})" for what, n in report.clock.repairs.items()),
        "played": f"{report.duration:.2f} s at {report.rate} frames a second",
        "gain, neutral": f"{report.gain:g}, {report.neutral or 'nothing taken off'}",
        "smoothing": f"{report.smoothing:g} Hz at rest" if report.smoothing else "off",
        "head and gaze": ", ".join(report.angles) or "still",
    }
    for name, value in rows.items():
        if value:
            lines.add_row(name, escape(str(value)))
    return lines


def _units(report: TrackReport) -> Table:
    lines = Table("unit", "from")
    for name in ("peak", "a second", "neutral", "played", "a second"):
        lines.add_column(name, justify="right")
    for key, unit in report.units.items():
        numbers = (unit.peak, unit.peak_speed, unit.neutral, unit.played, unit.played_speed)
        lines.add_row(
            key, escape(", ".join(unit.columns)), *(f"{number:.2f}" for number in numbers)
        )
    for why, columns in report.ignored.items():
        shown = ", ".join(columns[:6]) + (" and more" if len(columns) > 6 else "")
        lines.add_row("-", escape(f"{shown}: {why}"))
    return lines
