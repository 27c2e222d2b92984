"""Files that clients send: written to disk as they come, and gone if nobody keeps them.

A tracker's file may be many times as large as what is read into memory of any other body. It is
written to a file of its own in the folder of clips while its checksum is taken; the route that
wants it renames it, and what was not renamed goes with the request.
"""

from __future__ import annotations

import asyncio
import hashlib
import os
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from starlette.datastructures import Headers
from starlette.types import Message, Receive, Scope

from .errors import Busy, Refused

MEDIA_TYPES = ("text/csv", "application/jsonl", "application/x-ndjson")
"""Of the files that are taken in: tables, and JSON lines by either of their names."""
SUFFIX = ".upload"
"""Of a file that somebody is sending."""
_PATH = "/api/clips"
_BLOCK = 1_048_576
"""Bytes that are kept in memory until they are written."""
_STALLED_SECONDS = 60.0
"""Without a byte, after which a client is taken to be gone: a phone that lost its network says
nothing."""


class SenderGone(Exception):
    """A client that left in the middle of its body; nobody waits for an answer."""


@dataclass(frozen=True)
class Upload:
    """A body that has come whole.

    Attributes:
        path: Where it is, until somebody renames it.
        size: Its bytes.
        digest: SHA-256 of it, in hexadecimal.
    """

    path: Path
    size: int
    digest: str


def is_upload(scope: Scope) -> bool:
    """Return whether a request's body is a file that is written to disk."""
    return (
        scope["method"] == "POST"
        and scope["path"] == _PATH
        and media_type(Headers(scope=scope)) in MEDIA_TYPES
    )


def media_type(headers: Headers) -> str:
    """Return the content type without its parameters, in small letters."""
    return headers.get("content-type", "").partition(";")[0].strip().lower()


class Uploads:
    """Where bodies are written, so many at once, each of so many bytes at most."""

    def __init__(self, folder: Path, *, limit: int, most: int) -> None:
        self._folder = folder
        self._limit = limit
        self._most = most
        self._open = 0

    @property
    def under_way(self) -> int:
        """Requests with a file that are not answered yet."""
        return self._open

    async def take_in(self, scope: Scope, receive: Receive, pay: Callable[[int], None]) -> Upload:
        """Write a body to a file and return it; `let_go` follows once the request is answered.

        Args:
            scope: Of the request.
            receive: Gives its body.
            pay: Told how many bytes come, before they are written; raises if they are too many.

        Raises:
            Refused: If it is too large, packed, or there is no room for it; what came is removed.
            SenderGone: If the client left before its end.
        """
        headers = Headers(scope=scope)
        self._check(headers)
        if self._open >= self._most:
            raise Busy("too_many_uploads", f"{self._most} files are being sent", retry_after=10)
        declared = int(headers.get("content-length", "0"))
        pay(declared)
        self._open += 1
        path = self._folder / f"{secrets.token_hex(16)}{SUFFIX}"
        try:
            return await self._written(path, receive, declared, pay)
        except OSError as error:
            await self._let_go(path)
            raise Busy("no_room", f"the file cannot be kept: {error.strerror}") from error
        except BaseException:
            await self._let_go(path)
            raise

    async def let_go(self, upload: Upload) -> None:
        """Remove a body that nobody kept."""
        await self._let_go(upload.path)

    async def _let_go(self, path: Path) -> None:
        self._open -= 1
        await asyncio.shield(asyncio.to_thread(path.unlink, missing_ok=True))

    def _check(self, headers: Headers) -> None:
        length = headers.get("content-length", "0")
        if not length.isdecimal() or len(length) > 18 or int(length) > self._limit:
            raise self._too_large()
        packed = headers.get("content-encoding", "identity").strip().lower()
        if packed not in ("", "identity"):
            message = f"the file comes packed, as {packed[:40]!r}; send it as it is"
            raise _refused(415, "packed_body", message, {"Accept-Encoding": "identity"})

    async def _written(
        self, path: Path, receive: Receive, declared: int, pay: Callable[[int], None]
    ) -> Upload:
        await asyncio.to_thread(_begin, path)
        digest, block, size, paid = hashlib.sha256(), bytearray(), 0, declared
        more = True
        while more:
            message = await _next(receive)
            if message["type"] != "http.request":
                raise SenderGone
            block += message.get("body", b"")
            more = bool(message.get("more_body", False))
            if size + len(block) > self._limit:
                raise self._too_large()
            if size + len(block) > paid:
                pay(size + len(block) - paid)
                paid = size + len(block)
            if len(block) >= _BLOCK or not more:
                await asyncio.to_thread(_append, path, bytes(block), digest.update)
                size += len(block)
                block.clear()
        return Upload(path, size, digest.hexdigest())

    def _too_large(self) -> Refused:
        return _refused(413, "body_too_large", f"a tracker's file has at most {self._limit} bytes")


async def _next(receive: Receive) -> Message:
    """Return what comes next.

    Raises:
        Refused: If nothing comes for too long.
    """
    try:
        async with asyncio.timeout(_STALLED_SECONDS):
            return await receive()
    except TimeoutError:
        message = f"no byte of the file came for {_STALLED_SECONDS:g} s; send it again"
        # RFC 9110, 15.5.9: whoever sends no end of a request should not keep the connection.
        headers = {"Connection": "close"}
        raise _refused(408, "upload_stalled", message, headers) from None


def _begin(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch(exist_ok=False)


def _append(path: Path, block: bytes, note: Callable[[bytes], None]) -> None:
    """Write a block to the end of a file that is there: one that was removed stays so."""
    note(block)
    with path.open("r+b") as file:
        file.seek(0, os.SEEK_END)
        file.write(block)


def _refused(
    status: int, error: str, message: str, headers: dict[str, str] | None = None
) -> Refused:
    refused = Refused(error, message)
    refused.status = status
    refused.headers = headers or {}
    return refused
