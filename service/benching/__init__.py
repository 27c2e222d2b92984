"""Figures of this machine: how many faces it moves, how fast, and beside what other tools do."""

from .everything import PARTS, measure
from .machine import machine

__all__ = ["PARTS", "machine", "measure"]
