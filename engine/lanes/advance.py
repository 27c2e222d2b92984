"""A tick of sixteen faces: position Verlet, with contact wherever forces are taken."""

from __future__ import annotations

import numpy as np

from ..arrays import Float32Array
from ..compiling import kernel
from .network import Network
from .posing import Posing
from .sweep import Faces, sweep
from .touching import Touching, keep_lips, keep_off_eyes, keep_off_teeth
from .vector import WIDTH, load, part, splat, store

F = np.float32


@part
def resolve(x: Float32Array, v: Float32Array, at: Touching) -> None:
    """Put back every node that has passed what it may not: `dynamics.resolve_contacts`."""
    keep_lips(x, v, at)
    keep_off_teeth(x, v, at)
    keep_off_eyes(x, v, at)


@kernel
def advance(
    faces: Faces, net: Network, at: Touching, posing: Posing, substeps: int, dt: float
) -> None:
    """Move sixteen faces by `substeps` steps of `dt` seconds: `dynamics.advance_verlet`.

    What is held arrives at its place.
    """
    x, v, force = faces.x, faces.v, faces.force
    half = 0.5 * dt * net.damping
    keep, gain = F((1.0 - half) / (1.0 + half)), F(dt / (1.0 + half))
    time = splat(F(0.5 * dt))
    for i in range(0, x.shape[0], WIDTH):
        store(x, i, load(x, i) + time * load(v, i))
        store(force, i, load(faces.load, i))
    resolve(x, v, at)
    for step in range(substeps):
        drift = F(0.5 * dt) if step == substeps - 1 else F(dt)
        sweep(faces, net, F(1.0 - (step + 0.5) / substeps), keep, gain, drift)
        resolve(x, v, at)
    zero = splat(F(0.0))
    for k in range(posing.held.shape[0]):
        i = int(posing.held[k])
        for c in range(0, 9 * WIDTH, WIDTH):
            store(x, i + c, load(faces.places, 9 * WIDTH * k + c))
            store(v, i + c, zero)
