"""What a key may take in an hour: never more, and there is room when it is said to be."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.errors import QuotaExceeded, Unprocessable
from service.quotas import HourlyUse

MOST = 100.0
HOUR = 3600.0
QUARTERS = st.integers(0, 4000).map(lambda quarters: quarters / 4)
"""Seconds that add up exactly."""


class Clock:
    """A clock that goes when it is told to."""

    def __init__(self, now: float) -> None:
        self.now = now

    def __call__(self) -> float:
        return self.now


@given(
    start=st.floats(0, 1e6),
    steps=st.lists(st.tuples(st.floats(0, 2000), st.integers(1, 100)), max_size=60),
)
def test_no_hour_has_more_than_the_quota(start: float, steps: list[tuple[float, int]]) -> None:
    clock = Clock(start)
    use, taken = HourlyUse(clock), []
    for pause, amount in steps:
        clock.now += pause
        try:
            use.take(amount, MOST, "things")
        except QuotaExceeded:
            continue
        taken.append((clock.now, amount))
        assert sum(a for when, a in taken if clock.now - when < HOUR) <= MOST


@given(
    start=QUARTERS,
    before=st.lists(st.tuples(QUARTERS, st.integers(1, 60)), min_size=2, max_size=20),
    amount=st.integers(1, 100),
)
def test_there_is_room_when_it_is_said_to_be_and_not_before(
    start: float, before: list[tuple[float, int]], amount: int
) -> None:
    clock = Clock(start)
    use = HourlyUse(clock)
    for pause, earlier in before:
        clock.now += pause
        try:
            use.take(earlier, MOST, "things")
        except QuotaExceeded:
            continue
    try:
        use.take(amount, MOST, "things")
    except QuotaExceeded as refused:
        wait = int(refused.headers["Retry-After"])
        assert 1 <= wait <= HOUR + 60
        clock.now += wait - 1
        if wait > 1:
            with pytest.raises(QuotaExceeded):
                use.take(amount, MOST, "things")
        clock.now += 1
        use.take(amount, MOST, "things")


def test_what_never_fits_is_not_put_off() -> None:
    use = HourlyUse()
    with pytest.raises(Unprocessable, match="100 an hour"):
        use.take(101, MOST, "things")
    use.take(100, MOST, "things")


def test_what_an_earlier_service_took_counts() -> None:
    clock = Clock(10_000.0)
    use = HourlyUse(clock)
    use.remember(90, ago=3000.0)
    use.remember(90, ago=5000.0)
    with pytest.raises(QuotaExceeded, match="90 of the 100 things") as refused:
        use.take(20, MOST, "things")
    assert 600 <= int(refused.value.headers["Retry-After"]) <= 660
