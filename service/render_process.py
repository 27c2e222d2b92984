"""A process that renders clips, one after another, with an interpreter of its own.

It reads orders from standard input and writes a line of JSON for each news of them: `progress`, 0
to 1, then `done` with its figures, or `refused` with a sentence and the `error`'s name. A tracker's
file alone is an order to read it. It ends with its service.
"""

from __future__ import annotations

import hashlib
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
from .errors import Refused, refused_by_engine
from .ground_truth import ground_truth_csv
from .priority import stand_back
from .track_file import TrackFile
from .whole_files import write_whole

SIMULATION_SHARE = 0.2
"""Share of a clip's work that is simulation; the rest is writing its file."""
_LONGEST_SENTENCE = 2000
_NEWS = 0.01
"""Progress after which the service is told again."""


@dataclass(frozen=True)
class Order:
    """A clip to render.

    Attributes:
        root: Named rig that its own comes from.
        steps: What was changed in it, step by step.
        timeline: What to play, or the tracker's file that says it.
        fps: Frames a second.
        model: Forms of the physics.
        start: Seconds of the timeline to leave out.
        level: Of detail.
        textures: Maps of skin and eyes that the file embeds, by file name; none for colours.
        glb: File to write.
        csv: File for its ground truth, if wanted.
        seed: Of the idle life in the timeline, which the file tells.
        form, tolerance, quantize, sparse: How the file tells the motion, as `clip_file` says.
    """

    root: str
    steps: Steps
    timeline: Timeline | TrackFile
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
    timeline, told = _performed(order.timeline, rig)
    started = time.perf_counter()
    clip = record(
        rig,
        timeline,
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
    files = {"glb": (order.glb, file.data)}
    if order.csv is not None:
        truth = ground_truth_csv(drawn, timeline, order.start).encode()
        files["csv"] = order.csv, truth
    for path, content in files.values():
        write_whole(path, content)
    return {
        "frames": len(clip),
        "duration": clip.duration if order.start else timeline.duration,
        "bytes": len(file.data),
        **file.told,
        "sha256": {name: _sha256(content) for name, (_, content) in files.items()},
        "simulation_seconds": round(simulated - started, 3),
        "fit_seconds": round(file.fit_seconds, 3),
        "write_seconds": round(file.write_seconds, 3),
        "writing_seconds": round(time.perf_counter() - simulated, 3),
        **told,
    }


def _performed(timeline: Timeline | TrackFile, rig: Rig) -> tuple[Timeline, Mapping[str, Any]]:
    """Return what is played, and what is told of where it comes from."""
    if isinstance(timeline, Timeline):
        return timeline, {}
    return timeline.performed(rig)


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


@lru_cache(maxsize=4)
def _rig(root: str, steps: str) -> Rig:
    return made_from(root, json.loads(steps))


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

    def refuse(self, refused: Refused) -> None:
        """Tell why nothing comes of it; what a file says of itself may be long."""
        self.say(refused=refused.message[:_LONGEST_SENTENCE], error=refused.error)

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
            order: Order | TrackFile = pickle.load(orders)
        except EOFError:
            return
        news.begin()
        try:
            news.say(done=_done(order, news))
        except EngineError as error:
            news.refuse(refused_by_engine(error))
        except Refused as refused:
            news.refuse(refused)


def _done(order: Order | TrackFile, news: _News) -> Mapping[str, Any]:
    if isinstance(order, TrackFile):
        return order.told()
    return carry_out(order, news.progress)


if __name__ == "__main__":
    main()
