"""Sessions of a service that move while something else is measured."""

from __future__ import annotations

import asyncio
import time

from ..soak_client import Client, SoakRefused

OTHERS = 20
"""Sessions that are kept awake beside what is measured."""
TURN_SECONDS = 1.0
"""In which each of them gets a command, whose way takes as long: it never comes to rest."""
_UNITS = ({"AU12": 1.0, "AU6": 0.8}, {"AU1": 1.0, "AU4": 0.7, "AU15": 0.8}, {"AU26": 1.0})
"""Expressions far from each other."""


async def opened(client: Client) -> str:
    """Open a session and return its id.

    Raises:
        SoakRefused: If there is no room for it.
    """
    answer = await client.call("POST", "/api/sessions", {})
    if answer.status != 201:
        raise SoakRefused(f"a session was answered with {answer.status}: {answer.body}.")
    return str(answer.body["id"])


async def keep_moving(client: Client, faces: list[str]) -> None:
    """Command every face each turn, evenly, so that none falls asleep."""
    started, number = time.monotonic(), 0
    while True:
        face, turn = number % len(faces), number // len(faces)
        body = {"action_units": _UNITS[(turn + face) % len(_UNITS)], "fade": TURN_SECONDS}
        await client.call("PUT", f"/api/sessions/{faces[face]}/controls", body)
        number += 1
        due = started + TURN_SECONDS * number / len(faces)
        await asyncio.sleep(max(0.0, due - time.monotonic()))
