"""The kernels of live faces are compiled before there is one."""

from __future__ import annotations

import sys
from dataclasses import replace

from engine import Keyframe, Simulator, builtin_rig, warm_kernels


def compiled() -> dict[str, int]:
    """How many versions of each kernel this process has."""
    return {
        f"{place}.{name}": len(value.signatures)
        for place, module in list(sys.modules.items())
        if place.startswith("engine.") and ".head" not in place
        for name, value in vars(module).items()
        if hasattr(value, "signatures")
    }


def test_a_live_face_compiles_nothing_more() -> None:
    warm_kernels()
    before = compiled()
    assert before["engine.lanes.advance.advance"] >= 1
    rig = builtin_rig("standard")
    simulator = Simulator(rig, model=replace(rig.model, integrator="verlet"))
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units={"AU12": 1.0}))
    simulator.step()
    assert compiled() == before
