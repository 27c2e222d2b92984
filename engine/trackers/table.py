"""A table of a tracker, row by row: its separator found, every row as long as its header."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from operator import itemgetter

import numpy as np

from ..arrays import FloatArray
from ..errors import InvalidTrack
from .numbers import to_numbers

MAX_COLUMNS = 10_000
"""Four times those of the widest tracker's file."""
CHUNK_ROWS = 1024
"""Rows that are worked on at a time."""
_SEPARATORS = ",;\t"


@dataclass(frozen=True, eq=False)
class Chunk:
    """Some rows of a file.

    Attributes:
        first: Number of the first of them, from 1.
        numbers: Of the columns that are read as numbers, shape (rows, columns); NaN is missing.
        texts: Of the columns that are read as text, by column.
    """

    first: int
    numbers: FloatArray
    texts: dict[str, list[str]]

    def __len__(self) -> int:
        return len(self.numbers)


class Table:
    """A header and the rows below it, read once.

    Attributes:
        header: Names of the columns, as they stand, without spaces around.
    """

    def __init__(self, lines: Iterator[str]) -> None:
        """Read the header.

        Raises:
            InvalidTrack: If there is none, or it has too many columns.
        """
        head, separator = _head(lines)
        rows = csv.reader(
            chain([head], lines), delimiter=separator, skipinitialspace=True, strict=False
        )
        self._rows = _guarded(rows)
        self.header = [name.strip() for name in next(self._rows)]
        if len(self.header) > MAX_COLUMNS:
            raise InvalidTrack(
                f"the header has {len(self.header):,} columns; at most {MAX_COLUMNS:,} are read: "
                "save the tracker's table without what is not its own"
            )

    def chunks(self, numbers: Sequence[str], texts: Sequence[str]) -> Iterator[Chunk]:
        """Yield the rows below the header, these columns of them.

        Raises:
            InvalidTrack: For a row that is shorter or longer than the header, or a cell that is
                no number.
        """
        take = _taker([self.header.index(name) for name in numbers])
        places = {name: self.header.index(name) for name in texts}
        first, cells, words = 1, [], {name: list[str]() for name in texts}
        for row in self._whole_rows():
            cells.append(take(row))
            for name, place in places.items():
                words[name].append(row[place].strip())
            if len(cells) == CHUNK_ROWS:
                values = to_numbers(cells, numbers, first)
                yield Chunk(first, values, words)
                first, cells, words = first + len(cells), [], {name: [] for name in texts}
        if cells:
            yield Chunk(first, to_numbers(cells, numbers, first), words)

    def _whole_rows(self) -> Iterator[list[str]]:
        width = len(self.header)
        number, short = 0, None
        for row in self._rows:
            if not row or (len(row) == 1 and not row[0].strip()):
                continue
            if short is not None:
                raise InvalidTrack(
                    f"row {number} has {short} of the header's {width} columns; every row needs "
                    "all of them: save the table again"
                )
            number += 1
            if len(row) == width:
                yield row
            elif len(row) < width:
                short = len(row)
            elif any(cell.strip() for cell in row[width:]):
                raise InvalidTrack(_too_long(number, len(row), width))
            else:
                yield row[:width]
        if short is not None:
            raise InvalidTrack(
                f"the last row, {number}, has {short} of {width} columns: the file is cut off; "
                "send it again whole, or without that row"
            )


def _taker(places: Sequence[int]) -> Callable[[Sequence[str]], tuple[str, ...]]:
    if len(places) == 1:  # Such a getter returns its item bare.
        return lambda row: (row[places[0]],)
    return itemgetter(*places)


def _head(lines: Iterator[str]) -> tuple[str, str]:
    """Return the header's line and what separates it; Excel's `sep=;` says it before."""
    for line in lines:
        text = line.strip()
        if text.lower().startswith("sep=") and len(text) == 5:
            continue
        if text:
            counts = {each: text.count(each) for each in _SEPARATORS}
            best = max(_SEPARATORS, key=lambda each: counts[each])
            return line, best
    raise InvalidTrack("the file has no header; expected the names of a tracker's columns")


def _guarded(rows: Iterator[list[str]]) -> Iterator[list[str]]:
    while True:
        try:
            row = next(rows)
        except StopIteration:
            return
        except csv.Error as error:
            raise InvalidTrack(
                f"the table cannot be read: {error}; save it as plain CSV, without line breaks or "
                "open quotes in its cells"
            ) from error
        yield row


def _too_long(number: int, cells: int, width: int) -> str:
    hint = "save the table again"
    if cells >= 2 * width - 2:
        hint = (
            "if its numbers have decimal commas, save it with decimal points, or separated by "
            "semicolons"
        )
    return f"row {number} has {cells} cells for the header's {width} columns; {hint}"


def joined(chunks: Sequence[Chunk]) -> Chunk:
    """Return chunks that follow one another as one."""
    texts = {name: [t for each in chunks for t in each.texts[name]] for name in chunks[0].texts}
    return Chunk(chunks[0].first, np.concatenate([each.numbers for each in chunks]), texts)
