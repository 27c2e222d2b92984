"""One row a run, so that releases can be compared: docs/benchmarks.csv."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

CROWD = 64
"""Number of faces that rows tell of: several banks, within what a core moves in real time."""
PEERS = ("alone (float64)", "numpy", "scipy", "taichi", "warp")
COLUMNS = (
    "release",
    "source",
    "date",
    "machine",
    "cores",
    "load",
    "faces_per_core",
    "face_tick_us_64",
    *(f"{name.split()[0]}_ratio" for name in PEERS),
    "clip_simulation_times_real_time",
)


class OtherColumns(Exception):
    """A file whose columns are not those of a row."""


def row_of(figures: dict[str, Any]) -> dict[str, Any]:
    """Return a run's row: figures at 64 faces; a peer that is not installed has none."""
    crowd = next(row for row in figures["crowds"] if row["faces"] == CROWD)
    ratios = {peer["name"]: peer.get("ratio") for peer in figures["peers"]["peers"]}
    load = figures["load_average"]
    values = (
        figures["risorius"],
        figures["source"],
        figures["date"],
        figures["machine"]["processor"],
        figures["machine"]["cores"],
        load[0] if load else "",
        crowd["faces_per_core_60hz"],
        crowd["face_tick_us"],
        *(ratio[str(CROWD)] if (ratio := ratios.get(name)) else "" for name in PEERS),
        figures["output"]["clip_simulation_times_real_time"],
    )
    return dict(zip(COLUMNS, values, strict=True))


def append_row(path: Path, figures: dict[str, Any]) -> None:
    """Add a run's row to a file, which is made if it is not there.

    Raises:
        OtherColumns: If the file has other columns.
        OSError: If it cannot be read or written.
    """
    kept = path.read_text(encoding="utf-8") if path.exists() else ""
    head = next(csv.reader(io.StringIO(kept)), None)
    if head is not None and tuple(head) != COLUMNS:
        raise OtherColumns(f"{path} has the columns {', '.join(head)}; move it away")
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if head is None:
            writer.writeheader()
        writer.writerow(row_of(figures))
