"""Insight into faces, computed beside the simulation, and in a bounded queue."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

import structlog

from engine import (
    Analysis,
    Cancelled,
    EngineError,
    Inverse,
    Model,
    Response,
    Rig,
    UnitBasis,
    analyze,
    invert,
    question_of,
    response_of,
    search_for,
    unit_basis,
)

from .errors import Busy, refused_by_engine
from .insight_bodies import InverseRequest
from .latest_first import LatestFirst
from .priority import AWAITED, background_pool
from .runner import Look
from .shelf import Shelf

_LOG = structlog.get_logger("service")
_BASES_IN_MEMORY = 8
_BASES_WAITING = 4
_RESPONSES_IN_MEMORY = 4
_RETRY_SECONDS = 2
_THREADS = max(1, (os.cpu_count() or 2) - 1)
"""Cores that settle a rig's units: live faces keep one, and go first on the others."""
Result = TypeVar("Result")
Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Insights:
    """What could be said of a face in the time that was given.

    Attributes:
        analysis: Without measured units while those of its rig are not known.
        measuring: Share of the work on them that is done, 0 to 1; None where nothing is awaited.
    """

    analysis: Analysis
    measuring: float | None


class Insight:
    """Analyses of live faces, and what they need of each rig."""

    def __init__(self, *, queue_limit: int) -> None:
        self._queue_limit = queue_limit
        self._asked = 0
        self._closing = threading.Event()
        self._pool = background_pool(1, "insight")
        # Beside it: an analysis takes a tenth of a second, an inverse some seconds.
        self._analyses = background_pool(1, "analysis", steps=AWAITED)
        self._measuring = LatestFirst("measuring", most=_BASES_WAITING)
        self._bases: Shelf[UnitBasis] = Shelf(_BASES_IN_MEMORY, self._measuring)
        self._responses: Shelf[Response] = Shelf(_RESPONSES_IN_MEMORY, self._measuring)
        self._shares: dict[str, float] = {}

    def close(self) -> None:
        """Stop at the next tick of what is being simulated."""
        self._closing.set()
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._analyses.shutdown(wait=True, cancel_futures=True)
        self._measuring.shutdown(wait=True, cancel_futures=True)

    async def analyze(self, look: Look, *, measured: bool, wait: float = 0.0) -> Insights:
        """Return what a face does inside.

        Its action units are measured by what each unit of its rig looks like. Where nobody has
        asked for that before, it is worked out beside the live faces, and left out until then.

        Args:
            look: The face, and what its layers hold.
            measured: Whether to measure its action units too.
            wait: Seconds to wait for what each unit looks like.

        Raises:
            Busy: If too much is asked for at once.
        """
        async with self._place():
            basis, share = None, None
            assembly = look.snapshot.assembly
            if measured:
                basis, share = await self._basis(assembly.rig, assembly.model, wait)
            analysis = await self._computed(
                lambda: analyze(look.snapshot, basis=basis, requested=_requested(look.report))
            )
            return Insights(analysis, share)

    async def invert(self, rig: Rig, request: InverseRequest, *, wait: float) -> Inverse:
        """Return the controls that bring landmarks nearest to their targets.

        Where nobody has asked that of the rig before, how it answers each muscle is worked out
        beside the live faces first.

        Args:
            rig: Whose face.
            request: What is asked; it is checked before anything is waited for.
            wait: Seconds to wait for how the rig answers each muscle.

        Raises:
            Busy: If too much is asked for at once, or that is not known by then.
            Refused: If a name or a number of it cannot be used.
        """
        async with self._place():
            try:
                question = question_of(rig, request.targets, **_settings_of(request))
                response = await self._response(rig, wait)
                return await asyncio.get_running_loop().run_in_executor(
                    self._pool,
                    lambda: search_for(rig, question, response, threads=1, progress=self._go_on),
                )
            except EngineError as error:
                raise refused_by_engine(error) from error

    async def _response(self, rig: Rig, wait: float) -> Response:
        """Return how a rig answers each muscle.

        Raises:
            Busy: If it is not known by then.
        """
        begun = self._by_then(
            self._responses,
            f"response {rig.id}",
            lambda go_on: response_of(rig, threads=_THREADS, progress=go_on),
            wait,
        )
        response, share = await begun
        if response is None:
            message = (
                "how this rig answers each of its muscles is being worked out, once for each rig, "
                f"and {share or 0.0:.0%} of it is done; ask again, or with ?wait=60"
            )
            raise Busy("rig_being_measured", message, retry_after=_RETRY_SECONDS)
        return response

    async def _basis(
        self, rig: Rig, model: Model, wait: float
    ) -> tuple[UnitBasis | None, float | None]:
        """Return the fields of a rig's units, or the share of them that is done by then."""
        key = f"units {rig.id} {model}"
        return await self._by_then(
            self._bases,
            key,
            lambda go_on: unit_basis(rig, model, threads=_THREADS, progress=go_on),
            wait,
        )

    async def _by_then(
        self, shelf: Shelf[Result], key: str, make: Callable[[Progress], Result], wait: float
    ) -> tuple[Result | None, float | None]:
        """Return what is worked out once for each rig, or the share of it that is done by then."""
        task = shelf.begin(key, lambda: self._made(key, make))
        await asyncio.wait({task}, timeout=wait)
        if task.done() and not task.cancelled():
            return task.result(), None
        return None, self._shares.get(key, 0.0)

    def _made(self, key: str, make: Callable[[Progress], Result]) -> Result:
        def go_on(share: float) -> None:
            self._shares[key] = share
            self._go_on(share)

        try:
            return make(go_on)
        except EngineError:
            raise
        except Exception:
            _LOG.exception("a rig could not be measured", what=key)
            raise
        finally:
            self._shares.pop(key, None)

    async def _computed(self, compute: Callable[[], Result]) -> Result:
        try:
            return await asyncio.get_running_loop().run_in_executor(self._analyses, compute)
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
    progress: Callable[[float], None] | None = None,
) -> Inverse:
    """Return the engine's answer to a request.

    Raises:
        EngineError: If a name or a number of it cannot be used.
    """
    return invert(rig, request.targets, **_settings_of(request), progress=progress)


def _settings_of(request: InverseRequest) -> dict[str, Any]:
    """Return what a request says besides its targets, as the engine calls it."""
    return {
        "weights": request.weights,
        "muscles": request.muscles,
        "units": request.action_units,
        "jaw": request.jaw,
        "regularization": request.regularization,
        "iterations": request.iterations,
    }


def _requested(report: Mapping[str, Any]) -> dict[str, float]:
    """Return the units that a face's layers come to."""
    return dict(report["merged"]["action_units"])
