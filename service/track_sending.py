"""Having a service render a tracker's file, for the command line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from engine import TrackOptions, TrackReport

from .rendering import ClipRefused, Outcome, Show, check_folder
from .tracks import map_text


def render_track_by_service(
    source: Path,
    output: Path,
    *,
    url: str,
    key: str,
    options: TrackOptions,
    rig: str | None,
    fps: int | None,
    show: Show,
    textured: bool = True,
    told: Mapping[str, Any] | None = None,
) -> tuple[Outcome, TrackReport]:
    """Have a running service render `source`, save its file, and return what it says of it.

    Args:
        source: What a tracker wrote.
        output: GLB file to write.
        url: Where the service is.
        key: One of its keys, if it has any.
        options: How the file is read.
        rig: Who performs, the standard rig if None.
        fps: Frames a second of the GLB file.
        show: Told what is being done, and the share of the work done.
        textured: Whether the file embeds the maps of skin and eyes.
        told: How the file tells the motion, and at which level.

    Returns:
        One line about the file with its figures, and what became of its rows.

    Raises:
        ClipRefused: If the file cannot be read, played or written, or there is no such service.
    """
    from .client import Client, ServiceError

    check_folder(output)
    try:
        with Client(url, key=key) as client:
            show(f"rendering at {url}", 0.0)
            report = client.save_track(
                source,
                output,
                show=lambda share: show(f"rendering at {url}", share),
                rig=rig,
                fps=fps,
                textures=textured,
                gain=options.gain,
                face=options.face,
                neutral=_neutral(options),
                smooth=options.smooth,
                confidence=options.min_confidence,
                max_gap=options.max_gap,
                full_scale=options.full_scale,
                au_map=None if options.au_map is None else map_text(options.au_map),
                head=options.head,
                gaze=options.gaze,
                seconds=options.max_seconds,
                **(told or {}),
            )
    except ServiceError as error:
        raise ClipRefused(f"{source} cannot be rendered: {error}.") from error
    except OSError as error:
        file = error.filename or output
        raise ClipRefused(f"{file} cannot be read or written: {error.strerror}.") from error
    line = (
        f"{output}: {report['frames']} frames, {report['duration']:g} s, "
        f"{report['bytes'] / 1e6:.1f} MB, by {url}"
    )
    figures = {name: value for name, value in report.items() if name != "track"}
    return Outcome(line, figures), TrackReport.from_json(report["track"])


def _neutral(options: TrackOptions) -> str | None:
    """Return the neutral face as an address says it."""
    if isinstance(options.neutral, tuple):
        return "{}-{}".format(*options.neutral)
    return None if options.neutral is None else f"{options.neutral:g}"
