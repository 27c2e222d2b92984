"""A clip on its way: who works on it, how far that is, and who wants to be told."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field


@dataclass(eq=False)
class ClipJob:
    """A clip on its way.

    Attributes:
        task: Renders it.
        progress: Share of the work that is done.
        news: Set once this is no longer how far it is; another one then takes its place.
        watchers: Streams of events that tell somebody.
    """

    task: asyncio.Task[None] | None = None
    progress: float = 0.0
    news: asyncio.Event = field(default_factory=asyncio.Event)
    watchers: int = 0

    def show(self, share: float) -> None:
        """Take the share of the work that is done."""
        self.progress = share
        self.tell()

    def tell(self) -> None:
        """Wake everybody who waits for news."""
        news, self.news = self.news, asyncio.Event()
        news.set()
