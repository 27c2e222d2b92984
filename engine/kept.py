"""Files that can be made again, in a folder that keeps those asked for last."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, TypeVar

T = TypeVar("T")


def read_kept(path: Path, read: Callable[[IO[bytes]], T]) -> T:
    """Return what `read` makes of a kept file, which then counts as the last one asked for.

    Raises:
        OSError: It is not there, or cannot be read.
    """
    with path.open("rb") as file:
        value = read(file)
    with suppress(OSError):
        os.utime(path)
    return value


def keep(path: Path, write: Callable[[IO[bytes]], object], most_bytes: int) -> None:
    """Keep a file, and remove those of its kind that were asked for longest ago.

    Args:
        path: Where; its suffix is its kind.
        write: Writes its content. A reader never sees half a file.
        most_bytes: Size that the files of its kind in its folder may reach together.

    Raises:
        OSError: The folder cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".tmp", delete=False) as file:
        try:
            write(file)
        except BaseException:
            os.unlink(file.name)
            raise
    os.replace(file.name, path)
    files = [(file.stat(), file) for file in path.parent.glob(f"*{path.suffix}")]
    size = 0
    for stat, old in sorted(files, key=lambda entry: entry[0].st_mtime, reverse=True):
        size += stat.st_size
        if size > most_bytes:
            old.unlink(missing_ok=True)
