"""Who asks, and what they may see and do: a key, a ticket of one session, or anybody."""

from __future__ import annotations

from dataclasses import dataclass

from .errors import Forbidden
from .quotas import Allowance


@dataclass(frozen=True)
class Access:
    """What somebody may see and do.

    Attributes:
        client: Whom rates and retries are counted for.
        key: Name of the key whose things are seen; None sees everything.
        allowance: What that key may take; None is bounded by the service's own limits only.
        session: The only session that is seen; None sees each of the key's.
        commands: Whether faces may be moved.
        expires: When it ends, on the clock of `time.monotonic` [s]; None is never.
    """

    client: str
    key: str | None = None
    allowance: Allowance | None = None
    session: str | None = None
    commands: bool = True
    expires: float | None = None

    @property
    def role(self) -> str:
        """What a ticket of the same rights would be asked for as."""
        return "control" if self.commands else "read"

    @property
    def maker(self) -> str:
        """Name under which what is made is kept; nothing where no keys are asked for."""
        return self.key or ""

    def sees(self, maker: str, *, session: str | None = None) -> bool:
        """Return whether a thing that the key `maker` made is there for them.

        Args:
            maker: Name of a key.
            session: Its id, if it is a session.
        """
        return self.key in (None, maker) and self.session in (None, session)

    def check_commands(self) -> None:
        """Let nobody move a face who only watches.

        Raises:
            Forbidden: If they may not.
        """
        if not self.commands:
            message = "this ticket watches only; ask for one with the role 'control' to move a face"
            raise Forbidden("read_only", message)

    def check_whole(self) -> None:
        """Let nobody open or close sessions who came for one.

        Raises:
            Forbidden: If they have a ticket.
        """
        if self.session is not None:
            message = "a ticket is for one session as it stands; send a key for this"
            raise Forbidden("key_needed", message)


EVERYTHING = Access("service")
"""What the service itself may do."""


def nothing_for(client: str) -> Access:
    """Return the access of somebody of whom nothing was asked: they see nobody's things."""
    return Access(client, key="", session="", commands=False)
