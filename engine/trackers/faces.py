"""Which face of several is played, and how often each was seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray
from ..errors import InvalidTrack
from .gate import Gate, mean_confidence
from .layout import Layout
from .table import Chunk

ONLY = ""
"""The face of a file that names none."""
OTHERS = "others"
MOST_FACES = 64
"""So many are told apart in the report."""


class Faces:
    """Picks the rows of one face, and counts those of each.

    Attributes:
        chosen: Which face is played.
        rows: Rows of each.
    """

    def __init__(self, layout: Layout, chosen: str) -> None:
        self._column = layout.face
        self.chosen = chosen
        self.rows: dict[str, int] = {}

    def own(self, chunk: Chunk) -> BoolArray:
        """Return which rows are of the face, shape (rows,), and count them all."""
        names = face_names(chunk, self._column)
        for name in names:
            known = name in self.rows or len(self.rows) < MOST_FACES
            place = name if known else OTHERS
            self.rows[place] = self.rows.get(place, 0) + 1
        return np.array([name == self.chosen for name in names], dtype=bool)

    def check(self) -> None:
        """Refuse a face of which there is no row.

        Raises:
            InvalidTrack: With the faces that there are.
        """
        if not self.rows:
            raise InvalidTrack(
                "the file has a header and no rows below it; expected one row for each frame"
            )
        if self.chosen not in self.rows:
            known = ", ".join(name or "one without a name" for name in self.rows)
            raise InvalidTrack(f"there is no face {self.chosen!r} in the file; it has {known}")


def chosen_face(layout: Layout, sample: Chunk, gate: Gate, asked: str | int | None) -> str:
    """Return the face that is asked for, or of the first rows the one that is seen best.

    That is the one with the most rows that count; of two alike the more confident, then the first.
    """
    if asked is not None and layout.face is not None:
        return _plain(str(asked))
    names = face_names(sample, layout.face)
    counts = np.array(names)[gate.good(sample)] if len(sample) else np.array([])
    own = {name: np.array([each == name for each in names]) for name in dict.fromkeys(names)}
    good = gate.good(sample)
    return max(
        own,
        key=lambda name: (
            int((counts == name).sum()),
            mean_confidence(layout, sample.numbers[own[name] & good]),
        ),
        default=ONLY,
    )


def face_names(chunk: Chunk, column: str | None) -> Sequence[str]:
    """Return the face of each row."""
    if column is None:
        return [ONLY] * len(chunk)
    return [_plain(word) for word in chunk.texts[column]]


def _plain(word: str) -> str:
    """Return a face's name, "0.0" as "0"."""
    text = word.strip()
    head, point, tail = text.partition(".")
    return head if point and head.isdigit() and not tail.strip("0") else text
