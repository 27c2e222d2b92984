"""The one-euro filter: smooth where a signal rests, quick where it moves.

Casiez, Roussel and Vogel, "1 € Filter: A Simple Speed-based Low-pass Filter for Noisy Input in
Interactive Systems", CHI 2012.
"""

from __future__ import annotations

import math

import numpy as np

from ..arrays import FloatArray

SPEED_CUTOFF = 1.0
"""Cutoff of the speed's own filter, Hz: the paper's."""
BETA = 2.0
"""Hz of cutoff for each unit a second of speed. Ours: a blink, some ten a second, passes almost
whole."""


class OneEuro:
    """Filters signals at an even rate, one frame after another."""

    def __init__(self, rate: float, min_cutoff: float, beta: float = BETA) -> None:
        """Start without a past.

        Args:
            rate: Frames a second.
            min_cutoff: Cutoff of a signal at rest, Hz.
            beta: How much it rises with speed, Hz by units a second.
        """
        self._rate, self._min_cutoff, self._beta = rate, min_cutoff, beta
        self._value: FloatArray | None = None
        self._speed: FloatArray | None = None

    def filtered(self, frames: FloatArray) -> FloatArray:
        """Return the next frames filtered, shape (frames, signals)."""
        out = np.empty_like(frames)
        for index, frame in enumerate(frames):
            out[index] = self._step(frame)
        return out

    def _step(self, frame: FloatArray) -> FloatArray:
        if self._value is None or self._speed is None:
            self._value, self._speed = frame.copy(), np.zeros_like(frame)
            return self._value
        speed = (frame - self._value) * self._rate
        self._speed = self._speed + smoothing(SPEED_CUTOFF, self._rate) * (speed - self._speed)
        cutoff = self._min_cutoff + self._beta * np.abs(self._speed)
        self._value = self._value + smoothing(cutoff, self._rate) * (frame - self._value)
        return self._value


def smoothing(cutoff: FloatArray | float, rate: float) -> FloatArray:
    """Return the share of the way that a first-order filter goes in a frame."""
    return np.asarray(1.0 / (1.0 + rate / (2.0 * math.pi * np.asarray(cutoff))))
