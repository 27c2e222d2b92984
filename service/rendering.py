"""Rendering a timeline file to a GLB file, here or by a service, for the command line."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from engine import EngineError, Rig, builtin_rig, textures_of

from .bodies import NewClip
from .commands import clip_timeline, how_told, live_model
from .errors import Refused
from .explaining import explain
from .idle import seed_of, with_life
from .render_process import SIMULATION_SHARE, Order, carry_out

Show = Callable[[str, float], None]


@dataclass(frozen=True)
class Outcome:
    """What became of a file: lines about it, and its figures as the service reports them."""

    line: str
    figures: Mapping[str, Any]


class ClipRefused(Exception):
    """A file that cannot be rendered; the message is one sentence."""


def render_file(
    source: Path,
    output: Path,
    *,
    rig: str | None,
    fps: int | None,
    show: Show,
    textured: bool = True,
    csv: Path | None = None,
    told: Mapping[str, Any] | None = None,
) -> Outcome:
    """Render `source` to `output` and return what became of it.

    Args:
        source: A timeline as `POST /api/clips` takes it.
        output: GLB file to write.
        rig: Overrides the file's rig.
        fps: Overrides the file's frame rate.
        show: Told what is being done, and the share of the work done.
        textured: Whether the file embeds the maps of skin and eyes, unless the timeline says no.
        csv: File for its ground truth, if wanted.
        told: Overrides how the file tells the motion, by field of the timeline.

    Raises:
        ClipRefused: If the file cannot be read, played or written.
    """
    check_folder(output)
    clip = _read(source)
    update = {"rig": rig or clip.rig, "fps": fps or clip.fps, **(told or {})}
    clip = clip.model_copy(update=update)
    try:
        show("building the rig", 0.0)
        chosen = builtin_rig(clip.rig)
        timeline, warnings = clip_timeline(clip, chosen)
        timeline = with_life(timeline, clip, chosen)
        model = live_model(clip.model, chosen)
    except (EngineError, Refused) as error:
        raise ClipRefused(f"{source} cannot be rendered: {error}.") from error
    order = Order(
        root=clip.rig,
        steps=(),
        timeline=timeline,
        fps=clip.fps,
        model=model,
        start=clip.start,
        level=clip.level,
        textures=maps_of(chosen, show) if textured and clip.textures else {},
        glb=output,
        csv=csv,
        seed=seed_of(clip),
        **how_told(clip),
    )
    made = written(order, source, show)
    return Outcome("\n".join([made.line, *warnings]), {**made.figures, "warnings": warnings})


def maps_of(rig: Rig, show: Show) -> Mapping[str, bytes]:
    """Return the maps of skin and eyes that a file of `rig` embeds, baked if nobody has."""
    show("baking the textures", 0.0)
    return textures_of(rig)


def written(order: Order, source: Path, show: Show) -> Outcome:
    """Carry out `order` here, and return what became of it.

    Args:
        order: What to render, and where to.
        source: The file that it comes from.
        show: Told what is being done, and the share of the work done.

    Raises:
        ClipRefused: If it cannot be played or written.
    """

    def told(share: float) -> None:
        show("simulating" if share < SIMULATION_SHARE else "writing", share)

    try:
        figures = carry_out(order, told)
    except EngineError as error:
        raise ClipRefused(f"{source} cannot be rendered: {error}.") from error
    except OSError as error:
        raise ClipRefused(f"{order.glb} cannot be written: {error.strerror}.") from error
    show("done", 1.0)
    seconds = figures["simulation_seconds"] + figures["writing_seconds"]
    line = (
        f"{order.glb}: {figures['frames']} frames, {figures['duration']:g} s, "
        f"{figures['bytes'] / 1e6:.1f} MB, in {seconds:.1f} s"
    )
    return Outcome(line, figures)


def render_by_service(
    source: Path,
    output: Path,
    *,
    url: str,
    key: str,
    rig: str | None,
    fps: int | None,
    show: Show,
    textured: bool = True,
    told: Mapping[str, Any] | None = None,
) -> Outcome:
    """Have a running service render `source`, save its file, and return what became of it.

    Args:
        source: A timeline as `POST /api/clips` takes it.
        output: GLB file to write.
        url: Where the service is.
        key: One of its keys, if it has any.
        rig: Overrides the file's rig.
        fps: Overrides the file's frame rate.
        show: Told what is being done, and the share of the work done.
        textured: Whether the file embeds the maps of skin and eyes, unless the timeline says no.
        told: Overrides how the file tells the motion, by field of the timeline.

    Raises:
        ClipRefused: If the file cannot be read, played or written, or there is no such service.
    """
    from .client import Client, ServiceError

    check_folder(output)
    clip = _read(source).model_dump(mode="json", exclude_unset=True)
    clip |= {name: value for name, value in (("rig", rig), ("fps", fps)) if value is not None}
    clip |= dict(told or {})
    clip |= {} if textured else {"textures": False}
    try:
        with Client(url, key=key) as client:
            show(f"rendering at {url}", 0.0)
            report = client.save_clip(
                clip, output, show=lambda share: show(f"rendering at {url}", share)
            )
    except ServiceError as error:
        raise ClipRefused(f"{source} cannot be rendered: {error}.") from error
    except OSError as error:
        raise ClipRefused(f"{output} cannot be written: {error.strerror}.") from error
    line = (
        f"{output}: {report['frames']} frames, {report['duration']:g} s, "
        f"{report['bytes'] / 1e6:.1f} MB, by {url}"
    )
    return Outcome("\n".join([line, *report["warnings"]]), report)


def check_folder(output: Path) -> None:
    """Refuse a file in a folder that is not there.

    Raises:
        ClipRefused: If it is not.
    """
    if not output.parent.is_dir():
        raise ClipRefused(f"The folder {output.parent} does not exist; make it first.")


def truth_of(output: Path) -> Path:
    """Return the file of a clip's ground truth, beside it: its source may be called laugh.csv."""
    return output.with_suffix(".truth.csv")


def _read(source: Path) -> NewClip:
    """Read a timeline file.

    Raises:
        ClipRefused: If it is not one.
    """
    try:
        data = json.loads(source.read_text(encoding="utf-8"))
        return NewClip.model_validate(data)
    except OSError as error:
        raise ClipRefused(f"{source} cannot be read: {error.strerror}.") from error
    except ValidationError as error:
        raise ClipRefused(
            f"{source} is not a timeline: {explain(list(error.errors()), data)}."
        ) from error
    except (ValueError, RecursionError) as error:
        raise ClipRefused(f"{source} is not a JSON file: {error}.") from error
