"""A process that renders clips, one after another, with an interpreter of its own.

It reads orders from standard input and writes a line of JSON for each news of them: `progress`, 0
to 1, then `done` with its figures, or `refused` with a sentence. It ends with its service.
"""

from __future__ import annotations

import json
import os
import pickle
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, BinaryIO

from engine import EngineError, Model, Rig, Timeline, clip_file, record

from .apart import orders_and_answers
from .deriving import Steps, made_from
from .errors import Refused
from .ground_truth import ground_truth_csv
from .priority import stand_back

SIMULATION_SHARE = 0.2
"""Share of a clip's work that is simulation; the rest is writing its file."""
_NEWS = 0.01
"""Progress after which the service is told again."""


@dataclass(frozen=True)
class Order:
    """A clip to render.

    Attributes:
        root: Named rig that its own comes from.
        steps: What was changed in it, step by step.
        timeline: What to play.
        fps: Frames a second.
        model: Forms of the physics.
        start: Seconds of the timeline to leave out.
        level: Of detail.
        textures: Maps of skin and eyes that the file embeds, by file name; none for colours.
        glb: File to write.
        csv: File for its ground truth, if wanted.
        seed: Of the idle life in the timeline, which the file tells.
        form, tolerance, quantize, sparse: How the file tells the motion, as `clip_to_glb` says.
    """

    root: str
    steps: Steps
    timeline: Timeline
    fps: int
    model: Model
    start: float
    level: str
    textures: Mapping[str, bytes]
    glb: Path
    csv: Path | None
    seed: int | None = None
    form: str = "basis"
    tolerance: float = 0.1
    quantize: bool = True
    sparse: bool = True


def carry_out(order: Order, show: Callable[[float], None]) -> Mapping[str, Any]:
    """Render a clip, write its files whole, and return its figures.

    Args:
        order: What to render.
        show: Told the share of the work done, 0 to 1.

    Raises:
        EngineError, Refused: If it cannot be played.
        OSError: If it cannot be written.
    """
    rig = _rig(order.root, json.dumps(list(order.steps)))
    started = time.perf_counter()
    clip = record(
        rig,
        order.timeline,
        fps=order.fps,
        model=order.model,
        progress=lambda share: show(SIMULATION_SHARE * share),
    ).after(order.start)
    simulated = time.perf_counter()
    drawn = replace(clip, rig=rig.at_level(order.level))
    file = clip_file(
        drawn,
        form=order.form,
        tolerance=order.tolerance,
        quantize=order.quantize,
        sparse=order.sparse,
        textures=order.textures,
        origin={"root": order.root, "steps": list(order.steps)},
        seed=order.seed,
        progress=lambda share: show(SIMULATION_SHARE + (1.0 - SIMULATION_SHARE) * share),
    )
    _write(order.glb, file.data)
    if order.csv is not None:
        _write(order.csv, ground_truth_csv(drawn, order.timeline, order.start).encode())
    return {
        "frames": len(clip),
        "duration": clip.duration if order.start else order.timeline.duration,
        "bytes": len(file.data),
        **file.told,
        "simulation_seconds": round(simulated - started, 3),
        "fit_seconds": round(file.fit_seconds, 3),
        "write_seconds": round(file.write_seconds, 3),
        "writing_seconds": round(time.perf_counter() - simulated, 3),
    }


@lru_cache(maxsize=4)
def _rig(root: str, steps: str) -> Rig:
    return made_from(root, json.loads(steps))


def _write(path: Path, data: bytes) -> None:
    """Write a file that is there as a whole or not at all, also if this process is killed."""
    part = part_of(path, os.getpid())
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def part_of(path: Path, process: int) -> Path:
    """Return where a process writes what becomes the file at `path` once it is whole."""
    return path.with_name(f"{path.name}.{process}")


class _News:
    """What the service is told, no more often than it cares."""

    def __init__(self, out: BinaryIO) -> None:
        self._out = out
        self._parent = os.getppid()
        self._shown = 0.0

    def begin(self) -> None:
        """Another clip begins."""
        self._shown = 0.0

    def progress(self, share: float) -> None:
        """Tell how much is done; end if nobody is there to be told."""
        if os.getppid() != self._parent:
            sys.exit(0)  # The service was killed: it renders the clip again when it is back.
        if share >= self._shown + _NEWS:
            self._shown = share
            self.say(progress=round(share, 4))

    def say(self, **news: object) -> None:
        """Write a line."""
        self._out.write(json.dumps(news).encode() + b"\n")
        self._out.flush()


def main() -> None:
    """Render until standard input ends."""
    stand_back()
    orders, answers = orders_and_answers()
    news = _News(answers)
    while True:
        try:
            order: Order = pickle.load(orders)
        except EOFError:
            return
        news.begin()
        try:
            news.say(done=carry_out(order, news.progress))
        except (EngineError, Refused) as error:
            news.say(refused=str(error))


if __name__ == "__main__":
    main()
