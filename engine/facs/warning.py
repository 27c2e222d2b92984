"""What is said of units that are played otherwise than they were written, or not at all."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FacsWarning:
    """One thing to know about a command, under the rule that it comes from.

    Attributes:
        rule: Name of the rule, in snake case.
        units: Keys of the units it is about: "AU12", "L12".
        message: What was given and what becomes of it, without a full stop.
    """

    rule: str
    units: tuple[str, ...]
    message: str

    def __str__(self) -> str:
        """Return the message and its rule, as one line."""
        return f"{self.message} (rule {self.rule})"
