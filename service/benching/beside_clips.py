"""Whether live faces feel clips: ticks that are late without any, and beside some being rendered.

Through a service in a process of its own, with sessions that move. Both are measured by turns, so
that what else the machine does falls on both.
"""

from __future__ import annotations

import asyncio
import statistics
import time
from typing import Any, NamedTuple

from ..soak_client import Client, SoakRefused, own_service
from .company import OTHERS, TURN_SECONDS, keep_moving, opened

CLIPS = 4
"""Clips that are rendered at the same time, each in a process of its own."""
_CLIP = {
    "timeline": [{"time": 0.5 * i, "action_units": {"AU12": float(i % 2)}} for i in range(200)],
    "duration": 100.0,
    "textures": False,
}
"""Longer than any turn: it is rendered throughout."""
_SETTLED_TURNS = 3
"""Before anything counts: the first ticks of new faces do what later ones need not."""
_LONGEST_SECONDS = 300.0


class _Turn(NamedTuple):
    """What was counted in one turn.

    Attributes:
        ticks, late: Of the simulation.
        tick, lateness, loop: 99th percentiles of a tick's time, of how late it ended, and of how
            late the event loop woke [s].
    """

    ticks: int
    late: int
    tick: float
    lateness: float
    loop: float


def measure_beside_clips(*, seconds: float, turns: int) -> dict[str, Any]:
    """Return how late ticks are without clips, and beside clips that are being rendered.

    Args:
        seconds: Of each turn.
        turns: Of each of both.

    Raises:
        SoakRefused: If the service does not start, or does not render.
    """
    with own_service({"RISORIUS_RENDER_PROCESSES": str(CLIPS)}) as url:
        return asyncio.run(_measured(url, seconds, turns))


async def _measured(url: str, seconds: float, turns: int) -> dict[str, Any]:
    client = Client(url)
    counted: dict[str, list[_Turn]] = {"without clips": [], f"beside {CLIPS} clips": []}
    alone, beside = counted.values()
    try:
        await client.until_ready()
        faces = [await opened(client) for _ in range(OTHERS)]
        moving = asyncio.create_task(keep_moving(client, faces))
        try:
            await asyncio.sleep(_SETTLED_TURNS * TURN_SECONDS)
            for _ in range(turns):
                alone.append(await _turn(client, seconds))
                clips = await _rendering(client)
                beside.append(await _turn(client, seconds))
                await _ended(client, clips)
        finally:
            moving.cancel()
            await asyncio.gather(moving, return_exceptions=True)
    finally:
        client.close()
    return {
        "others": OTHERS,
        "clips": CLIPS,
        "ways": [{"way": way, **_figures(found)} for way, found in counted.items()],
    }


def _figures(turns: list[_Turn]) -> dict[str, Any]:
    """Return sums of what was counted, and medians of the turns' percentiles."""

    def usual(seconds: list[float]) -> float:
        return round(1000.0 * statistics.median(seconds), 2)

    return {
        "ticks": sum(turn.ticks for turn in turns),
        "late_ticks": sum(turn.late for turn in turns),
        "tick_p99_ms": usual([turn.tick for turn in turns]),
        "lateness_p99_ms": usual([turn.lateness for turn in turns]),
        "loop_delay_p99_ms": usual([turn.loop for turn in turns]),
    }


async def _turn(client: Client, seconds: float) -> _Turn:
    before = await client.counts()
    await asyncio.sleep(seconds)
    after = await client.counts()

    def rare(name: str) -> float:
        return after.quantile(before, f"risorius_{name}_seconds", 0.99)

    return _Turn(
        int(after.since(before, "risorius_ticks_total")),
        int(after.since(before, "risorius_tick_overruns_total")),
        rare("tick_duration"),
        rare("tick_lateness"),
        rare("loop_delay"),
    )


async def _rendering(client: Client) -> list[str]:
    """Ask for clips and return their ids once all of them are being rendered.

    Raises:
        SoakRefused: If they are not.
    """
    clips = []
    for _ in range(CLIPS):
        answer = await client.call("POST", "/api/clips", _CLIP)
        if answer.status != 202:
            raise SoakRefused(f"a clip was answered with {answer.status}: {answer.body}.")
        clips.append(str(answer.body["id"]))
    deadline = time.monotonic() + _LONGEST_SECONDS
    while time.monotonic() < deadline:
        rows = [(await client.call("GET", f"/api/clips/{clip}")).body for clip in clips]
        if all(row["status"] == "running" and row["progress"] > 0 for row in rows):
            return clips
        if any(row["status"] not in ("queued", "running") for row in rows):
            raise SoakRefused(f"a clip ended before it was looked at: {rows}.")
        await asyncio.sleep(0.1)
    raise SoakRefused(f"the clips were not rendered within {_LONGEST_SECONDS:g} s.")


async def _ended(client: Client, clips: list[str]) -> None:
    """Cancel clips, and forget them."""
    for _ in range(2):
        for clip in clips:
            await client.call("DELETE", f"/api/clips/{clip}")
