"""Processes that run the service's own code beside it.

Run as a program, with the number of its owner and the name of a module, this has that module end
with its owner.
"""

from __future__ import annotations

import ctypes
import importlib
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


def bound(module: str) -> tuple[str, ...]:
    """Return the command that runs a module of this package for as long as its owner is there.

    On Linux it is killed when the thread ends that started it, also where it is held
    (`bystanders.py`) and cannot see its input end; from before it reads in any library, for it may
    be held from then on.
    """
    return sys.executable, "-m", f"{__package__}.apart", str(os.getpid()), module


def orders_and_answers() -> tuple[BinaryIO, BinaryIO]:
    """Return standard input and output of this process as binary files, for their owner alone.

    What else is printed here goes to standard error, which is the service's.
    """
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return sys.stdin.buffer, answers


def _end_with_owner(owner: int) -> None:
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_SIGNAL_OF_DEATH, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != owner:
            sys.exit()  # It ended before it could be seen to.


def main() -> None:
    """Run the `main` of the module that is named, with the arguments that come after it."""
    _end_with_owner(int(sys.argv[1]))
    del sys.argv[:2]
    importlib.import_module(f"{__package__}.{sys.argv[0]}").main()


if __name__ == "__main__":
    main()
