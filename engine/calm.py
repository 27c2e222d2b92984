"""Whether live faces come to rest with a step, tried: what the bound on their modes leaves out.

Masses are made for the phases in which a rig's tissue is found (`tissue.model`), and that holds for
the built-in head. On another one the corner of tightened lips can be stiffer than its mass allows:
it buzzes and never rests. A second of trial faces, all in one bank, shows it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from .assembly import Assembly, kept_for
from .lag import lagged
from .lanes import Bank, Plan, plan_of
from .timeline import TICKS_PER_SECOND

TRIALS = ("AU12", "AU15", "AU18", "AU20", "AU22", "AU23", "AU24", "AU28", "AU43")
"""Units that press the tissue of lips and lids hardest."""
SECONDS = 1.0
BUZZ = 10.0
"""mm/s: a face that comes to rest is far slower after a second."""
MOST_TIMES = 3
"""How many times the substeps of the bound are tried at most."""


@lru_cache(maxsize=32)
def calmed(assembly: Assembly) -> Assembly:
    """Return a rig that banks can step, with the least substeps at which its lips rest."""
    kept = kept_for(
        assembly.rig,
        "calm",
        (assembly.model, assembly.substeps),
        lambda: {"substeps": np.array(_least_restful(assembly))},
    )
    substeps = int(kept["substeps"].item())
    return assembly if substeps == assembly.substeps else replace(assembly, substeps=substeps)


def _least_restful(assembly: Assembly) -> int:
    plan, least = plan_of(assembly), assembly.substeps
    for substeps in range(least, MOST_TIMES * least):
        if _rests(assembly, replace(plan, substeps=substeps)):
            break
    return substeps


def _rests(assembly: Assembly, plan: Plan) -> bool:
    rig, bank = assembly.rig, Bank(plan, farthest=np.inf)
    commands = np.zeros_like(bank.signals)
    for lane, unit in enumerate(unit for unit in TRIALS if unit in rig.action_units):
        commands[lane] = rig.contraction({unit: 1.0})
    for _ in range(round(SECONDS * TICKS_PER_SECOND)):
        bank.signals[:] = lagged(bank.signals, commands, assembly.smoothing, assembly.stride)
        bank.step()
    return bool(bank.speed.max() < BUZZ)
