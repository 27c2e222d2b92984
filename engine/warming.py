"""The kernels of live faces, compiled or loaded before there is a face: on a patch of skin.

What a kernel is compiled for are the types of its arrays, which any head has; so this can run
beside the making of the first one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .assembly import compile_rig
from .compiling import is_kept
from .head import head_from_mesh
from .lanes import Bank, plan_of
from .lanes.advance import advance
from .mixing import Mixer
from .rig import Model, Rig, rig_from_head
from .simulator import Simulator
from .timeline import Keyframe
from .tissue import TissueParameters

COLUMNS, ROWS = 8, 9
HALF_WIDTH, TOP, BOTTOM = 60.0, 60.0, -90.0
"""Of the patch, mm."""


def warm_kernels(rig: Rig | None = None) -> None:
    """Compile or load every kernel that a live face needs.

    Args:
        rig: Whose face is moved for it; None takes a patch of skin, which needs no head.
    """
    rig = rig or _patch()
    simulator = Simulator(rig, model=_live(rig), threads=1)
    simulator.add("face")
    simulator.apply("face", Keyframe(action_units={"AU12": 1.0}))
    simulator.step()


def warm_sweep() -> None:
    """Compile or load all kernels of live faces but those of `warm_posing`, the longest first.

    What takes two processes as long as each other: one does this, the other makes a head before it
    does the rest.
    """
    rig = _patch()
    bank = _bank(rig)
    bank.advance()
    bank.look()
    mixer = Mixer(rig)
    mixer.apply(Keyframe(action_units={"AU12": 1.0}), 0)
    mixer.at(1)


def warm_posing(rig: Rig) -> None:
    """Compile or load the kernels that pose skull, lids and muscles of a rig."""
    _bank(rig).pose()


def _bank(rig: Rig) -> Bank:
    return Bank(plan_of(compile_rig(rig, _live(rig))), farthest=np.inf)


def _live(rig: Rig) -> Model:
    return replace(rig.model, integrator="verlet")


def kernels_are_kept() -> bool:
    """Return whether the kernels lie compiled on disk, so that `warm_kernels` only loads them."""
    return is_kept(advance)


def _patch() -> Rig:
    x, y = np.meshgrid(
        np.linspace(-HALF_WIDTH, HALF_WIDTH, COLUMNS), np.linspace(BOTTOM, TOP, ROWS)
    )
    points = np.column_stack([x.ravel(), y.ravel(), 95.0 - (x.ravel() / 12.0) ** 2])
    index = np.arange(COLUMNS * ROWS).reshape(ROWS, COLUMNS)
    a, b, c, d = (
        corner.ravel()
        for corner in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    )
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    head = head_from_mesh(points, triangles, name="patch")
    return rig_from_head(head, parameters=TissueParameters())
