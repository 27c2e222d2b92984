"""How idle life says what it does: keyframes of one owner in the lowest layer, at whole ticks."""

from __future__ import annotations

from collections.abc import Mapping

from ..timeline import TICKS_PER_SECOND, Keyframe

IDLE = "idle"
"""The owner of what idle life holds."""
LAYER = "idle"


def said(
    tick: int,
    over: int,
    *,
    units: Mapping[str, float] | None = None,
    gaze: Mapping[str, float] | None = None,
    head: Mapping[str, float] | None = None,
) -> Keyframe:
    """Return a keyframe that begins at `tick` and is reached `over` so many ticks."""
    return Keyframe(
        time=tick / TICKS_PER_SECOND,
        layer=LAYER,
        owner=IDLE,
        action_units=units or {},
        gaze=gaze or {},
        head=head or {},
        fade=over / TICKS_PER_SECOND,
    )
