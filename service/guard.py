"""Who may speak to the service: host names, origins, keys, rates and body sizes.

One ASGI middleware in front of every route and socket, the viewer's files included. A browser
sends Host and Origin by itself, so a foreign web page cannot drive a local face, and a foreign
name that points to this address (DNS rebinding) is not answered.
"""

from __future__ import annotations

import re
import time
from collections import OrderedDict
from collections.abc import Callable

from starlette.datastructures import Headers, QueryParams
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .access import Access, nothing_for
from .errors import Refused, json_response
from .keys import KeyRing
from .settings import Settings
from .tickets import PREFIX as TICKET
from .tickets import Tickets, check_reach
from .uploads import SenderGone, Upload, Uploads, is_upload

# A browser cannot set headers on a socket: it offers its key or ticket as a second subprotocol.
KEY_SUBPROTOCOL = "risorius.key."
_LOOPBACK = ("localhost", "127.0.0.1", "::1")
_WILDCARD = ("0.0.0.0", "::")
_OPEN_PATHS = ("/api/health", "/api/ready")
# All that is not a file of the viewer.
_KEY_PATHS = ("/api", "/metrics", "/openapi.json", "/docs", "/mcp")
_CLIENTS_REMEMBERED = 4096
_HOST = re.compile(r"(?:\[(?P<ipv6>[0-9a-f:.]+)\]|(?P<name>[a-z0-9._-]+))(?::\d{1,5})?")


class Denied(Refused):
    """A request that the guard turns away."""

    def __init__(self, status: int, error: str, message: str) -> None:
        super().__init__(error, message)
        self.status = status


class RateLimit:
    """A token bucket for each client: bursts of two seconds' worth."""

    def __init__(self, per_second: float) -> None:
        self.per_second = per_second
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def allow(self, client: str) -> bool:
        """Take one token of `client`; False when there is none left."""
        now = time.monotonic()
        burst = max(1.0, 2.0 * self.per_second)
        tokens, since = self._buckets.get(client, (burst, now))
        tokens = min(burst, tokens + (now - since) * self.per_second)
        allowed = tokens >= 1.0
        self._buckets[client] = (tokens - 1.0 if allowed else tokens, now)
        self._buckets.move_to_end(client)
        if len(self._buckets) > _CLIENTS_REMEMBERED:
            self._buckets.popitem(last=False)
        return allowed


