"""Insight into faces, computed beside the simulation, and in a bounded queue."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from typing import Any, TypeVar

from engine import (
    Analysis,
    Cancelled,
    EngineError,
    Inverse,
    Model,
    Rig,
    UnitBasis,
    analyze,
    invert,
    unit_basis,
)

from .errors import Busy, refused_by_engine
from .insight_bodies import InverseRequest
from .runner import Look
from .shelf import Shelf

_BASES_IN_MEMORY = 8
Result = TypeVar("Result")


class Insight:
    """Analyses of live faces, and what they need of each rig."""

    def __init__(self, *, queue_limit: int) -> None:
        self._queue_limit = queue_limit
        self._asked = 0
        self._closing = threading.Event()
        # One thread, for what takes seconds: live faces keep the other cores.
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="insight")
        self._bases: Shelf[UnitBasis] = Shelf(_BASES_IN_MEMORY, self._pool)

    def close(self) -> None:
        """Stop at the next tick of what is being simulated."""
        self._closing.set()
        self._pool.shutdown(wait=True, cancel_futures=True)

    async def analyze(self, look: Look, *, measured: bool) -> Analysis:
        """Return what a face does inside.

        Args:
            look: The face, and what its layers hold.
            measured: Whether to measure its action units too: the first time on a rig, that takes
                as long as its units take to settle.

        Raises:
            Busy: If too much is asked for at once.
        """
        async with self._place():
            basis = None
            assembly = look.snapshot.assembly
            if measured:
                basis = await self._basis(assembly.rig, assembly.model)
            return await self._computed(
                lambda: analyze(look.snapshot, basis=basis, requested=_requested(look.report))
            )

    async def invert(self, rig: Rig, request: InverseRequest) -> Inverse:
        """Return the controls that bring landmarks nearest to their targets.

        Raises:
            Busy: If too much is asked for at once.
            Refused: If a name or a number of it cannot be used.
        """
        async with self._place():
            loop = asyncio.get_running_loop()
            try:
                return await loop.run_in_executor(
                    self._pool, lambda: inverse_of(rig, request, threads=1, progress=self._go_on)
                )
            except EngineError as error:
                raise refused_by_engine(error) from error

    async def _basis(self, rig: Rig, model: Model) -> UnitBasis:
        return await self._bases.get(
            f"{rig.id} {model}",
            lambda: unit_basis(rig, model, threads=1, progress=self._go_on),
        )

    async def _computed(self, compute: Callable[[], Result]) -> Result:
        try:
            return await asyncio.to_thread(compute)
        except EngineError as error:
            raise refused_by_engine(error) from error

    @asynccontextmanager
    async def _place(self) -> AsyncIterator[None]:
        if self._asked >= self._queue_limit:
            message = f"{self._queue_limit} analyses and inverses are under way"
            raise Busy("queue_full", message, retry_after=10)
        self._asked += 1
        try:
            yield
        finally:
            self._asked -= 1

    def _go_on(self, _share: float) -> None:
        if self._closing.is_set():
            raise Cancelled("the service stops")


def inverse_of(
    rig: Rig,
    request: InverseRequest,
    *,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Inverse:
    """Return the engine's answer to a request.

    Raises:
        EngineError: If a name or a number of it cannot be used.
    """
    return invert(
        rig,
        request.targets,
        weights=request.weights,
        muscles=request.muscles,
        units=request.action_units,
        jaw=request.jaw,
        regularization=request.regularization,
        iterations=request.iterations,
        threads=threads,
        progress=progress,
    )


def _requested(report: Mapping[str, Any]) -> dict[str, float]:
    """Return the units that a face's layers come to."""
    return dict(report["merged"]["action_units"])
