"""The kernels of live faces, compiled beside everything else that a first start does."""

from __future__ import annotations

import asyncio
import sys

from engine import kernels_are_kept

from .apart import environment

_SCRIPT = "import gc; gc.disable(); import engine; engine.warm_sweep()"


async def compile_sweep() -> None:
    """Compile the longest kernels, if they were never compiled on this machine.

    In a process of its own, which keeps them on disk: compiling holds the interpreter, and the
    first rig would be built after it instead of beside it.
    """
    if not await asyncio.to_thread(kernels_are_kept):
        await _compile_apart()


async def _compile_apart() -> None:
    """Compile in a process; what it fails to do is done where a kernel is first called."""
    try:
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-c",
            _SCRIPT,
            env=environment(),
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.DEVNULL,
        )
    except OSError:
        return
    try:
        await process.wait()
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
