"""How the skin and each strand part of a clip move, frame by frame, held or drawn on demand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Float32Array, FloatArray, IntArray
from ..clip import Clip
from ..head.head import Part
from ..settling import Progress
from .drawn import DrawnFace
from .error import FRAMES_AT_ONCE, Check, Motion
from .frames import FrameDrawer

BYTES_IN_MEMORY = 2**29
"""Most that is held; motion beyond that is drawn again when it is looked at."""


@dataclass(frozen=True, eq=False)
class Piece:
    """One mesh that changes its form.

    Attributes:
        name: "skin", or that of the strands.
        part: The strands; None for the skin.
        rest: Its vertices at rest [mm], shape (v, 3).
        motion: How they move [mm], a frame for each of `ClipMotion.displacements`.
    """

    name: str
    part: Part | None
    rest: FloatArray
    motion: Motion


@dataclass(frozen=True, eq=False)
class ClipMotion:
    """What changes its form in a clip, each form once.

    Attributes:
        drawer: Draws its frames.
        displacements: Of the tissue in the frames that differ from the one before, shape (n, s, 3).
        shown: Which of them each frame of the clip shows, shape (f,).
        pieces: The skin, then strands.
    """

    drawer: FrameDrawer
    displacements: Float32Array
    shown: IntArray
    pieces: tuple[Piece, ...]


def motion_of(
    clip: Clip, face: DrawnFace, strands: Sequence[Part], *, progress: Progress, check: Check
) -> ClipMotion:
    """Return how the skin and `strands` of a clip move.

    Args:
        clip: Whose motion.
        face: Its face, drawn.
        strands: Those that are drawn.
        progress: Told the share of the drawing that is done.
        check: Called now and then; raises to stop.
    """
    frames = clip.displacements
    new = np.ones(len(frames), bool)
    new[1:] = [
        not np.array_equal(one, other) for one, other in zip(frames[1:], frames, strict=False)
    ]
    displacements = frames[new]
    drawer = FrameDrawer(face, strands)
    names = ("skin", *(part.name for part in strands))
    parts = (None, *strands)
    held = _held(drawer, parts, len(displacements))
    motions = _drawn(face, parts, held, displacements, progress, check)
    pieces = tuple(
        Piece(name, part, drawer.rest[piece], motion)
        for name, part, piece, motion in zip(names, parts, drawer.pieces, motions, strict=True)
    )
    return ClipMotion(drawer, displacements, np.cumsum(new) - 1, pieces)


def _held(drawer: FrameDrawer, parts: Sequence[Part | None], frames: int) -> list[bool]:
    """Return which parts' motion is held: the first that fit into memory."""
    room, held = BYTES_IN_MEMORY, []
    for piece in drawer.pieces[: len(parts)]:
        size = frames * (piece.stop - piece.start) * 3 * np.dtype(np.float32).itemsize
        held.append(size <= room)
        room -= size if held[-1] else 0
    return held


def _drawn(
    face: DrawnFace,
    parts: Sequence[Part | None],
    held: Sequence[bool],
    displacements: Float32Array,
    progress: Progress,
    check: Check,
) -> list[Motion]:
    """Return the motion of each part, drawn if it is held."""
    kept = [part for part, own in zip(parts, held, strict=True) if own and part is not None]
    drawer = FrameDrawer(face, kept)
    pieces = dict(zip((None, *(part.name for part in kept)), drawer.pieces, strict=True))
    count = len(displacements)
    motions: list[Motion] = []
    arrays: list[tuple[Float32Array, slice]] = []
    for part, own in zip(parts, held, strict=True):
        if own:
            piece = pieces[None if part is None else part.name]
            array = np.empty((count, piece.stop - piece.start, 3), np.float32)
            arrays.append((array, piece))
            motions.append(array)
        else:
            motions.append(_Later(face, part, displacements, check))
    for start in range(0, count if arrays else 0, FRAMES_AT_ONCE):
        check()
        frames = slice(start, min(start + FRAMES_AT_ONCE, count))
        moved = drawer.moves(displacements[frames])
        for array, piece in arrays:
            array[frames] = moved[:, piece]
        progress(frames.stop / count)
    return motions


class _Later:
    """The motion of one part, drawn when it is looked at."""

    def __init__(
        self, face: DrawnFace, part: Part | None, displacements: Float32Array, check: Check
    ) -> None:
        self._drawer = FrameDrawer(face, [] if part is None else [part])
        self._piece = self._drawer.pieces[-1]
        self._displacements = displacements
        self._check = check

    def __len__(self) -> int:
        return len(self._displacements)

    def __getitem__(self, frames: slice | IntArray, /) -> Float32Array:
        chosen = self._displacements[frames]
        parts = [np.empty((0, self._piece.stop - self._piece.start, 3), np.float32)]
        for start in range(0, len(chosen), FRAMES_AT_ONCE):
            self._check()
            moved = self._drawer.moves(chosen[start : start + FRAMES_AT_ONCE])
            parts.append(moved[:, self._piece])
        return np.ascontiguousarray(np.concatenate(parts))
