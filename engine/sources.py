"""Hashes of the engine's own files, code and data: what it makes changes when they do."""

from __future__ import annotations

import hashlib
from importlib import resources
from importlib.resources.abc import Traversable

_KINDS = (".py", ".json", ".npz")
_NO_KERNELS = ("analysis", "gltf", "head", "inverse")
"""Packages from which no kernel outside of `head` takes anything."""


def sources_hash(
    folder: Traversable, *, kinds: tuple[str, ...] = _KINDS, without: tuple[str, ...] = ()
) -> str:
    """Return a hash of the code and data under `folder`: every file's place and content.

    Args:
        folder: Where.
        kinds: Endings of the files that count.
        without: Folders right in it that do not.
    """
    digest = hashlib.sha256()
    for place, content in sorted(_files(folder, "", kinds)):
        if place.partition("/")[0] in without:
            continue
        digest.update(f"{place}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()[:20]


def _files(folder: Traversable, place: str, kinds: tuple[str, ...]) -> list[tuple[str, bytes]]:
    found: list[tuple[str, bytes]] = []
    for entry in folder.iterdir():
        if entry.is_dir():
            found += _files(entry, f"{place}{entry.name}/", kinds)
        elif entry.name.endswith(kinds):
            found.append((f"{place}{entry.name}", entry.read_bytes()))
    return found


# Read with the code itself: what a running process makes is not what a later source would make.
ENGINE_HASH = sources_hash(resources.files(__package__))
"""Hash of the whole engine."""
HEAD_HASH = sources_hash(resources.files(__package__) / "head")
"""Hash of what makes heads."""
KERNELS_HASH = sources_hash(resources.files(__package__), kinds=(".py",), without=_NO_KERNELS)
"""Hash of all code that a kernel outside of `head` may be made of."""
