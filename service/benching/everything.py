"""Every measurement, one after another on the same rig."""

from __future__ import annotations

from collections.abc import Callable, Collection
from datetime import UTC, datetime
from typing import Any, NamedTuple

from engine import builtin_rig

from ..version import version
from .beside_clips import measure_beside_clips
from .clips import LENGTHS, measure_clips
from .contest import measure_contest
from .crowd import measure_crowds
from .first_frame import measure_emotion_to_frame
from .integrators import measure_integrators
from .live import measure_latencies
from .machine import described, load_average, machine, niceness
from .meshes import SPLITS, measure_meshes
from .output import measure_output
from .page_opening import measure_page_opening
from .roof import measure_roof
from .stream import measure_stream
from .viewers import CROWDS, Crowds, measure_viewers

Show = Callable[[str], None]


class Effort(NamedTuple):
    """How long things are measured.

    Attributes:
        seconds: Of each row of crowds; integrators and meshes take half of it.
        sample: Seconds of a peer's sample.
        repeats: Samples of each peer.
        commands: Timed through the runner, for each number of faces.
        emotions: Timed from their POST to the frame that shows them.
        pages: Of the viewer that are opened.
        turn: Seconds of each turn without clips, and beside some.
        turns: Of both.
        viewers: Crowds of viewers.
        crowd: Seconds that each of them is measured for.
        clip: Seconds of animation.
        lively: Seconds of lively motion that are streamed.
        sweeps: Samples of the roof.
        splits: How fine the meshes are split.
        lengths: Of the clips whose cost is compared [s].
    """

    seconds: float
    sample: float
    repeats: int
    commands: int
    emotions: int
    pages: int
    turn: float
    turns: int
    viewers: Crowds
    crowd: float
    clip: float
    lively: float
    sweeps: int
    splits: tuple[int, ...]
    lengths: tuple[float, ...]


FULL = Effort(4.0, 0.1, 7, 300, 120, 5, 10.0, 3, CROWDS, 8.0, 4.0, 20.0, 100, SPLITS, LENGTHS)
QUICK = Effort(
    0.2, 0.01, 3, 20, 8, 1, 1.0, 1, ((1, 3), (2, 1)), 0.5, 0.4, 1.5, 10, SPLITS[:2], (0.5, 1.0)
)
PARTS = (
    "peers",
    "integrators",
    "crowds",
    "meshes",
    "latency",
    "emotion_to_frame",
    "page_opening",
    "beside_clips",
    "output",
    "stream",
    "viewers",
    "clips",
    "roof",
)
"""What is measured, in this order."""


def _silent(stage: str) -> None:
    """Show nothing."""


def measure(
    rig_name: str = "standard",
    *,
    only: Collection[str] = PARTS,
    quick: bool = False,
    show: Show = _silent,
) -> dict[str, Any]:
    """Return every figure, in the unit that its name says.

    Args:
        rig_name: A built-in rig.
        only: The parts that are measured.
        quick: Whether to measure shortly and roughly.
        show: Told what is being measured.

    Raises:
        SoakRefused: If the service, which two parts take, does not start.
    """
    effort, load = QUICK if quick else FULL, load_average()
    rig = builtin_rig(rig_name)
    parts: dict[str, Callable[[], Any]] = {
        "peers": lambda: measure_contest(rig, seconds=effort.sample, repeats=effort.repeats),
        "integrators": lambda: measure_integrators(rig, seconds=effort.seconds / 2),
        "crowds": lambda: measure_crowds(rig, seconds=effort.seconds),
        "meshes": lambda: measure_meshes(rig, seconds=effort.seconds / 2, splits=effort.splits),
        "latency": lambda: measure_latencies(rig, commands=effort.commands),
        "emotion_to_frame": lambda: measure_emotion_to_frame(emotions=effort.emotions),
        "page_opening": lambda: measure_page_opening(pages=effort.pages),
        "beside_clips": lambda: measure_beside_clips(seconds=effort.turn, turns=effort.turns),
        "output": lambda: measure_output(rig, clip_seconds=effort.clip),
        "stream": lambda: measure_stream(rig, seconds=effort.lively),
        "viewers": lambda: measure_viewers(effort.viewers, seconds=effort.crowd),
        "clips": lambda: measure_clips(rig, lengths=effort.lengths),
        "roof": lambda: measure_roof(rig, repeats=effort.sweeps),
    }
    figures: dict[str, Any] = {
        "risorius": version(),
        "source": described(),
        "date": datetime.now(UTC).date().isoformat(),
        "quick": quick,
        "machine": machine(),
        "load_average": load,
        "niceness": niceness(),
        "rig": {"id": rig.id, "name": rig.name, "vertices": len(rig.head.points)},
    }
    for name in PARTS:
        if name in only:
            show(name.replace("_", " "))
            figures[name] = parts[name]()
    return figures
