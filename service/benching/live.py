"""How long a command takes through the service's runner, with faces awake at 60 Hz."""

from __future__ import annotations

import asyncio
import random
import time
from contextlib import suppress
from typing import Any

import numpy as np

from engine import Model, Rig, Simulator, Timeline

from ..embedded import EmbeddedRunner
from .motion import Motion

FACES = (1, 16, 64)
_TICK_SECONDS = 1.0 / Simulator.TICKS_PER_SECOND
_SETTLED_TICKS = 15
"""Ticks before the first command that counts."""


def measure_latencies(rig: Rig, *, commands: int) -> list[dict[str, Any]]:
    """Return how long commands take, one row a number of faces.

    Args:
        rig: Of all faces.
        commands: How many are timed for each row.
    """
    return [asyncio.run(_latencies(rig, faces, commands)) for faces in FACES]


class _Watch:
    """The newest tick of one face, and when it came."""

    def __init__(self, runner: EmbeddedRunner, face: str) -> None:
        self._runner, self._face = runner, face
        self._tick, self._came = -1, 0.0
        self._news = asyncio.Event()

    async def run(self) -> None:
        """Take what the runner hands out, as the service does."""
        async for tick in self._runner.ticks():
            frame = tick.frames.get(self._face)
            if frame is not None:
                self._tick, self._came = frame.tick, time.perf_counter()
                self._news.set()

    async def after(self, tick: int) -> float:
        """Return when the first frame after `tick` came."""
        while self._tick <= tick:
            self._news.clear()
            await self._news.wait()
        return self._came


async def _latencies(rig: Rig, faces: int, commands: int) -> dict[str, Any]:
    runner, model, motion = (
        EmbeddedRunner(),
        Model.for_rig(rig, integrator="verlet"),
        Motion(rig, 1),
    )
    runner.start()
    names = [f"face {number}" for number in range(faces)]
    watch = _Watch(runner, names[0])
    tasks = []
    try:
        for name in names:
            await runner.open(name, rig, Timeline((), 1.0), model)
        tasks = [
            asyncio.create_task(watch.run()),
            asyncio.create_task(_keep_moving(runner, rig, names)),
        ]
        await asyncio.sleep(_SETTLED_TICKS * _TICK_SECONDS)
        counters = runner.counters
        ticks, late, busy = counters.ticks, counters.overruns, counters.busy_seconds
        started = time.perf_counter()
        answered, seen = [], []
        chance = random.Random(1)
        mixes = [keyframe for tick in range(0, 512 * 15, 15) for _, keyframe in motion.due(tick)]
        for number in range(commands):
            await asyncio.sleep(chance.uniform(0.5, 2.0) * _TICK_SECONDS)
            sent = time.perf_counter()
            tick = await runner.apply(names[0], mixes[number % len(mixes)])
            answered.append(time.perf_counter() - sent)
            seen.append(await watch.after(tick) - sent)
        took = time.perf_counter() - started
        return {
            "faces": faces,
            "commands": commands,
            **spread("answered", answered),
            **spread("seen", seen),
            "ticks": counters.ticks - ticks,
            "late_ticks": counters.overruns - late,
            "busy_percent": round(100 * (counters.busy_seconds - busy) / took, 1),
        }
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task
        await asyncio.to_thread(runner.stop)


async def _keep_moving(runner: EmbeddedRunner, rig: Rig, names: list[str]) -> None:
    """Command every face but the first in turn, so that none falls asleep."""
    motion, tick = Motion(rig, len(names)), 0
    while True:
        due = (runner.apply(names[face], keyframe) for face, keyframe in motion.due(tick) if face)
        await asyncio.gather(*due)
        await asyncio.sleep(_TICK_SECONDS)
        tick += 1


def spread(name: str, seconds: list[float]) -> dict[str, float]:
    """Return median and 99th percentile of durations [s], in ms, named after what they are of."""
    median, rare = (1000 * float(np.percentile(seconds, share)) for share in (50, 99))
    return {f"{name}_median_ms": round(median, 1), f"{name}_p99_ms": round(rare, 1)}
