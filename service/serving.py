"""Serving from the command line: what a person sees while it starts."""

from __future__ import annotations

import asyncio
import ctypes
import gc
from contextlib import suppress

import uvicorn
from fastapi import FastAPI
from rich.console import Console

from .app import create_app
from .components import Components
from .kernels import Compiling
from .priority import take_short_turns
from .server import listen, server_of, url_of
from .settings import Settings


async def serve_until_stopped(
    settings: Settings, console: Console, compiling: Compiling | None
) -> None:
    """Serve until a signal comes.

    Args:
        settings: Of the service.
        console: Told what a person wants to know.
        compiling: Kernels that are being compiled already.

    Raises:
        OSError: If the address cannot be used.
    """
    take_short_turns()
    # Until it is ready: what a start makes is no garbage, and what was imported never will be.
    gc.disable()
    gc.freeze()
    listener = listen(settings.host, settings.port)
    app = create_app(settings, compiling=compiling)
    server = server_of(app, settings)
    console.print(f"Risorius at {url_of(listener)}", soft_wrap=True)
    announcing = asyncio.create_task(_announce(app, server, console))
    try:
        await server.serve(sockets=[listener])
    finally:
        gc.enable()
        announcing.cancel()
        with suppress(asyncio.CancelledError):
            await announcing
        listener.close()


async def _announce(app: FastAPI, server: uvicorn.Server, console: Console) -> None:
    """Say what is being warmed up, until it is ready."""
    while not server.started:
        await asyncio.sleep(0.02)
    parts: Components = app.state.parts
    said = ""
    while not parts.ready.is_set():
        if parts.stage != said:
            said = parts.stage
            console.print(f"  {said} …", markup=False)
        if said.startswith("failed"):
            gc.enable()
            return
        await asyncio.sleep(0.1)
    _settle()
    console.print("  ready")


def _settle() -> None:
    """Look for garbage again, and give back what only the start needed."""
    gc.enable()
    with suppress(OSError, AttributeError):  # Only glibc has it.
        ctypes.CDLL(None).malloc_trim(0)
