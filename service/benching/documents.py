"""The documents of a run: benchmarks.md, benchmarks.svg and a row of benchmarks.csv."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .ledger import append_row
from .picture import picture
from .report import about, markdown

_OPENING = """# Benchmarks

How many faces a core moves, and what for. All of it comes from one run of `make bench`, which
prints the same tables on your machine, writes this page and its picture, and adds a row to
[benchmarks.csv](benchmarks.csv); `risorius bench --json` prints every figure. Seconds are the
measuring thread's own unless the clock is named, but who else uses the machine still takes caches
and memory from it: compare ratios within a run before figures of two.

![Cost of a face, and the kernels beside their peers](benchmarks.svg)
"""


def write_documents(folder: Path, figures: dict[str, Any]) -> None:
    """Write page and picture of a run into `folder`, and add its row.

    Raises:
        OtherColumns: If the rows that are there have other columns.
        OSError: If a file cannot be written.
    """
    append_row(folder / "benchmarks.csv", figures)
    (folder / "benchmarks.svg").write_text(picture(figures), encoding="utf-8")
    page = "\n".join([_OPENING, about(figures), "", markdown(figures)])
    (folder / "benchmarks.md").write_text(page, encoding="utf-8")
