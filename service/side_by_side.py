"""Work in processes side by side, for the command line."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import TypeVar

Given = TypeVar("Given")
Got = TypeVar("Got")


def side_by_side(
    make: Callable[[Given], Got], work: Iterable[Given], *, jobs: int
) -> Iterator[tuple[int, Got | BrokenProcessPool]]:
    """Yield the number of each piece of work and what `make` returns of it, in processes.

    Args:
        make: A function that can be pickled.
        work: What it is called with.
        jobs: How many at a time.
    """
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        numbers = {pool.submit(make, piece): number for number, piece in enumerate(work)}
        try:
            for done in as_completed(numbers):
                try:
                    yield numbers[done], done.result()
                except BrokenProcessPool as broken:
                    yield numbers[done], broken
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def usual_jobs() -> int:
    """Return how many files are made at a time: one a core that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
