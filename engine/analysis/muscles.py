"""What each muscle of a face does: its force, and how far it has shortened."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..dynamics import Pull, add_muscle_forces
from ..force_basis import ride_jaw
from ..muscle import RING_PEAK, AirPressure, LidMuscle, Muscle, SphincterMuscle
from ..simulator import Snapshot

NEAREST = 4
"""Nodes of the hypodermis that carry a muscle's insertion."""
RING_POINTS = 32
"""Points at which the length of a sphincter's ring is sampled."""
MILLINEWTON = 17.3e-3
"""mN of force in one paper stiffness unit x mm: 17.3 g/s² x mm (see `tissue.parameters`)."""


@dataclass(frozen=True)
class MuscleState:
    """One muscle of a face as it stands.

    Attributes:
        name: "zygomatic_major.L".
        activation: As the tissue feels it now, behind its command by the muscle's lag.
        force: Sum of the sizes of its nodal forces, paper stiffness units x mm.
        rest_length: Of the line from attachment to insertion, or of a sphincter's ring, at rest,
            mm; None for muscles that turn lids, and for air.
        contraction: By how much that is shorter now, mm; negative where others stretch it.
        contraction_share: The same as a share of the rest length.
        turn: Turn of the upper and lower lid by a lid's muscle, degrees; None for others.
    """

    name: str
    activation: float
    force: float
    rest_length: float | None
    contraction: float | None
    contraction_share: float | None
    turn: tuple[float, float] | None = None


def muscle_states(snapshot: Snapshot, forces: FloatArray) -> list[MuscleState]:
    """Return every muscle in channel order.

    Args:
        snapshot: The face.
        forces: Of each muscle on the hypodermis, shape (m, 3, n), from `muscle_forces`.
    """
    states = []
    for index, muscle in enumerate(snapshot.assembly.rig.muscles):
        activation = float(snapshot.signals[index])
        force = float(np.linalg.norm(forces[index], axis=0).sum())
        if isinstance(muscle, LidMuscle):
            gain = muscle.gain[1 if muscle.name.endswith(".R") else 0] * activation
            turn = (muscle.upper * gain, muscle.lower * gain)
            states.append(MuscleState(muscle.name, activation, force, None, None, None, turn))
            continue
        if isinstance(muscle, AirPressure):
            states.append(MuscleState(muscle.name, activation, force, None, None, None))
            continue
        rest, now = muscle_lengths(snapshot, index, muscle)
        states.append(
            MuscleState(muscle.name, activation, force, rest, rest - now, (rest - now) / rest)
        )
    return states


def muscle_forces(snapshot: Snapshot) -> FloatArray:
    """Return the force of each muscle on each hypodermis node, paper units x mm, (m, 3, n)."""
    assembly = snapshot.assembly
    m = assembly.rig.channels.muscle_count
    activations = snapshot.signals[:m]
    forces = np.asarray(activations[:, None, None] * assembly.basis)
    if assembly.model.forces != "current":
        return forces
    n = assembly.tissue.node_count
    pitch, yaw, thrust = (float(value) for value in snapshot.signals[m : m + 3])
    for row in np.flatnonzero(activations):
        one = slice(row, row + 1)
        pull = assembly.pull
        moved = ride_jaw(
            Pull(
                pull.kinds[one],
                pull.shape[one],
                pull.scale[one] * activations[one],
                pull.share[one],
            ),
            assembly.rides[one],
            assembly.rig.jaw,
            (pitch, yaw, thrust),
        )
        force = np.zeros_like(snapshot.x)
        add_muscle_forces(snapshot.x, moved, assembly.tissue.arrays.grip, force)
        forces[row] += force.reshape(3, 3, n).sum(axis=1)
    return forces


def muscle_lengths(snapshot: Snapshot, index: int, muscle: Muscle) -> tuple[float, float]:
    """Return a muscle's length at rest and now, mm.

    From attachment, which rides the jaw where it is tied to it, to insertion, which goes with the
    tissue; of a sheet between the middles of its lines; of a sphincter, the ring where it pulls
    most.
    """
    if isinstance(muscle, SphincterMuscle):
        ring = _ring(muscle)
        return _ring_length(ring), _ring_length(_carried(snapshot, ring))
    assert not isinstance(muscle, LidMuscle | AirPressure)
    attachment, insertion = (_ends(end) for end in (muscle.attachment, muscle.insertion))
    assembly = snapshot.assembly
    m = assembly.rig.channels.muscle_count
    pitch, yaw, thrust = (float(value) for value in snapshot.signals[m : m + 3])
    share = np.full(len(attachment), assembly.rides[index, 0])
    moved = assembly.rig.jaw.move(attachment, share, pitch, yaw, thrust)
    return (
        _between(attachment, insertion),
        _between(moved, _carried(snapshot, insertion)),
    )


def _carried(snapshot: Snapshot, points: FloatArray) -> FloatArray:
    """Return `points`, shape (k, 3), moved with the hypodermis around them."""
    tissue = snapshot.assembly.tissue
    n = tissue.node_count
    rest, now = tissue.arrays.rest[:, 2 * n :].T, snapshot.x[:, 2 * n :].T
    squared = ((points[:, None] - rest[None]) ** 2).sum(axis=2)
    near = np.argsort(squared, axis=1, kind="stable")[:, :NEAREST]
    weight = 1.0 / np.maximum(np.take_along_axis(squared, near, axis=1), 1e-6)
    weight /= weight.sum(axis=1, keepdims=True)
    return np.asarray(points + (weight[:, :, None] * (now - rest)[near]).sum(axis=1))


def _ends(end: Sequence[object]) -> FloatArray:
    return np.array(end, dtype=float).reshape(-1, 3)


def _between(one: FloatArray, other: FloatArray) -> float:
    return float(np.linalg.norm(one.mean(axis=0) - other.mean(axis=0)))


def _ring(muscle: SphincterMuscle) -> FloatArray:
    """Return points of the ring at which a sphincter pulls most, shape (RING_POINTS, 3)."""
    normal = np.array(muscle.normal) / math.sqrt(sum(c * c for c in muscle.normal))
    across = np.array([1.0, 0.0, 0.0]) - normal * normal[0]
    across /= np.linalg.norm(across)
    up = np.cross(normal, across)
    angle = 2.0 * math.pi * (np.arange(RING_POINTS) + 0.5) / RING_POINTS
    wide, high = RING_PEAK * muscle.semi_major, RING_PEAK * muscle.semi_minor
    return np.asarray(
        np.array(muscle.plane)
        + wide * np.cos(angle)[:, None] * across
        + high * np.sin(angle)[:, None] * up
    )


def _ring_length(ring: FloatArray) -> float:
    return float(np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1).sum())
