"""Figures of this machine: how many faces it moves, how fast it renders and encodes."""

from __future__ import annotations

import os
import platform
import statistics
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

from rich.table import Table

from engine import Frame, Keyframe, Rig, Simulator, Timeline, builtin_rig, clip_to_glb, record

from .protocol import encode_frame, surface_frame
from .version import version

_TICK_SECONDS = 1.0 / Simulator.TICKS_PER_SECOND
_BATCHES = (1, 4, 16)
_CLIP_SECONDS = 4.0
# Expressions that follow each other, so that no face falls asleep while it is measured.
_COMMANDS = (
    {"AU12": 1.0, "AU6": 0.8},
    {"AU1": 1.0, "AU4": 0.7, "AU15": 0.8},
    {"AU9": 1.0, "AU10": 0.6},
    {"AU26": 1.0, "AU5": 1.0},
)
_TICKS_BETWEEN = 15


def measure(rig_name: str = "standard", *, effort: float = 1.0) -> dict[str, Any]:
    """Return every figure, in the unit that its name says.

    Args:
        rig_name: A built-in rig.
        effort: Share of the usual number of ticks; less is quicker and rougher.
    """
    rig = builtin_rig(rig_name)
    alone = _tick_seconds(rig, faces=1, threads=1, ticks=round(120 * effort))
    substeps = Simulator(rig, threads=1).assembly.substeps
    batches = {
        str(faces): round(
            1000 * _tick_seconds(rig, faces=faces, threads=None, ticks=round(60 * effort)), 3
        )
        for faces in _BATCHES
    }
    return {
        "risorius": version(),
        "machine": machine(),
        "rig": {"id": rig.id, "name": rig.name, "vertices": len(rig.head.points)},
        "substeps_per_tick": substeps,
        "substep_milliseconds": round(1000 * alone / substeps, 4),
        "tick_milliseconds": round(1000 * alone, 3),
        "faces_per_core_60hz": round(_TICK_SECONDS / alone, 1),
        "tick_milliseconds_by_faces": batches,
        "clip_times_real_time": round(_clip_speed(rig, seconds=_CLIP_SECONDS * effort), 2),
        **_encoding(rig),
    }


def table(figures: dict[str, Any]) -> Table:
    """Return the figures for people."""
    machine = figures["machine"]
    lines = Table(title=f"{machine['processor']}, {machine['cores']} cores", title_justify="left")
    lines.add_column("figure")
    lines.add_column("value", justify="right")
    for name, value in figures.items():
        if isinstance(value, int | float):
            lines.add_row(name.replace("_", " "), f"{value:g}")
    for faces, milliseconds in figures["tick_milliseconds_by_faces"].items():
        lines.add_row(f"tick of {faces} faces, all cores, ms", f"{milliseconds:g}")
    return lines


def _tick_seconds(rig: Rig, *, faces: int, threads: int | None, ticks: int) -> float:
    """Return the median time of a tick with that many faces awake.

    With one thread it is that thread's own time: what else the machine does is not counted.
    """
    clock = time.thread_time if threads == 1 else time.perf_counter
    simulator = Simulator(rig, threads=threads)
    names = [f"face {number}" for number in range(faces)]
    for name in names:
        simulator.add(name)
    times = []
    for tick in range(ticks + _TICKS_BETWEEN):
        if tick % _TICKS_BETWEEN == 0:
            _command(simulator, names, tick // _TICKS_BETWEEN)
        started = clock()
        simulator.step()
        times.append(clock() - started)
    # The first ticks load compiled kernels.
    return statistics.median(times[_TICKS_BETWEEN:])


def _command(simulator: Simulator, names: list[str], turn: int) -> None:
    for number, name in enumerate(names):
        units = _COMMANDS[(turn + number) % len(_COMMANDS)]
        simulator.apply(name, Keyframe(action_units=units, fade=0.2, replace=True))


def _clip_speed(rig: Rig, *, seconds: float) -> float:
    """Return how many seconds of animation are rendered in a second, the GLB included."""
    keyframes = tuple(
        Keyframe(time=turn * seconds / len(_COMMANDS), action_units=units, fade=0.3, replace=True)
        for turn, units in enumerate(_COMMANDS)
    )
    started = time.perf_counter()
    clip_to_glb(record(rig, Timeline(keyframes, seconds), fps=30))
    return seconds / (time.perf_counter() - started)


def _encoding(rig: Rig) -> dict[str, float]:
    """Return time and size of a binary frame of a smiling face."""
    frame = _smile(rig)
    data = encode_frame(surface_frame(frame, rig.jaw))
    seconds = _best(lambda: encode_frame(surface_frame(frame, rig.jaw)))
    return {"encode_milliseconds": round(1000 * seconds, 4), "frame_bytes": len(data)}


def _smile(rig: Rig) -> Frame:
    simulator = Simulator(rig, threads=1)
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units=_COMMANDS[0]))
    for _ in range(30):
        simulator.step()
    return simulator.frame("face")


def _best(work: Callable[[], object], repeats: int = 50) -> float:
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return min(times)


def machine() -> dict[str, Any]:
    """Return what the figures of a measurement depend on: processor, system, versions."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
        **{name: metadata.version(name) for name in ("numpy", "numba", "scipy")},
    }


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
