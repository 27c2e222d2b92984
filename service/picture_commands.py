"""`risorius sheet` and `risorius screens`: the face and the viewer in pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn

from .terminal import console, refuse, words


def sheet(
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="Picture to write; a folder takes one for each."),
    ],
    rig: Annotated[str, typer.Option(help="Rigs to show, comma separated.")] = "standard",
    people: Annotated[
        bool, typer.Option("--people", help="Show everyone who comes along.")
    ] = False,
    edit: Annotated[
        list[str] | None,
        typer.Option(
            help="Show the rigs changed as well: a body of POST /api/rigs, such as"
            """ '{"palsy": {"side": "left", "grade": "IV"}}'; may be repeated."""
        ),
    ] = None,
    columns: Annotated[int, typer.Option(min=1, max=20, help="Pictures in a row.")] = 6,
    size: Annotated[int, typer.Option(min=64, max=1024, help="Side of a picture, pixels.")] = 320,
    view: Annotated[
        str,
        typer.Option(
            help="Views, comma separated: front, three-quarter, profile, left, eye, mouth, ear,"
            " degrees."
        ),
    ] = "three-quarter",
    only: Annotated[
        str,
        typer.Option(help="Names to show, comma separated: AU12,fear,fear@0.4,rest,6C+12D."),
    ] = "",
    only_set: Annotated[
        str, typer.Option("--set", help="Show a set: emotions, intensities, combinations, recipes.")
    ] = "",
    whole: Annotated[
        bool, typer.Option("--whole", help="Show the head, not the face alone.")
    ] = False,
    cut_out: Annotated[
        bool, typer.Option("--cut-out", help="Leave out the ground: PNG, into a folder.")
    ] = False,
) -> None:
    """Draw every action unit and emotion, as the viewer shows them, on one picture."""
    from .explaining import did_you_mean
    from .sheet import Plan, SheetRefused, draw_sheet
    from .sheet_edits import EditRefused, read_edits
    from .sheet_sets import SETS

    if only_set and only_set not in SETS:
        hint = did_you_mean(only_set, list(SETS))
        refuse(f"There is no set {only_set!r}{hint or '; there are ' + ', '.join(SETS)}.")
    if cut_out and not output.is_dir():
        refuse(f"{output} is no folder; --cut-out writes a picture each into one: make it first.")
    try:
        edits = read_edits(edit or ())
    except EditRefused as refused:
        refuse(str(refused))
    plan = Plan(
        rigs=() if people else words(rig),
        views=words(view),
        only=(*SETS.get(only_set, ()), *words(only)),
        size=size,
        whole=whole,
        cut_out=cut_out,
        edits=edits,
    )
    progress = Progress(TextColumn("{task.description}"), BarColumn(), console=console)
    try:
        with progress:
            task = progress.add_task("starting", total=1.0)
            count = draw_sheet(
                output,
                plan,
                columns=columns,
                show=lambda stage, share: progress.update(task, description=stage, completed=share),
            )
    except SheetRefused as refused:
        refuse(str(refused))
    console.print(f"{count} pictures in {escape(str(output))}", soft_wrap=True)


def screens(
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder to write pictures into.")],
    only: Annotated[str, typer.Option(help="Names of pictures to take, comma separated.")] = "",
    jpeg: Annotated[bool, typer.Option("--jpeg", help="Write JPEG in place of PNG.")] = False,
) -> None:
    """Photograph the viewer: whole pages, six emotions, each view of the inside, the embed."""
    from .screens import ScreensRefused, photograph

    progress = Progress(TextColumn("{task.description}"), BarColumn(), console=console)
    try:
        with progress:
            task = progress.add_task("starting", total=1.0)
            count = photograph(
                output,
                words(only),
                jpeg=jpeg,
                show=lambda name, share: progress.update(task, description=name, completed=share),
            )
    except ScreensRefused as refused:
        refuse(str(refused))
    console.print(f"{count} pictures in {escape(str(output))}", soft_wrap=True)
