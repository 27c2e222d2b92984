"""Figures of this machine: how many faces it moves, how fast, and beside what other tools do."""

from .everything import measure
from .machine import machine

__all__ = ["machine", "measure"]
