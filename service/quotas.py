"""What one key may take: sessions and viewers at once, clips and uploads in an hour."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

from .errors import QuotaExceeded, Unprocessable

HOUR_SECONDS = 3600.0
_SLICE_SECONDS = 60
_SLICES = 60
"""Of an hour; what was taken leaves it with the slice that it was taken in."""


@dataclass(frozen=True)
class Quota:
    """What a key may take.

    Attributes:
        sessions: Open at once.
        viewers: Sockets open at once, on all of its sessions.
        clip_seconds: Of clips asked for in an hour.
        upload_bytes: Of request bodies in an hour.
    """

    sessions: int
    viewers: int
    clip_seconds: float
    upload_bytes: int


class HourlyUse:
    """An amount that was taken in the last hour, counted by the minute."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._slices: defaultdict[int, float] = defaultdict(float)

    @property
    def total(self) -> float:
        """What was taken in the last hour."""
        oldest = self._now() - _SLICES
        for slice_number in [number for number in self._slices if number < oldest]:
            del self._slices[slice_number]
        return sum(self._slices.values())

    def take(self, amount: float, most: float, what: str) -> None:
        """Take `amount`, if no more than `most` are taken in an hour.

        Args:
            amount: How much.
            most: The quota.
            what: The unit, as an error names it.

        Raises:
            QuotaExceeded: If there is no room now, with when there is.
            Unprocessable: If there never is.
        """
        if amount > most:
            message = f"{amount:g} {what} at once; this key may take {most:g} an hour"
            raise Unprocessable("over_quota", message)
        taken = self.total
        if taken + amount > most:
            message = (
                f"this key took {taken:g} of the {most:g} {what} that it may take an hour; "
                f"{amount:g} more have to wait"
            )
            raise QuotaExceeded(message, retry_after=self._seconds_until(most - amount))
        self._slices[self._now()] += amount

    def remember(self, amount: float, ago: float) -> None:
        """Count what was taken `ago` seconds before now, by a service that was stopped."""
        self._slices[math.floor((self._clock() - ago) / _SLICE_SECONDS)] += amount

    def _now(self) -> int:
        return math.floor(self._clock() / _SLICE_SECONDS)

    def _seconds_until(self, room: float) -> float:
        """Return the seconds until no more than `room` is counted."""
        left = self.total
        for number in sorted(self._slices):
            left -= self._slices[number]
            if left <= room:
                return (number + _SLICES + 1) * _SLICE_SECONDS - self._clock()
        return float(_SLICES * _SLICE_SECONDS)


@dataclass
class Allowance:
    """What a key may take, and what it took in the last hour."""

    quota: Quota
    clips: HourlyUse = field(default_factory=HourlyUse)
    uploads: HourlyUse = field(default_factory=HourlyUse)

    def take_clip(self, seconds: float) -> None:
        """Count a clip.

        Raises:
            QuotaExceeded: If the key has to wait.
            Unprocessable: If it is longer than an hour's quota.
        """
        self.clips.take(seconds, self.quota.clip_seconds, "seconds of clips")

    def take_upload(self, size: int) -> None:
        """Count the bytes of a request's body.

        Raises:
            QuotaExceeded: If the key has to wait.
            Unprocessable: If they are more than an hour's quota.
        """
        if size:
            self.uploads.take(size, self.quota.upload_bytes, "bytes of uploads")
