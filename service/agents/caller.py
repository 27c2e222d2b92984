"""Who calls a tool, and where from: the owner of what is written, and the service's address."""

from __future__ import annotations

import re
from dataclasses import dataclass

from engine import ANYONE

NAMELESS = "mcp"
"""Owner of what a client without a name writes."""
_LONGEST = 64


@dataclass(frozen=True)
class Caller:
    """A client, as far as it says who it is.

    Attributes:
        owner: Whose commands it sends.
        base_url: Address at which it reached the service, without a slash at its end.
    """

    owner: str
    base_url: str

    def viewer_of(self, session: str) -> str:
        """Return the address of the page that shows a session."""
        return f"{self.base_url}/?session={session}"


def owner_named(client: str | None) -> str:
    """Return the owner that a client's name makes: "Claude Desktop" is "Claude-Desktop"."""
    name = re.sub(r"[^A-Za-z0-9_.:@-]+", "-", client or "").strip("-")[:_LONGEST]
    # What is anyone's would be replaced by everybody, and replace what everybody holds.
    return NAMELESS if name in ("", ANYONE) else name
