"""How long the engine's kernels and each peer take for the same forces and steps, side by side."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from engine import Keyframe, Rig, Simulator
from engine.arrays import FloatArray
from engine.dynamics import Skull, Tissue, add_basis_forces

from .common import EVALUATIONS, Integrator, Peer
from .every import every_peer
from .kernel_peer import KernelPeer
from .lanes_peer import LanesPeer

FACES = (1, 16, 64)
"""Numbers of faces that are measured: alone, one block of lanes, several blocks."""

_COMMAND = {"AU12": 1.0, "AU26": 1.0, "AU4": 1.0}
_TICKS = 30
_NOISE_MM = 0.02

Sample = Callable[[int], None]


class Moving(NamedTuple):
    """A face in motion, as a peer takes it.

    Attributes:
        tissue, skull: What it is made of; the load has the muscles' forces, and nothing travels.
        x, v: Positions, mm, and velocities, mm/s, shape (3, nodes).
        dt: Seconds of a substep of the rig.
    """

    tissue: Tissue
    skull: Skull
    x: FloatArray
    v: FloatArray
    dt: float

    def crowd(self, faces: int) -> tuple[FloatArray, FloatArray]:
        """Return places and velocities of that many faces, no two alike, (faces, 3, nodes)."""
        noise = np.random.default_rng(1).normal(0.0, _NOISE_MM, (faces, *self.x.shape))
        free = self.tissue.inverse_mass > 0.0
        return self.x + noise * free, np.repeat(self.v[None], faces, axis=0)


def moving_face(rig: Rig) -> Moving:
    """Return a face of `rig` that is about to smile, drop its jaw and lower its brows."""
    simulator = Simulator(rig, threads=1)
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units=_COMMAND))
    for _ in range(_TICKS):
        simulator.step()
    face = simulator.snapshot("face")
    assembly, load = face.assembly, face.skull.load.copy()
    activations = face.signals[: rig.channels.muscle_count]
    add_basis_forces(assembly.basis, assembly.tissue.arrays.grip, activations, load)
    return Moving(
        assembly.tissue.arrays,
        face.skull._replace(load=load, travel=np.zeros_like(face.skull.travel)),
        face.x,
        face.v,
        1.0 / (Simulator.TICKS_PER_SECOND * assembly.substeps),
    )


def compare(
    rig: Rig,
    faces: Sequence[int] = FACES,
    *,
    peers: Sequence[Peer] | None = None,
    repeats: int = 5,
    seconds: float = 0.1,
) -> list[dict[str, Any]]:
    """Return what the engine's kernels and each peer take, one row each, the kernels first.

    A row has "name", "version", and either "unavailable", the reason, or "seconds": by number of
    faces, the seconds per face and force evaluation of the forces alone ("force") and of the steps
    that need them ("rk2", "verlet", those that it has). All do the same work on the same faces, on
    one thread; seconds are the processor's, so what else the machine does counts little. Each is
    the median of `repeats` samples, for which all take turns, after one to warm up.

    Args:
        rig: A rig without plate, in mode "rest".
        faces: Numbers of faces.
        peers: Whom to measure; None takes both of the engine's kernels and every peer.
        repeats: Samples of each.
        seconds: Least length of a sample.

    Raises:
        InvalidValue: If the rig has a term that the peers lack.
    """
    peers = (LanesPeer(), KernelPeer(), *every_peer()) if peers is None else peers
    moving = moving_face(rig)
    reasons = [peer.unavailable for peer in peers]
    able = [peer for peer, reason in zip(peers, reasons, strict=True) if reason is None]
    found: dict[str, dict[str, dict[str, float]]] = {peer.name: {} for peer in able}
    for count in faces:
        took_by_each = _side_by_side(able, moving, count, repeats, seconds)
        for peer, took in zip(able, took_by_each, strict=True):
            found[peer.name][str(count)] = took
    return [
        {"name": peer.name, "version": peer.version}
        | ({"unavailable": reason} if reason else {"seconds": found[peer.name]})
        for peer, reason in zip(peers, reasons, strict=True)
    ]


def _side_by_side(
    peers: Sequence[Peer], moving: Moving, faces: int, repeats: int, seconds: float
) -> list[dict[str, float]]:
    """Return each peer's seconds per face and force evaluation, by what is measured."""
    x, v = moving.crowd(faces)
    works = []
    for peer in peers:
        peer.prepare(moving.tissue, moving.skull, faces)
        peer.place(x, v)
        works.append(_works(peer, moving.dt))
    # How often each has to be done to be long enough; this warms up too.
    counts = [
        {name: _enough(sample, seconds) for name, (sample, _) in work.items()} for work in works
    ]
    samples: list[dict[str, list[float]]] = [{name: [] for name in work} for work in works]
    for _ in range(repeats):
        for peer, work, count, sample in zip(peers, works, counts, samples, strict=True):
            for name, (run, evaluations) in work.items():
                peer.place(x, v)
                took = _timed(run, count[name])
                sample[name].append(took / (count[name] * evaluations * faces))
    return [{name: statistics.median(took) for name, took in sample.items()} for sample in samples]


def _works(peer: Peer, dt: float) -> dict[str, tuple[Sample, int]]:
    """Return what is measured of a peer, and how many force evaluations each count has."""

    def steps(integrator: Integrator) -> tuple[Sample, int]:
        return lambda count: peer.substeps(count, dt, integrator), EVALUATIONS[integrator]

    return {"force": (peer.evaluate, 1), **{name: steps(name) for name in peer.integrators}}


def _enough(sample: Sample, seconds: float) -> int:
    count = 1
    sample(count)
    while (took := _timed(sample, count)) < 0.5 * seconds:
        count *= 2
    return max(1, round(count * seconds / took))


def _timed(sample: Sample, count: int) -> float:
    started = time.process_time()
    sample(count)
    return time.process_time() - started
