"""Files that are there as a whole or not at all, also if the process that writes them is killed."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(path: Path, data: bytes) -> None:
    """Write a file beside its place, then put it there in one step.

    Raises:
        OSError: If it cannot be written.
    """
    part = part_of(path, os.getpid())
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def part_of(path: Path, process: int) -> Path:
    """Return where a process writes what becomes the file at `path` once it is whole."""
    return path.with_name(f"{path.name}.{process}")
