"""What each integrator costs a face: one alone in float64, and Verlet in lanes."""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np

from engine import MODEL_CHOICES, FaceState, Model, Rig
from engine.alone import Alone
from engine.assembly import compile_rig
from engine.lanes import WIDTH
from engine.mixing import Mixer
from engine.simulator import FARTHEST_MM
from engine.together import Together

from .motion import TICKS_BETWEEN, Motion

LEAST_ROUNDS = 2


def measure_integrators(rig: Rig, *, seconds: float) -> list[dict[str, Any]]:
    """Return substeps a tick and milliseconds a face and tick of each, the lanes last.

    Args:
        rig: Of the faces.
        seconds: Time that each is measured for, at least two rounds.
    """
    rows = [_row(rig, name, Alone, seconds) for name in MODEL_CHOICES["integrator"]]
    return [*rows, _row(rig, "verlet", Together, seconds)]


def _row(
    rig: Rig, integrator: str, kind: type[Alone] | type[Together], seconds: float
) -> dict[str, Any]:
    assembly = compile_rig(rig, Model.for_rig(rig, integrator=integrator))
    faces = WIDTH if kind is Together else 1
    stepper, motion = kind(assembly, farthest=FARTHEST_MM), Motion(rig, faces)
    rest = assembly.tissue.arrays.rest
    states = [
        FaceState(rest.copy(), np.zeros_like(rest), np.zeros(rig.channels.count), Mixer(rig))
        for _ in range(faces)
    ]
    rounds: list[float] = []
    until = time.thread_time() + seconds
    while len(rounds) < 1 + LEAST_ROUNDS or time.thread_time() < until:
        rounds.append(0.0)
        for _ in range(TICKS_BETWEEN):
            for face, keyframe in motion.due(states[0].tick):
                states[face].mixer.apply(keyframe, states[face].tick)
            started = time.thread_time()
            stepper.step(states, None)
            rounds[-1] += time.thread_time() - started
            for state in states:
                state.tick += 1
    taken = statistics.median(rounds[1:]) / (TICKS_BETWEEN * faces)
    return {
        "integrator": integrator,
        "kernel": f"lanes, {WIDTH} faces" if kind is Together else "alone",
        "precision": "float32" if kind is Together else "float64",
        "substeps": assembly.substeps,
        "face_tick_ms": round(1000 * taken, 4),
        "substep_us": round(1e6 * taken / assembly.substeps, 2),
    }
