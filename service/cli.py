"""The command line: from `serve` to `warm`.

Every command ends with 0, or with 2 and one clear sentence; `soak` with 1 where a figure is bad.
"""

from __future__ import annotations

import asyncio
import errno
import gc
import json
import os
import sys
from pathlib import Path
from typing import Annotated, Any

import structlog
import typer
from rich.console import Console
from rich.markup import escape

from . import dataset_commands, key_commands, picture_commands
from .terminal import console as _console
from .terminal import refuse as _refuse
from .terminal import words as _words
from .version import version

app = typer.Typer(
    help="A physically simulated face, driven by FACS.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.add_typer(key_commands.app, name="keys")
_FAILED = 1


def main() -> None:
    """Run the command line."""
    _log_to_stderr()
    app()


def _log_to_stderr() -> None:
    """Keep the log apart from answers, with short tracebacks: the arrays of a rig fill books."""
    structlog.configure(
        processors=[
            structlog.processors.add_log_level,
            structlog.processors.TimeStamper(fmt="%Y-%m-%d %H:%M:%S"),
            structlog.dev.ConsoleRenderer(
                colors=False, exception_formatter=structlog.dev.plain_traceback
            ),
        ],
        logger_factory=structlog.PrintLoggerFactory(sys.stderr),
    )


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"risorius {version()}")
        raise typer.Exit


@app.callback()
def _options(
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """A physically simulated face, driven by FACS."""


@app.command()
def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 takes a free one.")] = None,
    workers: Annotated[int, typer.Option(help="Only 1: sessions live in the process.")] = 1,
) -> None:
    """Serve the viewer, the API and the stream."""
    # Nothing that imports make is garbage: looking for it takes a tenth of their time.
    gc.disable()
    try:
        from pydantic import ValidationError

        from .explaining import explain
        from .keys import first_key, is_loopback
        from .serving import serve_until_stopped
        from .settings import Settings
        from .store import Store, StoreUnavailable
    finally:
        gc.enable()

    if max(workers, _asked_workers()) > 1:
        _refuse(
            "risorius runs as one process, because sessions live in it; start it with one worker."
        )
    asked: dict[str, Any] = {"host": host, "port": port}
    try:
        settings = Settings(**{name: value for name, value in asked.items() if value is not None})
    except ValidationError as error:
        _refuse(f"A setting is not valid: {explain(list(error.errors()))}.")
    try:
        # Opened once beforehand: a server that fails while it starts answers with a traceback.
        store = Store(settings.database)
    except StoreUnavailable as unavailable:
        _refuse(str(unavailable))
    key = first_key(store, settings)
    has_key = bool(settings.api_keys or store.keys())
    store.close()
    if key is not None:
        _console.print(f"The key of this service, shown this once: {key}", soft_wrap=True)
    if not has_key and not is_loopback(settings.host):
        _refuse(
            f"Without a key risorius listens on this machine only, and {settings.host} is reached "
            "from others: make one with `risorius keys add NAME`, or set RISORIUS_API_KEYS."
        )
    try:
        asyncio.run(serve_until_stopped(settings, _console))
    except KeyboardInterrupt:
        _console.print("stopped")
    except OSError as error:
        if error.errno not in (errno.EADDRINUSE, errno.EADDRNOTAVAIL, errno.EACCES, -2, -5):
            raise
        reason = "is in use" if error.errno == errno.EADDRINUSE else "cannot be used"
        _refuse(
            f"Port {settings.port} on {settings.host} {reason}; choose another one with --port."
        )


def _show_schema(wanted: bool) -> None:
    if wanted:
        from .schemas import timeline_schema

        typer.echo(json.dumps(timeline_schema(), indent=2))
        raise typer.Exit


@app.command()
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
        _refuse(str(refused))


app.command()(dataset_commands.dataset)
app.command()(picture_commands.sheet)
app.command()(picture_commands.screens)


