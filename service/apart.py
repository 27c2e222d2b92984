"""Processes that run the service's own code beside it."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

_HOME = Path(__file__).parents[1]
_SIGNAL_OF_DEATH = 1
"""Of `prctl`: the signal that is sent when the thread ends that started this process."""


def environment() -> dict[str, str]:
    """Return the environment in which a process finds the same packages as this one."""
    path = os.pathsep.join(filter(None, (str(_HOME), os.environ.get("PYTHONPATH"))))
    return {**os.environ, "PYTHONPATH": path}


def orders_and_answers() -> tuple[BinaryIO, BinaryIO]:
    """Return standard input and output of this process as binary files, for their owner alone.

    What else is printed here goes to standard error, which is the service's. On Linux this process
    ends with its owner, also where it is held (`bystanders.py`) and cannot see its input end.
    """
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_SIGNAL_OF_DEATH, signal.SIGKILL, 0, 0, 0)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return sys.stdin.buffer, answers
