"""Tickets: short-lived leave to watch or to move one session, for sockets of browsers and links.

They are known to this process alone, by their hash: nothing of them is kept on disk, and they end
with the process at the latest.
"""

from __future__ import annotations

import hashlib
import re
import secrets
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Literal

from .access import Access
from .errors import Forbidden, QuotaExceeded

PREFIX = "rst_"
Role = Literal["read", "control"]
MAX_SECONDS = 86_400
_BYTES = 32
_MOST_OF_A_KEY = 1024
_READING = ("GET", "HEAD")
# What a page needs beside the session itself; which rig is its own, the routes know.
_READS = re.compile(
    r"/api/(people|emotions|maps/[^/]+|rigs/[^/]+(/(surface|tissue)\.glb|/textures/[^/]+)?)"
)


@dataclass(frozen=True)
class Ticket:
    """Leave to use one session.

    Attributes:
        session: Its id.
        key: Name of the key that made it, None where none was asked for.
        role: `read` watches, `control` moves the face too.
        expires: When it ends, on the clock of the tickets [s].
    """

    session: str
    key: str | None
    role: Role
    expires: float


class Tickets:
    """The tickets that are not over."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._tickets: dict[bytes, Ticket] = {}
        self._of_pages: dict[tuple[str, str | None], str] = {}

    def of_page(self, session: str, *, key: str | None) -> str:
        """Return a ticket with which a page shows and moves a session for half a day at least.

        It is the one that was returned before, where that lasts as long: whoever asks for the
        address again and again takes no more than one of the tickets that a key may have.

        Raises:
            QuotaExceeded: If the key has as many as are kept.
        """
        token = self._of_pages.get((session, key))
        ticket = None if token is None else self.find(token)
        if token is None or ticket is None or ticket.expires - self._clock() < MAX_SECONDS / 2:
            token = self.issue(session, key=key, role="control", seconds=MAX_SECONDS)
            self._of_pages = {w: t for w, t in self._of_pages.items() if self.find(t) is not None}
            self._of_pages[session, key] = token
        return token

    def end_of(self, keys: Collection[str]) -> None:
        """End the tickets of keys that are no more; a new key of the name has none of them.

        Args:
            keys: Their names, empty for those that needed none.
        """
        self._tickets = {
            d: each for d, each in self._tickets.items() if (each.key or "") not in keys
        }

    def issue(self, session: str, *, key: str | None, role: Role, seconds: float) -> str:
        """Make a ticket.

        Args:
            session: Id of the session that it is for.
            key: Name of the key that asks.
            role: What it allows.
            seconds: How long it lasts.

        Raises:
            QuotaExceeded: If the key has as many as are kept.
        """
        now = self._clock()
        self._tickets = {d: ticket for d, ticket in self._tickets.items() if ticket.expires > now}
        others = [ticket.expires for ticket in self._tickets.values() if ticket.key == key]
        if len(others) >= _MOST_OF_A_KEY:
            message = f"{len(others)} tickets are not over yet; at most {_MOST_OF_A_KEY} are kept"
            raise QuotaExceeded(message, retry_after=min(others) - now)
        token = PREFIX + secrets.token_hex(_BYTES)
        self._tickets[_digest(token)] = Ticket(session, key, role, now + seconds)
        return token

    def find(self, token: str) -> Ticket | None:
        """Return a ticket, None if there is none or it is over."""
        ticket = self._tickets.get(_digest(token))
        return ticket if ticket is not None and ticket.expires > self._clock() else None


def check_reach(access: Access, method: str, path: str) -> None:
    """Let a ticket through where it leads: to its session, and to what shows it.

    Args:
        access: Of the ticket.
        method: Of the request; sockets count as reading, and obey commands by role.
        path: Of the request.

    Raises:
        Forbidden: If it does not lead there.
    """
    own = f"/api/sessions/{access.session}"
    reads = method in _READING
    if path in (own, f"{own}.glb") or path.startswith(f"{own}/"):
        if not reads:
            access.check_commands()
        if not reads and path in (own, f"{own}/tickets"):
            access.check_whole()
        return
    if reads and _READS.fullmatch(path):
        return
    raise Forbidden("other_session", "this ticket is for another address; send a key for this one")


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()
