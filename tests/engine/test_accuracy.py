"""The integrator of live faces draws what converged Runge-Kutta does (Zhang et al., section 6)."""

from __future__ import annotations

import numpy as np

from engine import Keyframe, Model, Simulator
from engine.flesh import RIGID_REGIONS, random_mixes

RMS_MM, MOST_MM = 0.05, 0.2
THROAT_MM = 0.3
"""Under a jaw that is dropped as far as it goes the skin of the throat gives way to one side; when,
and to which, is decided by the last bit of a number, in any integrator."""
THROAT = ("submental", "neck")
TICKS = 30
CONVERGED = 40
"""Substeps a tick of the reference: from 100 it is no farther than 0.03 mm off."""


def drawn(rig, keyframes, **choices):
    """Return displacements of every face at every tick, (ticks, faces, s, 3)."""
    substeps = choices.pop("substeps", None)
    model = Model.for_rig(rig, **choices)
    simulator = Simulator(rig, model=model, substeps=substeps)
    for name, keyframe in enumerate(keyframes):
        simulator.add(str(name))
        simulator.apply(str(name), keyframe)
    ticks = []
    for _ in range(TICKS):
        simulator.step()
        ticks.append([simulator.frame(name).displacements for name in simulator.faces])
    return np.array(ticks, np.float32)


def test_live_faces_are_drawn_as_converged_runge_kutta_draws_them(standard_rig):
    """Every unit as a step from rest, and a hundred mixes, at every tick of their way."""
    units = [
        Keyframe(action_units={name: 1.0})
        for name, unit in standard_rig.action_units.items()
        if unit.region not in RIGID_REGIONS
    ]
    keyframes = units + random_mixes(standard_rig, 100, 77)
    live = drawn(standard_rig, keyframes, integrator="verlet")
    converged = drawn(standard_rig, keyframes, integrator="rk2", substeps=CONVERGED)
    error = np.linalg.norm(live - converged, axis=-1)
    assert np.abs(converged).max() > 20.0
    assert np.sqrt((error**2).mean(axis=-1)).max() < RMS_MM
    throat = np.zeros(error.shape[-1], dtype=bool)
    head = standard_rig.head
    for polygon, region in zip(head.polygons, head.polygon_regions, strict=True):
        throat[polygon[polygon >= 0]] |= any(name in region for name in THROAT)
    assert 50 < throat.sum() < 300
    assert error[:, :, ~throat].max() < MOST_MM
    assert error.max() < THROAT_MM