@app.command()
def levels(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure the head's levels of detail: triangles, bytes, and the time to make them."""
    from .levels import markdown, measure_levels

    with _console.status("measuring") as status:
        figures = measure_levels(lambda stage: status.update(f"measuring: {stage}"))
    typer.echo(json.dumps(figures, indent=1) if as_json else markdown(figures))


@app.command()
def bench(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help="Measure shortly and roughly, in under a minute.")
    ] = False,
    only: Annotated[
        str, typer.Option(help="Parts to measure, comma separated, such as emotion_to_frame.")
    ] = "",
    docs: Annotated[
        Path | None,
        typer.Option(help="Folder to write the page, its picture and a row of figures into."),
    ] = None,
) -> None:
    """Measure the simulation beside its peers, the clips and the stream on this machine."""
    from .benching import PARTS, measure
    from .benching.documents import write_documents
    from .benching.ledger import OtherColumns
    from .benching.report import terminal
    from .explaining import did_you_mean
    from .soak_client import SoakRefused

    parts = _words(only) or PARTS
    for part in set(parts) - set(PARTS):
        hint = did_you_mean(part, PARTS)
        _refuse(f"There is no part {part!r}{hint or '; there are ' + ', '.join(PARTS)}.")
    if (quick or only) and docs is not None:
        _refuse("Documents take a whole run; leave out --quick and --only, or --docs.")
    if docs is not None and not docs.is_dir():
        _refuse(f"The folder {docs} does not exist; make it first.")
    try:
        with _console.status("measuring") as status:
            figures = measure(
                only=parts,
                quick=quick,
                show=lambda stage: status.update(f"measuring: {stage}"),
            )
    except SoakRefused as refused:
        _refuse(f"The service cannot be measured: {refused}")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        Console(highlight=False).print(terminal(figures))
    if docs is None:
        return
    try:
        write_documents(docs, figures)
    except (OSError, OtherColumns) as error:
        _refuse(f"The documents cannot be written: {error}.")
    _console.print(f"benchmarks.md, .svg and .csv in {escape(str(docs))}", soft_wrap=True)


