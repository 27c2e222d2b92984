"""The kernels beside the same forces written with other tools, on identical work."""

from __future__ import annotations

from typing import Any

from engine import Rig

from ..peers import LanesPeer, compare

FACES = (1, 16, 64)
STEPS = "verlet"
"""What ratios are taken of: whole steps, in which force and motion are one for every kernel."""


def measure_contest(rig: Rig, *, seconds: float, repeats: int) -> dict[str, Any]:
    """Return µs a face and force evaluation of each, and how many times the lanes' that is.

    Args:
        rig: Whose tissue.
        seconds: Least length of a sample.
        repeats: Samples of each, of which the median counts.
    """
    found = compare(rig, FACES, repeats=repeats, seconds=seconds)
    ours = next(row for row in found if row["name"] == LanesPeer.name)["seconds"]
    return {
        "faces": list(FACES),
        "ratio_to": LanesPeer.name,
        "peers": [_row(row, ours) for row in found],
    }


def _row(row: dict[str, Any], ours: dict[str, dict[str, float]]) -> dict[str, Any]:
    about = {"name": row["name"], "version": row["version"]}
    if "unavailable" in row:
        return {**about, "unavailable": row["unavailable"]}
    took = row["seconds"]
    return {
        **about,
        "us": {
            faces: {name: round(1e6 * value, 2) for name, value in by_work.items()}
            for faces, by_work in took.items()
        },
        "ratio": {
            faces: round(by_work[STEPS] / ours[faces][STEPS], 2) for faces, by_work in took.items()
        },
    }
