"""Work that is done for as long as who asked for it is there."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable
from typing import TypeVar

from fastapi import Request

Value = TypeVar("Value")


class AskerLeft(Exception):
    """Who asked has closed the connection: there is nobody to answer."""


async def while_there(request: Request, work: Awaitable[Value]) -> Value:
    """Return what `work` comes to; it is cancelled when who asked goes.

    Raises:
        AskerLeft: If they went.
    """
    task = asyncio.ensure_future(work)
    leaving = asyncio.ensure_future(_leaves(request))
    try:
        await asyncio.wait({task, leaving}, return_when=asyncio.FIRST_COMPLETED)
        if not task.done():
            raise AskerLeft
        return task.result()
    finally:
        for each in (task, leaving):
            each.cancel()
        await asyncio.gather(task, leaving, return_exceptions=True)


async def _leaves(request: Request) -> None:
    """Return once the connection is closed."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