class Guard:
    """The middleware; everything behind it may trust host, origin, access and body size.

    It leaves who asks in the scope: `risorius.client`, and `risorius.access`, by which the parts of
    the service show each caller what is theirs; and `risorius.upload`, a body that is on disk.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        settings: Settings,
        rate: RateLimit,
        keys: KeyRing,
        tickets: Tickets,
        uploads: Uploads,
    ) -> None:
        self.app = app
        self.settings = settings
        self.rate = rate
        self.keys = keys
        self.tickets = tickets
        self.uploads = uploads
        hosts = [*_LOOPBACK, *settings.allowed_hosts]
        if settings.host not in _WILDCARD:
            hosts.append(settings.host)
        self.hosts = frozenset(host.lower() for host in hosts)
        self.origins = frozenset(origin.lower().rstrip("/") for origin in settings.allowed_origins)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or turn it away."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        upload: Upload | None = None
        try:
            self._admit(scope)
            if scope["type"] == "http" and is_upload(scope):
                upload = await self.uploads.take_in(scope, receive, _payment(scope))
                scope["risorius.upload"], receive = upload, _replay(b"", receive)
            elif scope["type"] == "http":
                receive = await self._read_body(scope, receive)
        except Refused as refused:
            await _turn_away(refused, scope, receive, send)
            return
        except SenderGone:
            return
        try:
            await self.app(scope, receive, send)
        finally:
            if upload is not None:
                await self.uploads.let_go(upload)

    def _admit(self, scope: Scope) -> None:
        headers = Headers(scope=scope)
        # Two Host headers are nobody's: a proxy and this service might each believe another one.
        host = ", ".join(headers.getlist("host"))
        if _host_name(host) not in self.hosts:
            raise Denied(
                421,
                "unknown_host",
                f"this service does not answer for the host {host!r}; set RISORIUS_ALLOWED_HOSTS",
            )
        for origin in headers.getlist("origin"):
            if not self._own_origin(origin, host):
                raise Denied(
                    403,
                    "forbidden_origin",
                    f"pages of {origin!r} may not use this service; set RISORIUS_ALLOWED_ORIGINS",
                )
        access = self._identify(scope, headers)
        self._allow(access.client)
        scope["risorius.client"] = access.client
        scope["risorius.access"] = access

    def _allow(self, client: str) -> None:
        if not self.rate.allow(client):
            denied = Denied(429, "too_many_requests", "too many requests; try again in a second")
            denied.headers["Retry-After"] = "1"
            raise denied

    def _own_origin(self, origin: str, host: str) -> bool:
        origin = origin.lower()
        return origin in self.origins or (
            origin.startswith(("http://", "https://")) and origin.split("//", 1)[1] == host.lower()
        )

    def _identify(self, scope: Scope, headers: Headers) -> Access:
        """Return what somebody may do: by a ticket, by a key, or by being here.

        Raises:
            Denied: If a key is asked for and none is sent, or a ticket is over.
            Forbidden: If a ticket does not lead there.
        """
        client = scope.get("client")
        address = str(client[0]) if client else "local"
        path = str(scope["path"])
        if not path.startswith(_KEY_PATHS) or path in _OPEN_PATHS:
            return nothing_for(address)
        offered = _offered(headers) or _offered_ticket(scope)
        if offered.startswith(TICKET):
            return self._by_ticket(offered, scope, address)
        if not self.keys.required:
            return Access(address)
        if scope.get("method") == "OPTIONS":
            return nothing_for(address)  # A browser's preflight question carries no key.
        name = self.keys.find(offered)
        if name is None:
            raise self._unauthorized(
                address, "send a key as 'Authorization: Bearer …' or 'X-API-Key: …'"
            )
        return Access(f"key {name}", name, self.keys.allowance(name))

    def _by_ticket(self, offered: str, scope: Scope, address: str) -> Access:
        ticket = self.tickets.find(offered)
        allowance = (
            None if ticket is None or ticket.key is None else self.keys.allowance(ticket.key)
        )
        # A ticket ends with its key, and one that needed none with the first key.
        if ticket is None or (allowance is None and self.keys.required):
            raise self._unauthorized(
                address, "this ticket is not or no longer valid; ask for another one"
            )
        access = Access(
            f"ticket {offered[-16:]}",
            ticket.key,
            allowance,
            ticket.session,
            ticket.role == "control",
            ticket.expires,
        )
        check_reach(access, str(scope.get("method", "GET")), str(scope["path"]))
        return access

    def _unauthorized(self, address: str, message: str) -> Denied:
        """Return the answer to somebody unknown, whose guesses count as requests.

        Raises:
            Denied: If there were too many.
        """
        self._allow(f"guesses from {address}")
        denied = Denied(401, "unauthorized", message)
        denied.headers["WWW-Authenticate"] = "Bearer"
        return denied

    async def _read_body(self, scope: Scope, receive: Receive) -> Receive:
        """Read the whole body within the limit and return a `receive` that hands it on."""
        limit = self.settings.max_body_bytes
        too_large = Denied(413, "body_too_large", f"a request body has at most {limit} bytes")
        length = Headers(scope=scope).get("content-length", "0")
        if not length.isdecimal() or len(length) > 18 or int(length) > limit:
            raise too_large
        pay = _payment(scope)
        pay(int(length))
        body = bytearray()
        while True:
            message = await receive()
            if message["type"] != "http.request":
                raise SenderGone  # Half of a body may read as a whole one.
            body += message.get("body", b"")
            if len(body) > limit:
                raise too_large
            if not message.get("more_body", False):
                break
        pay(max(0, len(body) - int(length)))
        return _replay(bytes(body), receive)


def _payment(scope: Scope) -> Callable[[int], None]:
    """Return what counts the bytes of a body for whoever sends it."""
    access: Access = scope["risorius.access"]
    return _free if access.allowance is None else access.allowance.take_upload


def _free(_size: int) -> None:
    """Count nothing: who needs no key has no quota."""


def _replay(body: bytes, receive: Receive) -> Receive:
    """Return a `receive` that gives `body` once, then whatever comes after it."""
    given = False

    async def replayed() -> Message:
        nonlocal given
        if given:
            return await receive()
        given = True
        return {"type": "http.request", "body": body, "more_body": False}

    return replayed


def _host_name(host: str) -> str:
    """Return the name in a Host header without its port, or nothing if it is malformed."""
    match = _HOST.fullmatch(host.lower())
    return (match["ipv6"] or match["name"]) if match else ""


def _offered_ticket(scope: Scope) -> str:
    """Return the ticket in the address, for links and for sockets of browsers."""
    query = scope.get("query_string", b"")
    if b"ticket=" not in query:
        return ""
    ticket = QueryParams(query).get("ticket", "")
    return ticket if ticket.startswith(TICKET) else ""


def _offered(headers: Headers) -> str:
    """Return the key or ticket in the headers."""
    scheme, _, token = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return token.strip()
    for protocol in headers.get("sec-websocket-protocol", "").split(","):
        if protocol.strip().startswith(KEY_SUBPROTOCOL):
            return protocol.strip().removeprefix(KEY_SUBPROTOCOL)
    return headers.get("x-api-key", "")


async def _turn_away(refused: Refused, scope: Scope, receive: Receive, send: Send) -> None:
    response = json_response(refused.body(), status=refused.status, headers=refused.headers)
    if scope["type"] == "http":
        await response(scope, receive, send)
    elif "websocket.http.response" in scope.get("extensions", {}):
        await _deny_handshake(
            response.status_code, response.raw_headers, bytes(response.body), send
        )
    else:
        await send({"type": "websocket.close", "code": 1008, "reason": refused.error})


async def _deny_handshake(
    status: int, headers: list[tuple[bytes, bytes]], body: bytes, send: Send
) -> None:
    await send({"type": "websocket.http.response.start", "status": status, "headers": headers})
    await send({"type": "websocket.http.response.body", "body": body})
