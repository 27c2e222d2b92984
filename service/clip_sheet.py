"""A contact sheet of a clip: its frames at even distances, as the viewer draws them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine import Clip, EngineError, Frame, performance_of, record

from .browser import NoBrowser
from .deriving import made_from
from .errors import Refused
from .rendering import ClipRefused, Show
from .stage import CallRefused, Look
from .studio import NoViewer, studio

PICTURES = 12
COLUMNS = 6
SIZE = 240
_VIEW = "three-quarter"


def draw_clip(source: Path, output: Path, show: Show) -> None:
    """Play a clip's file again and draw its frames.

    Args:
        source: A GLB file that `clip` or the service made.
        output: PNG file to write.
        show: Told what is being done, and the share of the work done.

    Raises:
        ClipRefused: If it cannot be played or drawn.
    """
    from .sheet import tile

    show("drawing its frames", 0.0)
    try:
        played = performance_of(source.read_bytes())
        root, steps = played.rig["root"], played.rig["steps"]
        rig = made_from(root, steps)
        clip = record(rig, played.timeline, fps=played.fps, model=played.model).after(played.start)
        with studio() as stage:
            stage.enter(stage.derive(root, steps))
            pictures = []
            for number, index in enumerate(moments(len(clip))):
                show("drawing its frames", number / PICTURES)
                png = stage.photograph(frame_of(clip, index), rig.jaw, Look(_VIEW, SIZE))
                pictures.append((f"{index / clip.fps:.2f} s", png))
        tile(pictures, columns=COLUMNS, size=SIZE).save(output)
    except (EngineError, Refused, NoBrowser, NoViewer, CallRefused) as error:
        message = str(error).removesuffix(".")
        raise ClipRefused(f"The frames of {source} cannot be drawn: {message}.") from error
    except OSError as error:
        raise ClipRefused(f"{output} cannot be written: {error.strerror}.") from error


def moments(frames: int) -> list[int]:
    """Return the frames that a sheet shows: the first, the last, and some at even distances."""
    return sorted({round(index) for index in np.linspace(0, frames - 1, PICTURES).tolist()})


def frame_of(clip: Clip, index: int) -> Frame:
    """Return a frame of a clip as a face at that moment."""
    return Frame(
        tick=index,
        displacements=clip.displacements[index].astype(np.float64),
        activations=clip.activations[index].astype(np.float64),
        pose=clip.poses[index],
        asleep=False,
        diverged=False,
    )
