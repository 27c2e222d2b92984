"""`risorius keys`: make, list and take away keys, beside a running service or before it starts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Annotated

import typer

from .tables import markdown_table
from .terminal import console, refuse

if TYPE_CHECKING:
    from .store import Store

app = typer.Typer(help="Make, list and take away the keys of the service.", no_args_is_help=True)
_QUOTA = ("sessions", "viewers", "clip_seconds", "upload_bytes")
Name = Annotated[str, typer.Argument(help="Whose key it is: letters, digits, '.', '_', '-'.")]


@app.command()
def add(
    name: Name,
    sessions: Annotated[int | None, typer.Option(min=1, help="Most sessions open at once.")] = None,
    viewers: Annotated[int | None, typer.Option(min=1, help="Most sockets open at once.")] = None,
    clip_seconds: Annotated[
        float | None, typer.Option(min=1, help="Most seconds of clips in an hour.")
    ] = None,
    upload_bytes: Annotated[
        int | None, typer.Option(min=1, help="Most bytes of bodies in an hour.")
    ] = None,
) -> None:
    """Make a key and print it, this once: only its hash is kept."""
    from .keys import KeyRefused, add_key

    quota = {
        "sessions": sessions,
        "viewers": viewers,
        "clip_seconds": clip_seconds,
        "upload_bytes": upload_bytes,
    }
    with _store() as store:
        try:
            key = add_key(store, name, quota)
        except KeyRefused as refused:
            refuse(f"{refused}.")
    typer.echo(key)
    console.print(
        "Keep it: it is shown this once. A running service takes it within seconds; from its first "
        "key on, every call needs one.",
        soft_wrap=True,
    )


@app.command(name="list")
def list_(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """List the keys, by name; the keys themselves are not known to anybody."""
    with _store() as store:
        rows = store.keys()
    if as_json:
        columns = ("name", "id", "created", *_QUOTA)
        found = [{column: getattr(row, column) for column in columns} for row in rows]
        typer.echo(json.dumps({"keys": found}, indent=2))
        return
    head = ("name", "begins with", "made", *(column.replace("_", " ") for column in _QUOTA))
    lines = [
        (
            row.name,
            f"rsr_{row.id}_",
            datetime.fromtimestamp(row.created, UTC).strftime("%Y-%m-%d %H:%M UTC"),
            *("usual" if getattr(row, c) is None else f"{getattr(row, c):g}" for c in _QUOTA),
        )
        for row in rows
    ]
    typer.echo("\n".join(markdown_table(head, lines)) if lines else "There are no keys.")


@app.command()
def remove(name: Name) -> None:
    """Take a key away; a running service turns it away within seconds."""
    from .keys import KeyRefused, remove_key

    with _store() as store:
        try:
            remove_key(store, name)
        except KeyRefused as refused:
            refuse(f"{refused}.")
    console.print(
        f"The key {name} is gone. What it made stays for the next key of that name.",
        markup=False,
        soft_wrap=True,
    )


@contextmanager
def _store() -> Iterator[Store]:
    """Open the database that the service of this environment uses."""
    from pydantic import ValidationError

    from .explaining import explain
    from .settings import Settings
    from .store import Store, StoreUnavailable

    try:
        store = Store(Settings().database)
    except ValidationError as error:
        refuse(f"A setting is not valid: {explain(list(error.errors()))}.")
    except StoreUnavailable as unavailable:
        refuse(str(unavailable))
    try:
        yield store
    finally:
        store.close()
