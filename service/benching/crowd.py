"""What a face costs among others that are awake, by how many there are."""

from __future__ import annotations

import statistics
import time
from typing import Any

from engine import Model, Rig, Simulator

from .motion import TICKS_BETWEEN, Motion

FACES = (1, 4, 16, 64, 256)
LEAST_ROUNDS = 3


def measure_crowds(rig: Rig, *, seconds: float) -> list[dict[str, Any]]:
    """Return what a tick of a face costs, one row a number of faces.

    Args:
        rig: Of all faces.
        seconds: Time that each row is measured for, at least three rounds.
    """
    return [{"faces": faces, **moving(rig, faces, seconds=seconds)} for faces in FACES]


def moving(rig: Rig, faces: int, *, seconds: float) -> dict[str, Any]:
    """Return what a tick of a face costs while `faces` of them move, all on one thread.

    Through the public simulator with the model of live faces: commanding is `Simulator.apply`,
    stepping is `Simulator.step` with the frames that it returns. Seconds are the thread's own, so
    what else the machine does counts little; medians of rounds of fifteen ticks, in which each face
    gets one command.

    Args:
        rig: Of all faces.
        faces: How many.
        seconds: Time to measure for, at least three rounds.

    Returns:
        "substeps" a tick, "awake", the share of faces that moved, "diverged", how many were put
        back to rest; in µs a face and tick "commanding_us", "stepping_us" and "face_tick_us", their
        sum; "faces_per_core_60hz", (1/60 s) / face_tick.
    """
    simulator = Simulator(rig, model=Model.for_rig(rig, integrator="verlet"), threads=1)
    motion = Motion(rig, faces)
    names = [f"face {number}" for number in range(faces)]
    for name in names:
        simulator.add(name)
    commanding: list[float] = []
    stepping: list[float] = []
    awake, lost, tick = 0, 0, 0
    until = time.thread_time() + seconds
    # The first round brings all faces into motion, and loads the kernels.
    while len(stepping) < 1 + LEAST_ROUNDS or time.thread_time() < until:
        commanding.append(0.0)
        stepping.append(0.0)
        for _ in range(TICKS_BETWEEN):
            started = time.thread_time()
            for face, keyframe in motion.due(tick):
                simulator.apply(names[face], keyframe)
            commanded = time.thread_time()
            frames = simulator.step()
            stepped = time.thread_time()
            awake += len(frames)
            lost += sum(frame.diverged for frame in frames.values())
            commanding[-1] += commanded - started
            stepping[-1] += stepped - commanded
            tick += 1
    share = 1e6 / (TICKS_BETWEEN * faces)
    commands, steps = (share * statistics.median(taken[1:]) for taken in (commanding, stepping))
    per_second = Simulator.TICKS_PER_SECOND
    return {
        "substeps": simulator.assembly.substeps,
        "awake": round(awake / (tick * faces), 3),
        "diverged": lost,
        "commanding_us": round(commands, 2),
        "stepping_us": round(steps, 1),
        "face_tick_us": round(commands + steps, 1),
        "faces_per_core_60hz": round(1e6 / (per_second * (commands + steps)), 1),
    }
