"""One table of figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

Row = Sequence[object]


@dataclass(frozen=True)
class Section:
    """One table.

    Attributes:
        title: Its heading.
        note: What one has to know to read it.
        head: Title of each column; the first is of names, the others of numbers.
        rows: Its cells.
    """

    title: str
    note: str
    head: tuple[str, ...]
    rows: tuple[Row, ...]
