"""Processes that work beside live faces, held while a tick is stepped and let go in the gap.

However far a process stands back, on another core it still takes memory, cache and clock from the
tick: one clip being rendered makes ticks a fifth longer, and late where faces fill most of them.
Linux stops and continues processes by file descriptors of theirs; elsewhere none is held.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress

_LEAST_SHARE = 0.05
"""Of the time, that whoever is held runs all the same: what somebody waits for has to end."""
_OWED_SECONDS = 0.05
"""Of that share, after which a tick is stepped beside them: where no gap is left that is after a
second, and then three times a second."""


class Bystanders:
    """Processes at work: whoever starts one adds it, and the simulation thread holds them."""

    def __init__(self, now: Callable[[], float] = time.perf_counter) -> None:
        self._now = now
        self._working: dict[int, int] = {}
        self._lock = threading.Lock()
        self._held = False
        self._changed = now()
        self._owed = 0.0

    def add(self, process: int) -> None:
        """Hold a process from the next tick on.

        Args:
            process: Its id; a child of this process that nobody has waited for yet.
        """
        if not hasattr(os, "pidfd_open"):
            return
        with suppress(OSError), self._lock:
            self._working[process] = os.pidfd_open(process)

    def remove(self, process: int) -> None:
        """Hold a process no more; it runs, if it is there still."""
        with self._lock:
            handle = self._working.pop(process, None)
            if handle is not None:
                _send(handle, signal.SIGCONT)
                os.close(handle)

    def hold(self) -> None:
        """Have every one wait, unless they have not run for long."""
        if not self._working:
            self._owed = 0.0
            return
        now = self._now()
        self._owed = max(0.0, self._owed - (now - self._changed))
        self._changed = now
        if self._owed > _OWED_SECONDS:
            return
        with self._lock:
            self._held = True
            for handle in self._working.values():
                _send(handle, signal.SIGSTOP)

    def let_go(self) -> None:
        """Have every one go on."""
        if not self._held:
            return
        now = self._now()
        self._owed += _LEAST_SHARE * (now - self._changed)
        self._changed = now
        with self._lock:
            self._held = False
            for handle in self._working.values():
                _send(handle, signal.SIGCONT)


def _send(handle: int, what: signal.Signals) -> None:
    with suppress(OSError):  # It has ended.
        signal.pidfd_send_signal(handle, what)
