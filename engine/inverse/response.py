"""How a rig's surface answers each muscle and the jaw, from rest: simulated once, and kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..cache import Arrays, cached_arrays, content_key
from ..channels import JAW
from ..rig import Model, Rig
from ..settling import Progress, settled
from ..sources import ENGINE_HASH
from ..timeline import TICKS_PER_SECOND, Keyframe

JAW_SCALE = {"pitch": 15.0, "yaw": 5.0, "thrust": 4.0}
"""Degrees and mm of jaw that count as much as a muscle's full activation."""
RESPONSE_STEP = 0.4
"""Activation, or share of `JAW_SCALE`, at which the response to each is taken."""
RESPONSE_TICKS = 42
"""Ticks that the faces are given to settle from rest."""


@dataclass(frozen=True, eq=False)
class Response:
    """What a rig's surface does as one channel moves from rest.

    Attributes:
        fields: Displacement over channel value, mm, shape (muscles + 3, s, 3): muscles in channel
            order, then the jaw's pitch, yaw and thrust.
    """

    fields: FloatArray


def response_of(
    rig: Rig,
    model: Model | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Response:
    """Return what the surface does as each muscle and the jaw move from rest; kept on disk.

    Args:
        rig: Whose.
        model: Forms of the physics; the rig's own, as live faces run them, if None.
        threads: Faces stepped at a time; None takes one a core.
        progress: Told the share of the work done, 0 to 1; may raise to stop it.
    """
    model = model or rig.model.live
    key = content_key(rig.id, model, RESPONSE_STEP, RESPONSE_TICKS, ENGINE_HASH)

    def build() -> Arrays:
        commands = [Keyframe(muscles={name: RESPONSE_STEP}) for name in rig.muscle_names]
        steps = [RESPONSE_STEP] * len(commands)
        for axis in JAW:
            steps.append(RESPONSE_STEP * JAW_SCALE[axis])
            commands.append(Keyframe(jaw={axis: steps[-1]}))
        seconds = RESPONSE_TICKS / TICKS_PER_SECOND
        ends = settled(rig, commands, seconds, model=model, threads=threads, progress=progress)
        fields = [end.displacements / step for end, step in zip(ends, steps, strict=True)]
        return {"fields": np.array(fields)}

    return Response(cached_arrays("response", key, build)["fields"].astype(np.float64))
