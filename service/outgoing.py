"""The latest frame of a session as bytes: each form is made once, for every viewer of it."""

from __future__ import annotations

from collections import deque

from engine import Frame, JawHinge

from .packed import encode_packed, ticks_back
from .protocol import SurfaceFrame, encode_frame, surface_frame

_BASES = 4
"""Packed frames that are kept to tell later ones by: a viewer of 15 frames a second has one too."""


class Outgoing:
    """Bytes of one session's frames. What nobody asks for is not made."""

    def __init__(self) -> None:
        self._frame: Frame | None = None
        self._surface: SurfaceFrame | None = None
        self._told_apart = True
        self._plain: bytes | None = None
        self._packed: dict[int, bytes] = {}
        self._bases: deque[SurfaceFrame] = deque(maxlen=_BASES)

    def plain(self, frame: Frame, jaw: JawHinge) -> bytes:
        """Return `frame` in the form that everybody reads."""
        surface = self._shown(frame, jaw)
        if self._plain is None:
            self._plain = encode_frame(surface)
        return self._plain

    def packed(self, frame: Frame, jaw: JawHinge, base: int | None) -> bytes:
        """Return `frame` as what changed since the tick `base`; whole, if that is not kept."""
        surface = self._shown(frame, jaw)
        if self._told_apart and (not self._bases or self._bases[-1] is not surface):
            self._bases.append(surface)
        back = ticks_back(frame.tick, base)
        known = [each for each in self._bases if ticks_back(frame.tick, each.tick) == back]
        if back == 0 or not known:
            known, back = [], 0
        if back not in self._packed:
            self._packed[back] = encode_packed(surface, known[-1] if known else None)
        return self._packed[back]

    def _shown(self, frame: Frame, jaw: JawHinge) -> SurfaceFrame:
        """Return what viewers are told of `frame`; those of an older one are forgotten."""
        if self._surface is None or self._frame is not frame:
            earlier, self._frame = self._frame, frame
            self._surface = surface_frame(frame, jaw)
            self._plain = None
            self._packed.clear()
            # Of two frames of one tick nobody could say which one a viewer was sent.
            self._told_apart = earlier is None or earlier.tick != frame.tick
            if not self._told_apart:
                self._bases.clear()
        return self._surface