@app.command()
def soak(
    minutes: Annotated[float, typer.Option(min=0.05, help="How long.")] = 5.0,
    share: Annotated[
        float, typer.Option(min=0.01, max=2.0, help="Of the measured capacity, kept moving.")
    ] = 0.8,
    url: Annotated[
        str | None, typer.Option(help="A running service that nobody else uses; starts one if not.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Load the service for some minutes; end with 1 if ticks are late or memory grows."""
    from .soak import soak as run_soak
    from .soak import table, verdict
    from .soak_client import SoakRefused

    try:
        with _console.status("starting") as status:
            figures = run_soak(minutes=minutes, share=share, url=url, show=status.update)
    except SoakRefused as refused:
        _refuse(f"The soak cannot be run: {refused}")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        Console(highlight=False).print(table(figures))
    if verdict(figures):
        raise typer.Exit(_FAILED)


@app.command()
def measure(
    rig: Annotated[str, typer.Option(help="Rig to measure, or a person.")] = "standard",
    people: Annotated[
        bool, typer.Option("--people", help="Measure the action units on everybody instead.")
    ] = False,
    flesh: Annotated[
        bool, typer.Option("--flesh", help="Measure elements, volume and pasts instead.")
    ] = False,
    mixes: Annotated[int, typer.Option(min=1, help="Random mixes for --flesh.")] = 500,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure the action units against human motion, and how well the tissue behaves."""
    from engine import EngineError, builtin_rig

    from .flesh import flesh_markdown, measure_flesh
    from .measuring import markdown, measure_people, measure_rig, people_markdown

    if flesh:
        with _console.status("measuring") as status:
            found = measure_flesh(
                builtin_rig(rig), mixes, lambda stage: status.update(f"measuring {stage}")
            )
        typer.echo(json.dumps(found, indent=2) if as_json else flesh_markdown(found))
        return

    if people:
        with _console.status("measuring") as status:
            everybody = measure_people(lambda name: status.update(f"measuring {name}"))
        typer.echo(json.dumps(everybody, indent=2) if as_json else people_markdown(everybody))
        return
    try:
        with _console.status("measuring") as status:
            figures = measure_rig(
                builtin_rig(rig), lambda stage: status.update(f"measuring {stage}")
            )
    except EngineError as error:
        _refuse(f"The rig cannot be measured: {error}.")
    typer.echo(json.dumps(figures, indent=2, allow_nan=False) if as_json else markdown(figures))


@app.command()
def analyze(
    facs: Annotated[str, typer.Option(help="Expression to look into, such as 12C+15C.")],
    scale: Annotated[
        str, typer.Option(help="How its letters are read: linear or banded.")
    ] = "linear",
    rig: Annotated[str, typer.Option(help="Rig to put it on, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Look into an expression: forces, strain, energy, and the action units that it shows."""
    from engine import EngineError, analyze_facs, builtin_rig

    from .analyzing import analysis_markdown

    try:
        with _console.status("settling the face") as status:
            data = analyze_facs(
                builtin_rig(rig),
                facs,
                scale=scale,
                progress=lambda share: status.update(f"settling every action unit: {share:.0%}"),
            ).to_json()
    except EngineError as error:
        _refuse(f"The expression cannot be analysed: {error}.")
    typer.echo(json.dumps(data, indent=2, allow_nan=False) if as_json else analysis_markdown(data))


@app.command()
def inverse(
    source: Annotated[
        Path,
        typer.Argument(metavar="TARGETS", help="Targets, a JSON file as POST …/inverse takes."),
    ],
    rig: Annotated[str, typer.Option(help="Rig to search on, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Find the muscles and the jaw that bring landmarks where they are wanted."""
    from .inverting import InverseRefused, inverse_markdown, invert_file

    try:
        with _console.status("settling the rig's muscles") as status:
            data = invert_file(source, rig, lambda share: status.update(f"searching: {share:.0%}"))
    except InverseRefused as refused:
        _refuse(str(refused))
    typer.echo(json.dumps(data, indent=2, allow_nan=False) if as_json else inverse_markdown(data))


@app.command()
def emotions(
    rig: Annotated[str, typer.Option(help="Rig to measure on, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print figures for machines.")] = False,
) -> None:
    """Print every emotion word and what it plays, and measure every face of theirs."""
    from engine import EngineError, builtin_rig

    from .emotion_measuring import measure_forms
    from .emotion_page import figures_markdown, words_markdown

    try:
        with _console.status("measuring") as status:
            figures = measure_forms(
                builtin_rig(rig), lambda stage: status.update(f"measuring {stage}")
            )
    except EngineError as error:
        _refuse(f"The emotions cannot be measured: {error}.")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        typer.echo(f"{words_markdown()}\n{figures_markdown(figures)}")


@app.command()
def units(
    rig: Annotated[str, typer.Option(help="Rig to describe, or a person.")] = "standard",
) -> None:
    """Print every action unit: what is seen, its muscles and their sources, and combinations."""
    from engine import EngineError, builtin_rig

    from .repertoire import units_markdown

    try:
        typer.echo(units_markdown(builtin_rig(rig)))
    except EngineError as error:
        _refuse(f"The rig cannot be described: {error}.")


@app.command()
def separability(
    rig: Annotated[str, typer.Option(help="Rig to measure, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure how alike the action units look, each pair."""
    from engine import EngineError, builtin_rig
    from engine import separability as measure_separability

    from .repertoire import separability_markdown

    try:
        with _console.status("measuring"):
            found = measure_separability(builtin_rig(rig))
    except EngineError as error:
        _refuse(f"The rig cannot be measured: {error}.")
    if as_json:
        cosines = [[round(float(value), 4) for value in row] for row in found.cosines]
        typer.echo(json.dumps({"units": found.units, "cosines": cosines}))
    else:
        typer.echo(separability_markdown(found))


@app.command()
def startup(
    rounds: Annotated[int, typer.Option(min=1, help="How often each is started.")] = 3,
    cold: Annotated[
        bool, typer.Option("--cold/--no-cold", help="Start once with empty caches, too.")
    ] = True,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure what a start costs, seconds and memory, against importing the libraries alone."""
    from .starting import StartFailed, start_figures, start_markdown

    try:
        with _console.status("measuring") as status:
            figures = start_figures(
                lambda stage: status.update(f"measuring {stage}"), rounds=rounds, cold=cold
            )
    except StartFailed as failed:
        _refuse(f"The service does not start: {failed}.")
    typer.echo(json.dumps(figures, indent=2) if as_json else start_markdown(figures))


@app.command()
def warm() -> None:
    """Compile the kernels and build the rigs into the cache, so that the next start is quick."""
    from engine import (
        BUILTIN_RIGS,
        Keyframe,
        Simulator,
        builtin_rig,
        surface_to_glb,
        textures_of,
        warm_kernels,
    )

    with _console.status("compiling the kernels of live faces"):
        warm_kernels()
    for name in BUILTIN_RIGS:
        with _console.status(f"warming the {name} rig"):
            rig = builtin_rig(name)
            simulator = Simulator(rig)
            simulator.add("face")
            simulator.apply("face", Keyframe(action_units={"AU12": 1.0}))
            simulator.step()
            surface_to_glb(rig)
            textures_of(rig)
    _console.print("The kernels are compiled and the rigs are built.")


def _asked_workers() -> int:
    """Return the number of workers that the environment asks servers for."""
    asked = os.environ.get("WEB_CONCURRENCY", "1")
    return int(asked) if asked.isdecimal() else 1
