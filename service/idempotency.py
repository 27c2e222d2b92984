"""Safe retries: a POST with an Idempotency-Key that was answered before gets that answer again."""

from __future__ import annotations

import asyncio
import hashlib
from collections import OrderedDict
from dataclasses import dataclass, field

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .errors import error_body, json_response
from .uploads import Upload

_KEY_LENGTH_LIMIT = 255
_ANSWERS_KEPT = 1024
_BYTES_KEPT = 64_000_000


@dataclass(eq=False)
class _Answer:
    """The messages of one answer; `done` is set once they are complete."""

    fingerprint: str
    messages: list[Message] = field(default_factory=list)
    done: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def size(self) -> int:
        return sum(len(message.get("body", b"")) for message in self.messages)

    @property
    def repeatable(self) -> bool:
        """Whether a retry should get it: complete, and not a failure that a retry may mend."""
        return bool(self.messages) and self.messages[0].get("status", 500) not in {
            401,
            429,
            *range(500, 600),
        }


class Idempotency:
    """The middleware; it stands behind `Guard`, which has bounded the body."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._answers: OrderedDict[tuple[str, str, str], _Answer] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer from memory, or pass on and remember."""
        key = Headers(scope=scope).get("idempotency-key") if scope["type"] == "http" else None
        if key is None or scope["method"] != "POST":
            await self.app(scope, receive, send)
            return
        if not 0 < len(key) <= _KEY_LENGTH_LIMIT:
            message = f"an Idempotency-Key has 1 to {_KEY_LENGTH_LIMIT} characters"
            await json_response(error_body("invalid_idempotency_key", message), status=422)(
                scope, receive, send
            )
            return
        await self._once(key, scope, receive, send)

    async def _once(self, key: str, scope: Scope, receive: Receive, send: Send) -> None:
        request = await receive()
        fingerprint = _fingerprint(scope, request)
        place = (str(scope.get("risorius.client", "")), str(scope["path"]), key)
        answer = self._answers.get(place)
        while answer is not None:
            if answer.fingerprint != fingerprint:
                message = "this Idempotency-Key was used for another request to the same route"
                response = json_response(error_body("idempotency_conflict", message), status=409)
                await response(scope, receive, send)
                return
            await answer.done.wait()
            if answer.repeatable:
                for message_sent in answer.messages:
                    await send(message_sent)
                return
            answer = self._answers.get(place)
        answer = self._answers[place] = _Answer(fingerprint)
        await self._record(place, answer, scope, request, receive, send)

    async def _record(
        self,
        place: tuple[str, str, str],
        answer: _Answer,
        scope: Scope,
        request: Message,
        receive: Receive,
        send: Send,
    ) -> None:
        given = False

        async def replayed() -> Message:
            nonlocal given
            if given:
                return await receive()
            given = True
            return request

        async def remembered(message: Message) -> None:
            answer.messages.append(message)
            await send(message)

        try:
            await self.app(scope, replayed, remembered)
        except BaseException:
            answer.messages.clear()
            raise
        finally:
            if not answer.repeatable:
                del self._answers[place]
            answer.done.set()
            self._forget()

    def _forget(self) -> None:
        """Drop the oldest complete answers beyond the limits."""
        size = sum(answer.size for answer in self._answers.values())
        for place, answer in list(self._answers.items()):
            if len(self._answers) <= _ANSWERS_KEPT and size <= _BYTES_KEPT:
                return
            if answer.done.is_set():
                size -= answer.size
                del self._answers[place]


def _fingerprint(scope: Scope, request: Message) -> str:
    digest = hashlib.sha256(scope.get("query_string", b""))
    digest.update(b"\0" + Headers(scope=scope).get("content-type", "").encode("latin-1"))
    upload: Upload | None = scope.get("risorius.upload")
    body = bytes(request.get("body", b"")) if upload is None else upload.digest.encode()
    digest.update(b"\0" + body)
    return digest.hexdigest()
