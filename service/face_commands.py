"""What a face does, in words and figures: from `risorius measure` to `separability`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from .terminal import console, refuse


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

    if people:
        with console.status("measuring") as status:
            everybody = measure_people(lambda name: status.update(f"measuring {name}"))
        typer.echo(json.dumps(everybody, indent=2) if as_json else people_markdown(everybody))
        return
    try:
        with console.status("measuring") as status:

            def show(stage: str) -> None:
                status.update(f"measuring {stage}")

            if flesh:
                figures = measure_flesh(builtin_rig(rig), mixes, show)
            else:
                figures = measure_rig(builtin_rig(rig), show)
    except EngineError as error:
        refuse(f"The rig cannot be measured: {error}.")
    table = flesh_markdown if flesh else markdown
    typer.echo(json.dumps(figures, indent=2, allow_nan=False) if as_json else table(figures))


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
        with console.status("settling the face") as status:
            data = analyze_facs(
                builtin_rig(rig),
                facs,
                scale=scale,
                progress=lambda share: status.update(f"settling every action unit: {share:.0%}"),
            ).to_json()
    except EngineError as error:
        refuse(f"The expression cannot be analysed: {error}.")
    typer.echo(json.dumps(data, indent=2, allow_nan=False) if as_json else analysis_markdown(data))


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
        with console.status("settling the rig's muscles") as status:
            data = invert_file(source, rig, lambda share: status.update(f"searching: {share:.0%}"))
    except InverseRefused as refused:
        refuse(str(refused))
    typer.echo(json.dumps(data, indent=2, allow_nan=False) if as_json else inverse_markdown(data))


def emotions(
    rig: Annotated[str, typer.Option(help="Rig to measure on, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print figures for machines.")] = False,
) -> None:
    """Print every emotion word and what it plays, and measure every face of theirs."""
    from engine import EngineError, builtin_rig

    from .emotion_measuring import measure_forms
    from .emotion_page import figures_markdown, words_markdown

    try:
        with console.status("measuring") as status:
            figures = measure_forms(
                builtin_rig(rig), lambda stage: status.update(f"measuring {stage}")
            )
    except EngineError as error:
        refuse(f"The emotions cannot be measured: {error}.")
    if as_json:
        typer.echo(json.dumps(figures, indent=2, allow_nan=False))
    else:
        typer.echo(f"{words_markdown()}\n{figures_markdown(figures)}")


def units(
    rig: Annotated[str, typer.Option(help="Rig to describe, or a person.")] = "standard",
) -> None:
    """Print every action unit: what is seen, its muscles and their sources, and combinations."""
    from engine import EngineError, builtin_rig

    from .repertoire import units_markdown

    try:
        typer.echo(units_markdown(builtin_rig(rig)))
    except EngineError as error:
        refuse(f"The rig cannot be described: {error}.")


def separability(
    rig: Annotated[str, typer.Option(help="Rig to measure, or a person.")] = "standard",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Measure how alike the action units look, each pair."""
    from engine import EngineError, builtin_rig
    from engine import separability as measure_separability

    from .repertoire import separability_markdown

    try:
        with console.status("measuring"):
            found = measure_separability(builtin_rig(rig))
    except EngineError as error:
        refuse(f"The rig cannot be measured: {error}.")
    if as_json:
        cosines = [[round(float(value), 4) for value in row] for row in found.cosines]
        typer.echo(json.dumps({"units": found.units, "cosines": cosines}))
    else:
        typer.echo(separability_markdown(found))
