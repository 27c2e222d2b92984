"""`risorius clip`: what it may be told; `clip_commands` does it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from .terminal import refuse


def _show_schema(wanted: bool) -> None:
    if wanted:
        from .schemas import timeline_schema

        typer.echo(json.dumps(timeline_schema(), indent=2))
        raise typer.Exit


def clip(
    given: Annotated[
        list[Path],
        typer.Argument(
            metavar="IN…",
            help="Timeline, a JSON file; a tracker's CSV; a clip's own GLB, rendered again; "
            "several, folders of them, or patterns.",
        ),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", help="GLB file to write, or a folder for several.")
    ],
    rig: Annotated[str | None, typer.Option(help="Rig to play it on.")] = None,
    fps: Annotated[
        int | None,
        typer.Option(
            min=1, max=60, help="Frames a second; of a tracker's rows too, where it has no clock."
        ),
    ] = None,
    textures: Annotated[
        bool, typer.Option("--textures/--no-textures", help="Embed the maps of skin and eyes.")
    ] = True,
    form: Annotated[
        str | None,
        typer.Option(help="How files tell the motion: basis (the default), arkit or exact."),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(min=0.01, max=10, help="Largest error of any vertex with basis, mm: 0.1."),
    ] = None,
    quantize: Annotated[
        bool | None,
        typer.Option("--quantize/--no-quantize", help="Store numbers by KHR_mesh_quantization."),
    ] = None,
    sparse: Annotated[
        bool | None, typer.Option("--sparse/--no-sparse", help="Allow sparse accessors.")
    ] = None,
    level: Annotated[
        str | None, typer.Option(help="Detail of skin and hair: low, medium (the default) or high.")
    ] = None,
    csv: Annotated[
        bool,
        typer.Option(
            "--csv", help="Write its ground truth beside it, OUT.truth.csv: units, muscles, points."
        ),
    ] = False,
    png: Annotated[
        bool,
        typer.Option("--png", help="Draw twelve of its frames beside it, OUT.png, in Chromium."),
    ] = False,
    jobs: Annotated[
        int | None, typer.Option(min=1, max=256, help="Of several files, how many at a time.")
    ] = None,
    url: Annotated[
        str, typer.Option(help="Service that renders it, http://name:port; without it, here.")
    ] = "",
    key: Annotated[str, typer.Option(help="Key of that service.", envvar="RISORIUS_API_KEY")] = "",
    gain: Annotated[float, typer.Option(help="Tracker: factor on every intensity.")] = 1.0,
    face: Annotated[str | None, typer.Option(help="Tracker: which face of several.")] = None,
    neutral: Annotated[
        str,
        typer.Option(
            help="Tracker: takes off the face at rest: auto, a share of the frames such as 0.1, "
            "or the frames that show it, 0-30."
        ),
    ] = "",
    smooth: Annotated[
        float | None, typer.Option(help="Tracker: one-euro filter, Hz at rest; 0 is off.")
    ] = None,
    confidence: Annotated[
        float, typer.Option(help="Tracker: rows of a lower confidence are dropped.")
    ] = 0.5,
    max_gap: Annotated[
        float, typer.Option(help="Tracker: seconds without a row that are filled.")
    ] = 0.5,
    full_scale: Annotated[
        float | None, typer.Option(help="Tracker: what the file calls full intensity.")
    ] = None,
    au_map: Annotated[
        str,
        typer.Option(
            help="Tracker: unit by column, AU01_r:AU1,AU03_r:AU4, of a file that numbers units by "
            "index, as OpenFace 3's."
        ),
    ] = "",
    head: Annotated[bool, typer.Option("--head/--no-head", help="Tracker: move the head.")] = True,
    gaze: Annotated[bool, typer.Option("--gaze/--no-gaze", help="Tracker: move the eyes.")] = True,
    seconds: Annotated[float, typer.Option(help="Tracker: longest clip.")] = 120.0,
    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print figures, and what became of a tracker's rows, as JSON."),
    ] = False,
    _schema: Annotated[
        bool,
        typer.Option(
            "--schema",
            callback=_show_schema,
            is_eager=True,
            help="Print the JSON Schema of a timeline, and do nothing else.",
        ),
    ] = False,
) -> None:
    """Render timelines and trackers' files to animated GLB files, here or by a service."""
    from engine import EngineError, TrackOptions

    from .clip_commands import render
    from .clip_files import Wanted, how_told
    from .rendering import ClipRefused
    from .track_rendering import map_of, neutral_of

    try:
        options = TrackOptions(
            fps=fps,
            gain=gain,
            face=face,
            neutral=neutral_of(neutral),
            smooth=smooth,
            min_confidence=confidence,
            max_gap=max_gap,
            full_scale=full_scale,
            au_map=map_of(au_map),
            head=head,
            gaze=gaze,
            max_seconds=seconds,
        )
        told = how_told(form, tolerance, quantize, sparse, level)
        wanted = Wanted(rig, fps, textures, csv, png, url, key, options, told)
        render(given, output, wanted, jobs=jobs, as_json=as_json)
    except (ClipRefused, EngineError) as refused:
        refuse(str(refused))
