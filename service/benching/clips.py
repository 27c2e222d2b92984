"""What a clip costs and weighs: simulated, fitted and written, by length and by form."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from engine import (
    CLIP_FORMS,
    Model,
    Rig,
    Timeline,
    clip_file,
    random_mixes,
    record,
    settled_arkit,
    textures_of,
)

LENGTHS = (1.0, 10.0, 60.0, 300.0)
"""Seconds of the clips whose cost is compared."""
LEVEL, FPS = "medium", 30
"""Those of a clip of which nothing is said."""
_FORM_SECONDS = 10.0
_BETWEEN, _FADE, _SEED = 2.5, 0.3, 2001
"""Seconds from one expression to the next, and until it is reached."""


def measure_clips(rig: Rig, *, lengths: Sequence[float]) -> list[dict[str, Any]]:
    """Return a row for each length in the form "basis", then one of 10 s or less for each other.

    Seconds are those of the processor, all threads together. Each clip goes through a random mix
    of two to five action units every 2.5 s.

    Args:
        rig: Who performs.
        lengths: Of the clips [s].
    """
    drawn = rig.at_level(LEVEL)
    settled_arkit(drawn)  # Once a person, and kept.
    _row(drawn, "basis", 0.2)  # What is made once, such as the picture of a hair.
    rows = [_row(drawn, "basis", seconds) for seconds in lengths]
    others = [form for form in CLIP_FORMS if form != "basis"]
    return rows + [_row(drawn, form, min(_FORM_SECONDS, max(lengths))) for form in others]


def performance(rig: Rig, seconds: float) -> Timeline:
    """Return what is played: a new expression every 2.5 s."""
    count = int(seconds / _BETWEEN) + 1
    mixes = random_mixes(rig, count, _SEED)
    return Timeline(
        tuple(
            replace(mix, time=number * _BETWEEN, fade=_FADE, replace=True)
            for number, mix in enumerate(mixes)
        ),
        seconds,
    )


def _row(rig: Rig, form: str, seconds: float) -> dict[str, Any]:
    timeline, model = performance(rig, seconds), replace(Model.for_rig(rig), integrator="verlet")
    started = time.process_time()
    clip = record(rig, timeline, fps=FPS, model=model)
    simulated = time.process_time()
    file = clip_file(clip, form=form)
    written = time.process_time()
    # The clock's shares of the two, for the processor has no stop between them.
    whole = max(file.fit_seconds + file.write_seconds, 1e-9)
    fitting = (written - simulated) * file.fit_seconds / whole
    textured = clip_file(clip.after(seconds), form=form, textures=textures_of(rig))
    maps = len(textured.data) - len(clip_file(clip.after(seconds), form=form).data)
    return {
        "form": form,
        "seconds": seconds,
        "frames": len(clip),
        "targets": file.told.get("basis", len(clip) if form == "exact" else 52),
        "error_mm": file.told.get("max_error_mm", file.told.get("residual_mm")),
        "simulation_seconds": round(simulated - started, 3),
        "fit_seconds": round(fitting, 3),
        "write_seconds": round(written - simulated - fitting, 3),
        "seconds_a_second": round((written - started) / seconds, 4),
        "bytes": len(file.data),
        "bytes_with_textures": len(file.data) + maps,
    }
