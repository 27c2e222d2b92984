"""Hashes of the engine's own files, code and data: what it makes changes when they do."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from importlib import resources
from importlib.resources.abc import Traversable

_KINDS = (".py", ".json", ".npz")
_NO_KERNELS = ("analysis", "gltf", "head", "inverse")
"""Packages from which no kernel outside of `head` takes anything."""


Files = Mapping[str, bytes]
"""Content by place."""


def files_in(folder: Traversable, place: str = "") -> Files:
    """Return the code and data under `folder`."""
    found: dict[str, bytes] = {}
    for entry in folder.iterdir():
        if entry.is_dir():
            found |= files_in(entry, f"{place}{entry.name}/")
        elif entry.name.endswith(_KINDS):
            found[f"{place}{entry.name}"] = entry.read_bytes()
    return found


def hash_of(files: Files) -> str:
    """Return a hash of files: every one's place and content."""
    digest = hashlib.sha256()
    for place, content in sorted(files.items()):
        digest.update(f"{place}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()[:20]


def of_kernels(files: Files) -> Files:
    """Return the code that a kernel outside of `head` may be made of."""
    return {
        place: content
        for place, content in files.items()
        if place.endswith(".py") and place.partition("/")[0] not in _NO_KERNELS
    }


# Read with the code itself: what a running process makes is not what a later source would make.
_FILES = files_in(resources.files(__package__))
ENGINE_HASH = hash_of(_FILES)
"""Hash of the whole engine."""
HEAD_HASH = hash_of({place: each for place, each in _FILES.items() if place.startswith("head/")})
"""Hash of what makes heads."""
KERNELS_HASH = hash_of(of_kernels(_FILES))
"""Hash of all code that a kernel outside of `head` may be made of."""
del _FILES
