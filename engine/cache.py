"""Arrays that are slow to make, kept on disk under a hash of what made them."""

from __future__ import annotations

import hashlib
import os
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from .kept import keep, read_kept

MOST_BYTES = 1_000_000_000
"""Size that the folder's arrays may reach: some hundred people, at all levels."""
MOST_BYTES_ASIDE = 100_000_000
"""The same for each folder in it."""

Arrays = dict[str, npt.NDArray[Any]]
"""Arrays of any type by name: who reads them knows which."""


def cache_folder() -> Path:
    """Return the folder of cached arrays: RISORIUS_CACHE_DIR, else the user's cache folder."""
    given = os.environ.get("RISORIUS_CACHE_DIR")
    if given:
        return Path(given)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "risorius"


def content_key(*parts: object) -> str:
    """Return a hash of `parts`: arrays by shape, type and bytes, anything else by its repr."""
    digest = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            digest.update(f"{part.dtype.str}{part.shape}".encode())
            digest.update(np.ascontiguousarray(part).tobytes())
        elif isinstance(part, bytes):
            digest.update(part)
        else:
            digest.update(repr(part).encode())
        digest.update(b"\0")
    return digest.hexdigest()[:20]


def cached_arrays(
    kind: str, key: str, build: Callable[[], Arrays], *, aside: bool = False
) -> Arrays:
    """Return the arrays stored under `kind` and `key`, or build and store them.

    A missing, damaged or unwritable cache costs time, never an error.

    Args:
        kind: What the arrays are, one word; names the file.
        key: Hash of everything the arrays depend on (`content_key`).
        build: Makes the arrays when they are not stored.
        aside: Whether to keep them in a folder of their kind, so that many of them, made while
            somebody drags a slider, push out nothing that takes longer to make.
    """
    folder = cache_folder() / kind if aside else cache_folder()
    path = folder / f"{kind}-{key}.npz"
    stored = _read(path)
    if stored is not None:
        return {name: np.ascontiguousarray(array) for name, array in stored.items()}
    # In one layout, whether built or read: kernels are compiled for a layout, and a second start
    # would compile them again.
    arrays = {name: np.ascontiguousarray(array) for name, array in build().items()}
    _write(path, arrays, MOST_BYTES_ASIDE if aside else MOST_BYTES)
    return arrays


def _read(path: Path) -> Arrays | None:
    try:
        return read_kept(path, _arrays_in)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, KeyError):
        return None


def _arrays_in(file: IO[bytes]) -> Arrays:
    with np.load(file, allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


def _write(path: Path, arrays: Arrays, most_bytes: int) -> None:
    with suppress(OSError):
        keep(path, lambda file: np.savez(file, allow_pickle=False, **arrays), most_bytes)
