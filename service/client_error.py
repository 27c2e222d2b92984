"""What a service refused to a client, in its words."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


class ServiceError(Exception):
    """What the service refused, in its words.

    Attributes:
        status: The HTTP status; 0 if there was no answer.
        error: The error's name: "unknown_emotion".
        known: The names that would have been accepted, the nearest first.
    """

    def __init__(self, status: int, error: str, message: str, known: list[str]) -> None:
        super().__init__(message)
        self.status = status
        self.error = error
        self.known = known


def refused(status: int, content: bytes) -> ServiceError:
    """Return the error in an answer; a proxy's has another shape."""
    try:
        return said(status, json.loads(content))
    except (ValueError, KeyError, TypeError):
        return ServiceError(status, "unexpected_answer", f"the service answered {status}", [])


def said(status: int, body: Mapping[str, Any]) -> ServiceError:
    """Return the error that a body of the service's one shape says."""
    return ServiceError(status, body["error"], body["message"], body.get("known") or [])
