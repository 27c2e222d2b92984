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


def compile_motion() -> None:
    """Compile or load the kernels that move tissue, jaw, lids and muscles, the longest first.

    On a patch of skin, in a process of its own: it takes as long as another needs to make the
    first head and do the rest (`warm_surface`).
    """
    bank = _bank(_patch())
    bank.advance()
    bank.pose()


def warm_surface(rig: Rig) -> None:
    """Assemble the tissue of a rig; compile or load all that `compile_motion` does not."""
    _bank(rig).look()
    mixer = Mixer(rig)
    mixer.apply(Keyframe(action_units={"AU12": 1.0}), 0)
    mixer.at(1)


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
