"""Chance by a number: draws that one seed always gives, whoever draws and whenever."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import TypeVar
from zlib import crc32

Choice = TypeVar("Choice")

_NORMAL = NormalDist()
_BITS = 2**64
_STEP = 0x9E3779B97F4A7C15


class Chance:
    """One sequence of draws: SplitMix64 (Steele, Lea and Flood 2014), begun by seed and purpose.

    Each purpose has a sequence of its own, so that more blinks do not change where the eyes go.
    """

    def __init__(self, seed: int, purpose: str) -> None:
        self._state = _mixed(seed * _STEP + crc32(purpose.encode()))

    def share(self) -> float:
        """Return a number above 0 and below 1, each as likely."""
        self._state = (self._state + _STEP) % _BITS
        return ((_mixed(self._state) >> 12) + 0.5) / 2**52

    def happens(self, probability: float) -> bool:
        """Return whether something of this probability happens."""
        return self.share() < probability

    def between(self, least: float, most: float) -> float:
        """Return a number between two, each as likely."""
        return least + (most - least) * self.share()

    def normal(self, deviation: float) -> float:
        """Return a number that is normally distributed about 0."""
        return deviation * _NORMAL.inv_cdf(self.share())

    def log_normal(self, median: float, spread: float, least: float, most: float) -> float:
        """Return a number whose logarithm is normally distributed, of the part between two ends.

        Args:
            median: Of the whole distribution.
            spread: Standard deviation of the logarithm.
            least: The lower end.
            most: The upper one.
        """
        low, high = (_NORMAL.cdf(math.log(end / median) / spread) for end in (least, most))
        drawn = median * math.exp(spread * _NORMAL.inv_cdf(low + (high - low) * self.share()))
        return min(max(drawn, least), most)

    def one_of(self, choices: Sequence[tuple[Choice, float]]) -> Choice:
        """Return one of some choices, each with its weight."""
        left = self.share() * sum(weight for _, weight in choices)
        for choice, weight in choices:
            left -= weight
            if left < 0.0:
                return choice
        return choices[-1][0]


def _mixed(number: int) -> int:
    """Return 64 bits, each of which depends on every bit of `number`."""
    z = number % _BITS
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % _BITS
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB % _BITS
    return z ^ (z >> 31)
