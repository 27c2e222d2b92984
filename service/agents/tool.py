"""A tool: what it is called, takes, answers and does."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel

from ..bodies import Body
from ..components import Components
from .caller import Caller

Run = Callable[[Any, Components, Caller], Awaitable[BaseModel]]


@dataclass(frozen=True)
class Tool:
    """One tool.

    Attributes:
        name: "set_emotion".
        title: For people.
        description: For a model: what it does, when to call it, and what with.
        asks: What it takes.
        answers: What it answers.
        run: Does it; raises what the API raises.
        reads_only: Whether it leaves everything as it is.
        repeats: Whether the same call again changes nothing more.
    """

    name: str
    title: str
    description: str
    asks: type[Body]
    answers: type[BaseModel]
    run: Run
    reads_only: bool = False
    repeats: bool = False
