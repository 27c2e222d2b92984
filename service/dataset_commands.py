"""`risorius dataset`: labelled clips over people and expressions, by a seed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from .terminal import REFUSED, console, refuse


def dataset(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of the data set, begun or to be begun.")
    ],
    count: Annotated[int, typer.Option(min=1, max=1_000_000, help="Clips it is to have.")] = 1000,
    seed: Annotated[
        int, typer.Option(min=0, max=2**32 - 1, help="What all draws follow from.")
    ] = 1,
    jobs: Annotated[
        int | None, typer.Option(min=1, max=256, help="Clips made at a time; one a core.")
    ] = None,
    people: Annotated[
        str, typer.Option(help="Who is in it, comma separated; the twelve who come along.")
    ] = "",
    strangers: Annotated[
        int, typer.Option(min=0, max=10_000, help="People drawn by the seed besides.")
    ] = 0,
    fps: Annotated[int, typer.Option(min=1, max=60, help="Frames a second.")] = 30,
    level: Annotated[str, typer.Option(help="Detail of the skin: low, medium, high.")] = "medium",
    textures: Annotated[
        bool, typer.Option("--textures/--no-textures", help="Embed the maps of skin and eyes.")
    ] = False,
    idle: Annotated[
        bool, typer.Option("--idle/--no-idle", help="Have faces blink, look and sway, too.")
    ] = False,
) -> None:
    """Make labelled clips, GLB and ground truth, over people and expressions; go on if begun."""
    from engine import LEVELS

    from .dataset import DatasetRefused, make_dataset
    from .dataset_plan import DatasetPlan
    from .side_by_side import usual_jobs

    if level not in LEVELS:
        refuse(f"There is no level {level!r}; there are {', '.join(LEVELS)}.")
    named = tuple(name.strip() for name in people.split(",") if name.strip())
    plan = DatasetPlan(seed, named, strangers, fps, level, textures, idle)
    progress = Progress(
        TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn(), console=console
    )
    try:
        with progress:
            task = progress.add_task("starting", total=1.0)
            made, failed = make_dataset(
                output,
                plan,
                count=count,
                jobs=min(jobs or usual_jobs(), count),
                show=lambda stage, share: progress.update(task, description=stage, completed=share),
            )
    except DatasetRefused as refused:
        refuse(str(refused))
    for sentence in failed:
        console.print(escape(sentence), style="red", soft_wrap=True)
    console.print(f"{made} clips made in {escape(str(output))}", soft_wrap=True)
    if failed:
        raise typer.Exit(REFUSED)
