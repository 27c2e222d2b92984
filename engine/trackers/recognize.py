"""Which tracker wrote a file, told by its header."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import Protocol

from ..errors import InvalidTrack
from .blendshapes import blendshape_layout
from .columns import Columns
from .json_lines import JsonLines
from .layout import Layout
from .libreface import libreface_layout
from .openface import mapped_layout, openface_layout
from .options import TrackOptions
from .pyfeat import pyfeat_layout
from .table import Chunk, Table

_KNOWN = (
    "OpenFace 2 (AU12_r), py-feat (AU12), LibreFace (au_12_intensity), Live Link Face and A2F-3D "
    "(JawOpen, MouthSmileLeft), or JSON lines of MediaPipe's blend shapes"
)


class Source(Protocol):
    """What a file is read from: a header and its rows, once."""

    header: list[str]

    def chunks(self, numbers: tuple[str, ...], texts: tuple[str, ...]) -> Iterator[Chunk]:
        """Yield the rows, some columns of them."""


def recognized(lines: Iterator[str], options: TrackOptions) -> tuple[Source, Layout]:
    """Return a file's rows and what its columns mean.

    Raises:
        InvalidTrack: If no tracker is known that writes such a header.
    """
    first = next((line for line in lines if line.strip()), "")
    lines = chain([first], lines)
    if first.lstrip()[:1] in ("{", "["):
        source = JsonLines(lines)
        return source, source.layout()
    table = Table(lines)
    columns = Columns(table.header)
    if options.au_map is not None:
        return table, mapped_layout(columns, options.au_map)
    for read in (openface_layout, libreface_layout, pyfeat_layout, blendshape_layout):
        layout = read(columns)
        if layout is not None:
            return table, layout
    raise InvalidTrack(_unknown(columns))


def _unknown(columns: Columns) -> str:
    shown = ", ".join(repr(name[:24]) for name in columns.header[:6])
    more = f" and {len(columns) - 6} more" if len(columns) > 6 else ""
    presence = [name for name in columns if name.startswith("au") and name.endswith("_c")]
    if presence:
        return (
            f"the header has only presences such as {columns.find(presence[0])}, 0 or 1; expected "
            "intensities such as AU12_r: run OpenFace with -aus"
        )
    return f"the header has the columns {shown}{more}; expected those of {_KNOWN}"
