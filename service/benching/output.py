"""What leaves the simulation: clips as files, frames as bytes."""

from __future__ import annotations

import time
from collections.abc import Callable

from engine import Frame, Keyframe, Rig, Simulator, Timeline, clip_to_glb, record

from ..protocol import encode_frame, surface_frame

_COMMANDS = (
    {"AU12": 1.0, "AU6": 0.8},
    {"AU1": 1.0, "AU4": 0.7, "AU15": 0.8},
    {"AU9": 1.0, "AU10": 0.6},
    {"AU26": 1.0, "AU5": 1.0},
)


def measure_output(rig: Rig, *, clip_seconds: float) -> dict[str, float]:
    """Return how fast clips are made, and time and size of a frame.

    Args:
        rig: Of the face.
        clip_seconds: Length of the clip.

    Returns:
        Seconds of animation a second of the processor, simulated
        ("clip_simulation_times_real_time") and with its file written ("clip_times_real_time");
        "encode_milliseconds" and "frame_bytes" of a smile.
    """
    return {**_clip(rig, clip_seconds), **_encoding(rig)}


def _clip(rig: Rig, seconds: float) -> dict[str, float]:
    keyframes = tuple(
        Keyframe(time=turn * seconds / len(_COMMANDS), action_units=units, fade=0.3, replace=True)
        for turn, units in enumerate(_COMMANDS)
    )
    started = time.process_time()
    clip = record(rig, Timeline(keyframes, seconds), fps=30)
    simulated = time.process_time()
    clip_to_glb(clip)
    written = time.process_time()
    return {
        "clip_simulation_times_real_time": round(seconds / (simulated - started), 2),
        "clip_times_real_time": round(seconds / (written - started), 2),
    }


def _encoding(rig: Rig) -> dict[str, float]:
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
