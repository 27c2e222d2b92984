"""What a process does that makes one thing after another for its service, until it is let go.

It reads pickled orders from standard input and answers each with the length of a pickle, eight
bytes, little endian, and the pickle: what was made, or why not.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from engine import EngineError

from .apart import orders_and_answers
from .errors import Refused, refused_by_engine
from .priority import stand_back_wholly

LENGTH_BYTES = 8


@dataclass(frozen=True)
class Made:
    """What came of an order."""

    value: Any


@dataclass(frozen=True)
class NotMade:
    """Why nothing came of it, as `Refused` tells it."""

    status: int
    error: str
    message: str
    known: tuple[str, ...] | None = None

    def refusal(self) -> Refused:
        """Return it as what the service answers."""
        refused = Refused(self.error, self.message, known=self.known)
        refused.status = self.status
        return refused


def work(make: Callable[[Any], Any]) -> None:
    """Make what is ordered until standard input ends, behind live faces."""
    stand_back_wholly()
    orders, answers = orders_and_answers()
    while True:
        try:
            order = pickle.load(orders)
        except EOFError:
            return
        data = pickle.dumps(_made(make, order))
        answers.write(len(data).to_bytes(LENGTH_BYTES, "little") + data)
        answers.flush()


def _made(make: Callable[[Any], Any], order: Any) -> Made | NotMade:
    try:
        return Made(make(order))
    except (EngineError, Refused) as error:
        refused = refused_by_engine(error) if isinstance(error, EngineError) else error
        known = None if refused.known is None else tuple(refused.known)
        return NotMade(refused.status, refused.error, refused.message, known)
