"""A rig compiled to arrays for one model: what a simulator steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .arrays import FloatArray
from .cache import Arrays, cached_arrays, content_key
from .channels import GROUPS
from .dynamics import TABLEAUS, Pull
from .errors import InvalidValue
from .force_basis import jaw_rides, moving_pull
from .muscle import LidMuscle
from .rates import strides
from .rest_basis import ground_of, rest_basis
from .rig import Model, Rig
from .sources import ENGINE_HASH
from .stability import largest_frequency, least_substeps
from .timeline import TICKS_PER_SECOND
from .tissue import TissueModel, assemble, no_pull


@dataclass(frozen=True, eq=False)
class Assembly:
    """One rig, ready to step.

    Attributes:
        rig: Where it comes from.
        model: The forms of the physics.
        tissue: Layers, springs, terms, contact.
        basis: Muscle forces at activation 1, shape (m, 3, n); in mode "current" only what presses
            along the normals, air and bellies.
        pull: The muscles in mode "current"; empty in mode "rest".
        rides: Share of the jaw that each muscle's two ends turn by, shape (m, 2).
        substeps: Integration steps a tick.
        omega: Fastest mode, rad/s.
        lid_angles: Turn of upper and lower lid at activation 1 of each muscle, degrees,
            shape (m, 2, 2): muscle, side (left, right), lid (upper, lower).
        smoothing: Share of the way to its command that each channel goes in a tick, (channels,).
        stride: The most that each goes in a tick, (channels,).
    """

    rig: Rig
    model: Model
    tissue: TissueModel
    basis: FloatArray
    pull: Pull
    rides: FloatArray
    substeps: int
    omega: float
    lid_angles: FloatArray
    smoothing: FloatArray
    stride: FloatArray

    @property
    def lid_shares(self) -> FloatArray:
        """κ of the upper and of the lower lid, shape (2,); 0 where the head has no skin to push."""
        p = self.rig.parameters
        pushed = float(len(self.tissue.lids.skin) > 0)
        return pushed * np.array([p.upper_lid_skin, p.lower_lid_skin])

    @property
    def tableau(self) -> FloatArray:
        """The integrator, as the kernel knows it."""
        return TABLEAUS[self.model.integrator]


def compile_rig(rig: Rig, model: Model, substeps: int | None = None) -> Assembly:
    """Return `rig` compiled for `model`, the same for the same.

    Args:
        rig: The rig.
        model: The forms of the physics.
        substeps: Steps a tick; None takes the least that is stable.

    Raises:
        InvalidValue: If `substeps` is fewer than the stability bound asks for.
    """
    return _compiled(rig, model, substeps)


@lru_cache(maxsize=16)
def _compiled(rig: Rig, model: Model, substeps: int | None) -> Assembly:
    head, parameters = rig.head, rig.parameters
    tissue = assemble(head, parameters, literal_springs=model.springs == "literal")
    moving = model.forces == "current"
    omega = _fastest_mode(rig, tissue)
    if tissue.hardened:
        # Masses hold the phases that the linear view leaves out, to just this frequency.
        omega = max(omega, parameters.mass_frequency)
    least = least_substeps(omega, parameters.damping, model.integrator, 1.0 / TICKS_PER_SECOND)
    if substeps is not None and substeps < least:
        raise InvalidValue(
            f"{substeps} substeps a tick are not stable: this rig's fastest mode is "
            f"{omega:.0f} rad/s and {model.integrator} needs at least {least}"
        )
    return Assembly(
        rig=rig,
        model=model,
        tissue=tissue,
        basis=_forces(rig, tissue, ring=model.sphincter, pressing_only=moving),
        pull=moving_pull(head, tissue, rig.muscles, ring=model.sphincter)
        if moving
        else no_pull(tissue.node_count),
        rides=jaw_rides(head, rig.muscles),
        substeps=substeps or least,
        omega=omega,
        lid_angles=_lid_angles(rig),
        smoothing=_smoothing(rig),
        stride=strides(rig),
    )


def _fastest_mode(rig: Rig, tissue: TissueModel) -> float:
    """Return the frequency of the fastest mode, rad/s: an edit of a muscle leaves it as it is."""
    arrays, normals = tissue.arrays, tissue.layers.normals
    kept = _kept(
        rig,
        "frequency",
        content_key(ENGINE_HASH, *_flat(arrays), normals),
        lambda: {"omega": np.array(largest_frequency(arrays, normals))},
    )
    return float(kept["omega"].item())


def _forces(rig: Rig, tissue: TissueModel, *, ring: str, pressing_only: bool) -> FloatArray:
    """Return the basis of muscle forces: most edits of tissue leave it as it is."""
    ground = ground_of(rig.head, tissue)
    strength = tissue.parameters.muscle_strength
    kept = _kept(
        rig,
        "forces",
        content_key(ENGINE_HASH, ground.key, rig.muscles, strength, ring, pressing_only),
        lambda: {
            "basis": rest_basis(
                ground, rig.muscles, strength=strength, ring=ring, pressing_only=pressing_only
            )
        },
    )
    return kept["basis"]


def _flat(value: object) -> Iterator[object]:
    """Yield what tuples in tuples hold, one after another."""
    if isinstance(value, tuple):
        for part in value:
            yield from _flat(part)
    else:
        yield value


def kept_for(rig: Rig, kind: str, parts: tuple[object, ...], build: Callable[[], Arrays]) -> Arrays:
    """Return arrays that follow from a person's rig and `parts`, kept on disk; see `cached_arrays`.

    On any other head they are built anew: its id does not tell all that the tissue is made of.
    """
    return _kept(rig, kind, content_key(ENGINE_HASH, rig.id, *parts), build)


def _kept(rig: Rig, kind: str, key: str, build: Callable[[], Arrays]) -> Arrays:
    return build() if rig.recipe is None else cached_arrays(kind, key, build, aside=True)


def _lid_angles(rig: Rig) -> FloatArray:
    angles = np.zeros((len(rig.muscles), 2, 2))
    for index, muscle in enumerate(rig.muscles):
        if isinstance(muscle, LidMuscle):
            side = 1 if muscle.name.endswith(".R") else 0
            gain = muscle.gain[side]
            angles[index, side] = muscle.upper * gain, muscle.lower * gain
    return angles


def _smoothing(rig: Rig) -> FloatArray:
    """Return 1 - exp(-dt/τ) of each channel's first-order lag."""
    p, channels = rig.parameters, rig.channels
    lag = np.full(channels.count, p.activation_lag)
    for index, muscle in enumerate(rig.muscles):
        if isinstance(muscle, LidMuscle):
            lag[index] = p.lid_lag
    for group, value in (("gaze", GAZE_LAG), ("head", HEAD_LAG), ("tongue", TONGUE_LAG)):
        for axis in GROUPS[group]:
            lag[channels.index(group, axis)] = value
    lag[channels.index("gaze", "vergence")] = VERGENCE_LAG
    tick = 1.0 / TICKS_PER_SECOND
    return np.where(lag > 0.0, -np.expm1(-tick / np.maximum(lag, 1.0e-9)), 1.0)


GAZE_LAG = 0.015
"""s; a saccade of 10 degrees takes about 50 ms."""
VERGENCE_LAG = 0.060
"""s; vergence is slower than a saccade: some 200 ms in all (Leigh and Zee 2015)."""
TONGUE_LAG = 0.060
"""s; put out at some 100 to 200 mm/s."""
HEAD_LAG = 0.120
"""s; the head's inertia."""
