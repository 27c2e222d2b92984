"""How near the sweep comes to what the machine can do: its arithmetic against the same core's peak.

The peak is measured, not looked up: independent chains of fused multiply-adds on `Lanes`, as many a
second as the core starts. The sweep's own instructions are counted from its text: what is added to
a fresh product is one with it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Float32Array
from ..compiling import kernel
from .bank import Bank, Plan
from .network import Network
from .sweep import Faces, sweep
from .vector import WIDTH, aligned, load, splat, store

F = np.float32
COLUMN_INSTRUCTIONS = 64
SPRING_INSTRUCTIONS = 22
FIRST_ELEMENT_INSTRUCTIONS = 96
ELEMENT_INSTRUCTIONS = 78
FAT_INSTRUCTIONS = 116
"""Arithmetic on lanes for a column's update, each spring, the first element of a column and gap,
each further one, and each column of fat; an inverse root counts as the five it becomes."""
CHAINS = 10
"""Of multiply-adds: two a cycle, each four cycles long, need eight."""
ROUNDS = 20_000


@dataclass(frozen=True)
class Roof:
    """The sweep against the core that ran it, in one run.

    Attributes:
        multiply_adds: Vector multiply-adds that the core starts in a second.
        instructions: Arithmetic instructions of a sweep of sixteen faces.
        seconds: That a sweep took.
    """

    multiply_adds: float
    instructions: int
    seconds: float

    @property
    def share(self) -> float:
        """Arithmetic done in a second over what could have been done."""
        return self.instructions / self.seconds / self.multiply_adds


def instructions_of(net: Network) -> int:
    """Return how many arithmetic instructions a sweep of sixteen faces is."""
    runs = np.diff(net.element_start)
    return (
        COLUMN_INSTRUCTIONS * len(net.tangential)
        + SPRING_INSTRUCTIONS * len(net.rest)
        + ELEMENT_INSTRUCTIONS * len(net.volume)
        + (FIRST_ELEMENT_INSTRUCTIONS - ELEMENT_INSTRUCTIONS) * int((runs > 0).sum())
        + FAT_INSTRUCTIONS * len(net.fat_volume)
    )


def roof_of(plan: Plan, *, repeats: int = 30) -> Roof:
    """Measure peak and sweep in turns, the least of each: what else runs only makes them longer.

    Args:
        plan: A rig's.
        repeats: Samples of each.
    """
    numbers = aligned(CHAINS * WIDTH)
    numbers[:] = 0.5
    faces = Bank(plan, farthest=np.inf).faces
    samples = _in_turns(
        repeats, lambda: _multiply_adds(ROUNDS, numbers), lambda: _sweeps(faces, plan.network)
    )
    peak, swept = (min(each) for each in samples)
    return Roof(ROUNDS * CHAINS / peak, instructions_of(plan.network), swept)


def _in_turns(repeats: int, *works: Callable[[], None]) -> list[list[float]]:
    samples: list[list[float]] = [[] for _ in works]
    for work in works:
        work()  # compiled
    for _ in range(repeats):
        for work, took in zip(works, samples, strict=True):
            started = time.perf_counter()
            work()
            took.append(time.perf_counter() - started)
    return samples


@kernel
def _multiply_adds(rounds: int, out: Float32Array) -> None:
    """Square and add, which no algebra shortens, in `CHAINS` chains that do not wait."""
    b = splat(F(1.0e-3))
    s0, s1, s2, s3, s4 = load(out, 0), load(out, 16), load(out, 32), load(out, 48), load(out, 64)
    s5, s6, s7, s8 = load(out, 80), load(out, 96), load(out, 112), load(out, 128)
    s9 = load(out, 144)
    for _ in range(rounds):
        s0, s1, s2, s3, s4 = s0 * s0 + b, s1 * s1 + b, s2 * s2 + b, s3 * s3 + b, s4 * s4 + b
        s5, s6, s7, s8, s9 = s5 * s5 + b, s6 * s6 + b, s7 * s7 + b, s8 * s8 + b, s9 * s9 + b
    store(out, 0, s0 + s1 + s2 + s3 + s4 + s5 + s6 + s7 + s8 + s9)


@kernel
def _sweeps(faces: Faces, net: Network) -> None:
    """Sweep once; at rest the face stays where it is."""
    sweep(faces, net, F(0.0), F(1.0), F(1.0e-6), F(1.0e-6))
