"""What holds the tissue at rest: nothing moves until a muscle pulls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import builtin_rig
from engine.dynamics import scratch_for, static_forces
from engine.tissue import assemble, no_pull, rest_skull

CHANGES = {
    "as it is": {},
    "taut and firm": {"pretension": 0.3, "skin_volume": 900.0, "fat_pressure": 600.0, "plate": 5.0},
    "layers that almost touch": {"layer_gap": 0.99, "layer_order": 40.0, "guard_strain": 0.0},
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("literal", [False, True])
def test_at_rest_all_forces_cancel(change: str, *, literal: bool) -> None:
    rig = builtin_rig("standard")
    parameters = replace(rig.parameters, **CHANGES[change])
    model = assemble(rig.head, parameters, literal_springs=literal)
    arrays, count = model.arrays, model.node_count
    left = np.full_like(arrays.rest, np.nan)
    skull = rest_skull(arrays, model.layers, model.dead_load)
    static_forces(arrays.rest, arrays, skull, no_pull(count), scratch_for(arrays), left)
    assert np.abs(model.dead_load).max() > 100.0
    assert np.abs(left).max() < 1e-10
