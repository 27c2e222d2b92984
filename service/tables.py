"""Markdown tables, for what the command line prints."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> list[str]:
    """Return the lines of a table.

    Args:
        head: Title of each column.
        rows: Cells of each row, written as they are.

    Raises:
        ValueError: If a row has another number of cells.
    """
    lines = [_line(head), f"|{'---|' * len(head)}"]
    for row in rows:
        if len(row) != len(head):
            raise ValueError(f"a row has {len(row)} cells; expected {len(head)}: {row}")
        lines.append(_line(row))
    return lines


def _line(cells: Iterable[object]) -> str:
    return "".join(f"| {cell} " for cell in cells) + "|"
