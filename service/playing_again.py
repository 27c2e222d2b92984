"""Rendering a clip's own GLB file again: what it says of itself is all that it takes."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

from engine import ENGINE_HASH, EngineError, Performance, performance_of

from .deriving import made_from
from .errors import Refused
from .render_process import Order
from .rendering import ClipRefused, Outcome, Show, check_folder, maps_of, written

SUFFIX = ".glb"
_MOST_BYTES = 2**30
"""Of a file that is read; ours are far below."""


def is_clip(source: Path) -> bool:
    """Return whether a file is a rendered clip, by its name."""
    return source.suffix.lower() == SUFFIX


def render_again(source: Path, output: Path, *, show: Show, csv: Path | None = None) -> Outcome:
    """Render a clip's file to `output` as it was made, and return what became of it.

    The same engine makes the same bytes; of another one it warns.

    Args:
        source: A GLB file that `clip` or the service made.
        output: GLB file to write.
        show: Told what is being done, and the share of the work done.
        csv: File for its ground truth, if wanted.

    Raises:
        ClipRefused: If the file is none of ours, or cannot be read, played or written.
    """
    check_folder(output)
    performance = _read(source)
    order = _order(source, performance, output, csv, show)
    made = written(order, source, show)
    if performance.engine == ENGINE_HASH:
        return made
    warning = (
        f"{source} was made by the engine of Risorius {performance.version},"
        f" {performance.engine[:12]}; this one, {ENGINE_HASH[:12]}, may make other bytes of it."
    )
    return Outcome(f"{made.line}\n{warning}", {**made.figures, "warnings": [warning]})


def _read(source: Path) -> Performance:
    try:
        if source.stat().st_size > _MOST_BYTES:
            raise ClipRefused(f"{source} is too large to be a clip; expected a GLB file of ours.")
        return performance_of(source.read_bytes())
    except OSError as error:
        raise ClipRefused(f"{source} cannot be read: {error.strerror}.") from error
    except EngineError as error:
        raise ClipRefused(f"{source} cannot be rendered again: {error}.") from error


def _order(
    source: Path, performance: Performance, output: Path, csv: Path | None, show: Show
) -> Order:
    rig, root = performance.rig, performance.rig["root"]
    if not isinstance(root, str):
        raise ClipRefused(f"{source} cannot be rendered again: it does not say whose face it is.")
    show("building the rig", 0.0)
    try:
        chosen = made_from(root, rig["steps"])
    except (EngineError, Refused) as error:
        raise ClipRefused(f"{source} cannot be rendered again: {error}.") from error
    asked = dict(performance.file)
    textured = bool(asked.pop("textures", False))
    known = {field.name for field in fields(Order)}
    return Order(
        root=root,
        steps=rig["steps"],
        timeline=performance.timeline,
        fps=performance.fps,
        model=performance.model,
        start=performance.start,
        level=performance.level,
        textures=maps_of(chosen, show) if textured else {},
        glb=output,
        csv=csv,
        seed=performance.seed,
        **{name: value for name, value in asked.items() if name in known},
    )
