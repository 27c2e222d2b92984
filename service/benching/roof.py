"""How near the kernel of live faces comes to what the machine can do at most."""

from __future__ import annotations

from typing import Any

from engine import Model, Rig
from engine.assembly import compile_rig
from engine.lanes import WIDTH, plan_of
from engine.lanes.roof import roof_of

_FLOPS = 2 * WIDTH
"""Of a multiply-add of lanes."""


def measure_roof(rig: Rig, *, repeats: int) -> dict[str, Any]:
    """Return the core's peak and the sweep's share of it: see `engine.lanes.roof`.

    Args:
        rig: Whose tissue is swept.
        repeats: Samples, of which the least count.
    """
    plan = plan_of(compile_rig(rig, Model.for_rig(rig, integrator="verlet")))
    found = roof_of(plan, repeats=repeats)
    return {
        "core_gflops_float32": round(_FLOPS * found.multiply_adds / 1e9, 1),
        "sweep_instructions": found.instructions,
        "sweep_us": round(1e6 * found.seconds, 1),
        "share_of_peak_percent": round(100 * found.share, 1),
    }
