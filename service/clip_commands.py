"""`risorius clip`: one file with a bar and its report, or several with a line each."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import typer
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from engine import EngineError

from .clip_files import Rendered, Wanted, files_of, outputs_of, render_many, render_one
from .rendering import ClipRefused
from .side_by_side import usual_jobs
from .terminal import REFUSED, console
from .track_rendering import report_tables


def render(
    given: Sequence[Path], output: Path, wanted: Wanted, *, jobs: int | None, as_json: bool
) -> None:
    """Render what was given, and say what became of it.

    Args:
        given: Files, folders and patterns.
        output: A GLB file, or a folder where there are several.
        wanted: How.
        jobs: Of several, how many at a time; None is one a core.
        as_json: Print what became of them as JSON.

    Raises:
        ClipRefused: If the only file cannot be rendered, or none of several is even begun.
        typer.Exit: With 2, if one of several cannot be rendered; the others are.
    """
    sources = files_of(given)
    several = len(sources) > 1 or given[0].is_dir()
    if not several and not output.is_dir():
        rendered = _with_bar(sources[0], output, wanted)
        _tell(rendered, as_json=as_json)
        console.print(escape(rendered.line), soft_wrap=True)
        return
    outputs = outputs_of(sources, output)
    if _all(sources, outputs, wanted, jobs=jobs or usual_jobs(), as_json=as_json):
        raise typer.Exit(REFUSED)


def _with_bar(source: Path, output: Path, wanted: Wanted) -> Rendered:
    with _bar() as progress:
        task = progress.add_task("reading", total=1.0)

        def show(stage: str, share: float) -> None:
            progress.update(task, description=stage, completed=share)

        try:
            return render_one(source, output, wanted, show)
        except EngineError as error:
            raise ClipRefused(str(error)) from error


def _all(
    sources: Sequence[Path], outputs: Sequence[Path], wanted: Wanted, *, jobs: int, as_json: bool
) -> int:
    """Render several files, a line for each that is done; return how many could not be."""
    failed = 0
    reports: dict[str, object] = {}
    with _bar() as progress:
        task = progress.add_task(f"{len(sources)} files", total=len(sources))
        for number, rendered in render_many(sources, outputs, wanted, jobs=min(jobs, len(sources))):
            progress.advance(task)
            if isinstance(rendered, Rendered):
                console.print(escape(rendered.line), soft_wrap=True)
                reports[str(sources[number])] = rendered.to_json()
            else:
                failed += 1
                console.print(escape(str(rendered)), style="red", soft_wrap=True)
    if as_json:
        typer.echo(json.dumps(reports, indent=2))
    return failed


def _tell(rendered: Rendered, *, as_json: bool) -> None:
    if as_json:
        typer.echo(json.dumps(rendered.to_json(), indent=2))
    elif rendered.report is not None:
        for table in report_tables(rendered.report):
            console.print(table)


def _bar() -> Progress:
    return Progress(
        TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn(), console=console
    )
