"""How the command line speaks: answers on one channel, everything else on the other."""

from __future__ import annotations

from typing import NoReturn

import typer
from rich.console import Console
from rich.markup import escape

REFUSED = 2
console = Console(stderr=True, highlight=False)


def refuse(sentence: str) -> NoReturn:
    """Say why something is not done, and end with 2."""
    whole = sentence.removesuffix(".") if sentence.endswith("?.") else sentence
    console.print(escape(whole), style="red", soft_wrap=True)
    raise typer.Exit(REFUSED)


def words(listed: str) -> tuple[str, ...]:
    """Return the words of a list with commas."""
    return tuple(word.strip() for word in listed.split(",") if word.strip())
