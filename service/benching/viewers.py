"""What viewers get and cost: many of one face, and one of each of many faces.

Through a service in a process of its own, over sockets that acknowledge each frame and have it
packed, as the viewer does. Faces move throughout.
"""

from __future__ import annotations

import asyncio
import statistics
import time
from collections.abc import Sequence
from typing import Any

from ..protocol import RATE
from ..soak_client import Client, Counts, SoakRefused, own_service
from .company import TURN_SECONDS, keep_moving, opened
from .onlookers import Onlooker, onlooker
from .section import Section

MOST = 200
Crowds = Sequence[tuple[int, int]]
CROWDS: Crowds = ((1, 1), (1, MOST), (40, 1))
"""Faces, and viewers of each."""
_SETTLED_TURNS = 2


def measure_viewers(crowds: Crowds = CROWDS, *, seconds: float) -> list[dict[str, Any]]:
    """Return what viewers get and what they cost, one row a crowd.

    Args:
        crowds: Faces, and viewers of each.
        seconds: That each crowd is measured for.

    Returns:
        "faces", "viewers" of all; frames a second that the worst and the median one gets,
        "least_fps" and "median_fps", and what one is sent in median, "mbit_s", state and all;
        processor time of the service in percent of a core: "encoding_percent", "sending_percent",
        the rest of the event loop with acknowledgements, states and commands, and
        "simulating_percent", all other threads; "loop_us_a_frame", µs of the event loop a frame
        sent; "ticks_percent", ticks done of those due.

    Raises:
        SoakRefused: If the service does not start, or does not let them in.
    """
    settings = {"RISORIUS_MAX_VIEWERS": str(MOST), "RISORIUS_CAPACITY_SHARE": "1000"}
    with own_service(settings) as url:
        return asyncio.run(_crowds(url, crowds, seconds))


async def _crowds(url: str, crowds: Crowds, seconds: float) -> list[dict[str, Any]]:
    client = Client(url)
    try:
        await client.until_ready()
        return [await _crowd(client, url, *each, seconds) for each in crowds]
    finally:
        client.close()


async def _crowd(
    client: Client, url: str, faces: int, viewers: int, seconds: float
) -> dict[str, Any]:
    crowd: list[Onlooker] = []
    sessions: list[str] = []
    try:
        sessions = [await opened(client) for _ in range(faces)]
        moving = asyncio.create_task(keep_moving(client, sessions))
        try:
            for session in sessions:
                path = f"/api/sessions/{session}/stream"
                crowd += [await onlooker(url, path) for _ in range(viewers)]
            await asyncio.sleep(_SETTLED_TURNS * TURN_SECONDS)
            if any(each.closed or not each.frames for each in crowd):
                raise SoakRefused("a viewer was refused, or sent nothing.")
            before, seen = await client.counts(), [(each.frames, each.bytes) for each in crowd]
            started = time.perf_counter()
            await asyncio.sleep(seconds)
            now, took = [(each.frames, each.bytes) for each in crowd], time.perf_counter() - started
            after = await client.counts()
        finally:
            moving.cancel()
            await asyncio.gather(moving, return_exceptions=True)
    finally:
        for each in crowd:
            each.leave()
        for session in sessions:
            await client.call("DELETE", f"/api/sessions/{session}")
    fps = [(end[0] - start[0]) / took for start, end in zip(seen, now, strict=True)]
    rates = [8e-6 * (end[1] - start[1]) / took for start, end in zip(seen, now, strict=True)]
    return {
        "faces": faces,
        "viewers": len(crowd),
        "least_fps": round(min(fps), 1),
        "median_fps": round(statistics.median(fps), 1),
        "mbit_s": round(statistics.median(rates), 3),
        "ticks_percent": round(100 * after.since(before, "risorius_ticks_total") / took / RATE, 1),
        **_shares(before, after, took),
        "loop_us_a_frame": round(_loop_us(before, after), 1),
    }


def _loop_us(before: Counts, after: Counts) -> float:
    """Return what the event loop takes for a frame that is sent [µs], whatever it does."""
    frames = after.since(before, "risorius_frames_sent_total")
    return 1e6 * after.since(before, "risorius_event_loop_cpu_seconds") / max(1.0, frames)


def _shares(before: Counts, after: Counts, took: float) -> dict[str, float]:
    """Return processor time of the service [percent of a core]."""
    every, loop, encoding = (
        100.0 * after.since(before, f"risorius_{name}") / took
        for name in ("cpu_seconds", "event_loop_cpu_seconds", "frame_encoding_seconds_total")
    )
    return {
        "encoding_percent": round(encoding, 1),
        "sending_percent": round(loop - encoding, 1),
        "simulating_percent": round(every - loop, 1),
    }


def viewers_section(rows: list[dict[str, Any]]) -> Section:
    """Return the table of `measure_viewers`."""
    return Section(
        "Viewers",
        "Faces that move, in a service in a process of its own, and viewers who acknowledge every "
        "frame and have it packed; the machine runs the viewers too. Frames a second that the "
        "worst and the median viewer gets; processor time of the service in percent of a core: "
        "frames made bytes, the rest of the event loop, all other threads.",
        (
            "faces",
            "viewers",
            "worst, frames/s",
            "median, frames/s",
            "Mbit/s each",
            "encoding, %",
            "sending, %",
            "simulating, %",
            "loop, µs a frame",
            "ticks done, %",
        ),
        tuple(
            (
                row["faces"],
                row["viewers"],
                row["least_fps"],
                row["median_fps"],
                f"{row['mbit_s']:.2f}",
                row["encoding_percent"],
                row["sending_percent"],
                row["simulating_percent"],
                row["loop_us_a_frame"],
                row["ticks_percent"],
            )
            for row in rows
        ),
    )
