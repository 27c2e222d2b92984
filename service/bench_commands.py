"""`risorius levels`, `bench`, `soak` and `startup`: what this machine does, in figures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from .terminal import console, refuse, words

_FAILED = 1


def levels(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure the head's levels of detail: triangles, bytes, and the time to make them."""
    from .levels import markdown, measure_levels

    with console.status("measuring") as status:
        figures = measure_levels(lambda stage: status.update(f"measuring: {stage}"))
    typer.echo(json.dumps(figures, indent=1) if as_json else markdown(figures))


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

    parts = words(only) or PARTS
    for part in set(parts) - set(PARTS):
        hint = did_you_mean(part, PARTS)
        refuse(f"There is no part {part!r}{hint or '; there are ' + ', '.join(PARTS)}.")
    if (quick or only) and docs is not None:
        refuse("Documents take a whole run; leave out --quick and --only, or --docs.")
    if docs is not None and not docs.is_dir():
        refuse(f"The folder {docs} does not exist; make it first.")
    try:
        with console.status("measuring") as status:
            figures = measure(
                only=parts,
                quick=quick,
                show=lambda stage: status.update(f"measuring: {stage}"),
            )
    except SoakRefused as refused:
        refuse(f"The service cannot be measured: {refused}")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        Console(highlight=False).print(terminal(figures))
    if docs is None:
        return
    try:
        write_documents(docs, figures)
    except (OSError, OtherColumns) as error:
        refuse(f"The documents cannot be written: {error}.")
    console.print(f"benchmarks.md, .svg and .csv in {escape(str(docs))}", soft_wrap=True)


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
        with console.status("starting") as status:
            figures = run_soak(minutes=minutes, share=share, url=url, show=status.update)
    except SoakRefused as refused:
        refuse(f"The soak cannot be run: {refused}")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        Console(highlight=False).print(table(figures))
    if verdict(figures):
        raise typer.Exit(_FAILED)


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
        with console.status("measuring") as status:
            figures = start_figures(
                lambda stage: status.update(f"measuring {stage}"), rounds=rounds, cold=cold
            )
    except StartFailed as failed:
        refuse(f"The service does not start: {failed}.")
    typer.echo(json.dumps(figures, indent=2) if as_json else start_markdown(figures))
