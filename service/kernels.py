"""The kernels of live faces, compiled beside everything else that a first start does."""

from __future__ import annotations

import asyncio
import subprocess

from engine import kernels_are_kept

from .apart import bound, environment

Compiling = subprocess.Popen[bytes]
_COMMAND = bound("compile_process")
_PAUSE_SECONDS = 0.02


def begin_compiling() -> Compiling | None:
    """Start to compile what moves faces, if that was never compiled on this machine.

    In a process of its own, which keeps it on disk and ends with this thread: compiling holds the
    interpreter, and all that a start imports and builds would come after it instead of beside it.
    What it fails to do is done where a kernel is first called.
    """
    if kernels_are_kept():
        return None
    try:
        return subprocess.Popen(
            _COMMAND,
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except OSError:
        return None


async def compiled(compiling: Compiling | None) -> None:
    """Wait for what was begun; who does not wait to its end, ends it."""
    if compiling is None:
        return
    try:
        while compiling.poll() is None:
            await asyncio.sleep(_PAUSE_SECONDS)
    finally:
        if compiling.poll() is None:
            compiling.kill()
            compiling.wait()
