"""What the service answers when it refuses: one shape, everywhere.

Refused
├── Forbidden      403  a ticket that is not for this
├── NotFound       404  no such session, rig, clip, …
├── Conflict       409  the thing is not in a state for this
├── Unprocessable  422  a body or a name that cannot be used
├── AtCapacity     429  the machine moves as many faces as it can; comes with Retry-After
├── QuotaExceeded  429  a key has taken what it may; comes with Retry-After
├── NoPictures     501  there is no viewer or no Chromium here to draw with
└── Busy           503  a limit is reached; comes with Retry-After
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping
from typing import Any

from starlette.responses import Response

from engine import EngineError, UnknownName

_WORDS = re.compile(r"(?<=[a-z])(?=[A-Z])")


class Refused(Exception):
    """Anything that the service refuses.

    Attributes:
        status: The HTTP status.
        error: The error's name, in snake case.
        message: One sentence.
        known: The names that would have been accepted, if it is about a name.
    """

    status = 400

    def __init__(self, error: str, message: str, *, known: Iterable[str] | None = None) -> None:
        super().__init__(message)
        self.error = error
        self.message = message
        self.known = None if known is None else list(known)
        self.headers: dict[str, str] = {}

    def __str__(self) -> str:
        """Return the sentence, with what was added to it since."""
        return self.message

    def body(self) -> dict[str, object]:
        """Return the JSON body of the answer."""
        return error_body(self.error, self.message, known=self.known)


class Forbidden(Refused):
    """A ticket that is not for this."""

    status = 403


class NotFound(Refused):
    """No such session, rig, clip, muscle or route."""

    status = 404


class Conflict(Refused):
    """The thing is not in a state that allows this."""

    status = 409


class Unprocessable(Refused):
    """A body, a field or a name that cannot be used."""

    status = 422


class AtCapacity(Refused):
    """The machine sustains no more; a later attempt may succeed."""

    status = 429

    def __init__(self, error: str, message: str, *, retry_after: int) -> None:
        super().__init__(error, message)
        self.headers = {"Retry-After": str(retry_after)}


class QuotaExceeded(Refused):
    """A key has taken what it may; it has room again after `retry_after` seconds."""

    status = 429

    def __init__(self, message: str, *, retry_after: float) -> None:
        super().__init__("quota_exceeded", message)
        self.headers = {"Retry-After": str(max(1, math.ceil(retry_after)))}


class NoPictures(Refused):
    """There is no viewer or no Chromium here to draw pictures with."""

    status = 501


class Busy(Refused):
    """A limit is reached; a later attempt may succeed."""

    status = 503

    def __init__(self, error: str, message: str, *, retry_after: int = 1) -> None:
        super().__init__(error, message)
        self.headers = {"Retry-After": str(retry_after)}


def refused_by_engine(error: EngineError, *, status: int = 422) -> Refused:
    """Return the answer to an engine error: its name in snake case, its message, what is known."""
    refused: Refused
    if isinstance(error, UnknownName):
        name = f"unknown_{error.kind.replace(' ', '_').lower()}"
        refused = Refused(name, str(error), known=error.known)
    else:
        refused = Refused(_WORDS.sub("_", type(error).__name__).lower(), str(error))
    refused.status = status
    return refused


def error_body(
    error: str, message: str, *, known: Iterable[str] | None = None
) -> dict[str, object]:
    """Return the one error shape."""
    body: dict[str, object] = {"error": error, "message": message}
    if known is not None:
        body["known"] = list(known)
    return body


def json_response(
    content: Mapping[str, Any] | list[Any],
    *,
    status: int = 200,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return `content` as JSON in ASCII: a lone surrogate in a name must not break the answer.

    Raises:
        ValueError: If a number is not finite.
    """
    text = json.dumps(content, allow_nan=False, separators=(",", ":"))
    return Response(text, status, dict(headers or {}), "application/json")
