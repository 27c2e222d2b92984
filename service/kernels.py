"""The kernels of live faces, compiled beside everything else that a first start does."""

from __future__ import annotations

import asyncio
import subprocess

import structlog

from engine import kernels_are_kept

from .apart import bound, environment

_LOG = structlog.get_logger("service")
Compiling = subprocess.Popen[bytes]
_MODULE = "compile_process"
_PAUSE_SECONDS = 0.02


def begin_compiling() -> Compiling | None:
    """Start to compile what moves faces, if that was never compiled on this machine.

    In a process of its own, which keeps it on disk: compiling holds the interpreter, and all that
    a start imports and builds would come after it instead of beside it. What it fails to do is
    done, and told of, where a kernel is first called. Whoever begins it ends it (`end`).
    """
    try:
        if kernels_are_kept():
            return None
        return subprocess.Popen(
            bound(_MODULE),
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except Exception as error:  # A cache that cannot be read, or has no folder, fails in many ways.
        _LOG.warning("kernels are not compiled beside the start", reason=str(error))
        return None


async def compiled(compiling: Compiling | None) -> None:
    """Wait for what was begun."""
    while compiling is not None and compiling.poll() is None:
        await asyncio.sleep(_PAUSE_SECONDS)


def end(compiling: Compiling | None) -> None:
    """End what was begun, if it goes on."""
    if compiling is not None:
        compiling.kill()
        compiling.wait()
