"""Processes that run the service's own code beside it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import BinaryIO

_HOME = Path(__file__).parents[1]


def environment() -> dict[str, str]:
    """Return the environment in which a process finds the same packages as this one."""
    path = os.pathsep.join(filter(None, (str(_HOME), os.environ.get("PYTHONPATH"))))
    return {**os.environ, "PYTHONPATH": path}


def orders_and_answers() -> tuple[BinaryIO, BinaryIO]:
    """Return standard input and output of this process as binary files, for their owner alone.

    What else is printed here goes to standard error, which is the service's.
    """
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return sys.stdin.buffer, answers
