"""The files of clips: what they are made from, and what they give, by the id of a clip."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path

from .uploads import SUFFIX as UPLOAD

GIVEN = ("glb", "csv")
"""Animation and ground truth."""
TRACK = "track"
"""A tracker's file, for as long as its clip is not done."""
_STRAY = re.compile(rf"[0-9a-f]{{32}}(?:\.(?:{'|'.join(GIVEN)})\.\d+|{re.escape(UPLOAD)})")
"""What a process writes that has not come to its end: `part_of` a file, or an upload."""
_KEPT = re.compile(rf"([0-9a-f]{{32}})\.{TRACK}")


class ClipFolder:
    """The folder of clips."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def path(self, clip: str, suffix: str) -> Path:
        """Return where a file of a clip is, or will be."""
        return self.folder / f"{clip}.{suffix}"

    def keep_track(self, clip: str, upload: Path) -> None:
        """Keep an upload as what a clip is made from.

        Raises:
            OSError: If it is no longer there.
        """
        upload.replace(self.path(clip, TRACK))

    def remove(self, clip: str, *suffixes: str) -> None:
        """Remove files of a clip, all of them where none is named."""
        for suffix in suffixes or (*GIVEN, TRACK):
            self.path(clip, suffix).unlink(missing_ok=True)

    def remove_strays(self, unfinished: Collection[str]) -> None:
        """Remove what a killed service left in the middle of.

        Args:
            unfinished: Clips that are still to be rendered; the tracks of all others go.
        """
        for path in self.folder.glob("*"):
            kept = _KEPT.fullmatch(path.name)
            if _STRAY.fullmatch(path.name) or (kept and kept[1] not in unfinished):
                path.unlink(missing_ok=True)
