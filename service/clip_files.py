"""Files made clips: one, or many side by side in processes, for the command line."""

from __future__ import annotations

import glob
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from engine import CLIP_FORMS, LEVELS, EngineError, TrackOptions, TrackReport

from .clip_sheet import draw_clip
from .playing_again import is_clip, render_again
from .rendering import ClipRefused, Show, render_by_service, render_file, truth_of
from .side_by_side import side_by_side
from .track_rendering import SUFFIXES, is_track, render_track_file
from .track_sending import render_track_by_service

_TIMELINE = ".json"
_TRUTH = ".truth.csv"
_PATTERN = "*?["


@dataclass(frozen=True)
class Wanted:
    """How files are made clips: what is the same for each of them.

    Attributes:
        rig: Overrides that of a timeline; a tracker's file plays on the standard rig without it.
        fps: Overrides a timeline's frame rate.
        textured: Whether files embed the maps of skin and eyes.
        csv: Whether ground truth is written beside each.
        png: Whether a contact sheet is drawn beside each.
        url, key: A service that renders them; empty renders here.
        options: How trackers' files are read.
        told: How files tell the motion, where that was said: form, tolerance, level and so on.
    """

    rig: str | None = None
    fps: int | None = None
    textured: bool = True
    csv: bool = False
    png: bool = False
    url: str = ""
    key: str = ""
    options: TrackOptions = field(default_factory=TrackOptions)
    told: Mapping[str, Any] = field(default_factory=dict)

    def common(self) -> dict[str, Any]:
        """Return what timelines and trackers' files are rendered with alike, here or elsewhere."""
        return {
            "rig": self.rig,
            "fps": self.fps,
            "textured": self.textured,
            "told": self.told,
        }


@dataclass(frozen=True)
class Rendered:
    """What became of a file: lines about it, its figures, and of a tracker's, that of its rows."""

    line: str
    figures: Mapping[str, Any]
    report: TrackReport | None = None

    def to_json(self) -> dict[str, Any]:
        """Return it as plain data: the report of a tracker's file, and the figures of its clip."""
        rows = {} if self.report is None else self.report.to_json()
        return {**rows, "clip": dict(self.figures)}


def how_told(
    form: str | None,
    tolerance: float | None,
    quantize: bool | None,
    sparse: bool | None,
    level: str | None,
) -> dict[str, Any]:
    """Return what was said of how files tell the motion, by field of a timeline.

    Raises:
        ClipRefused: For a form or a level that there is not.
    """
    for name, value, known in (("form", form, CLIP_FORMS), ("level", level, LEVELS)):
        if value is not None and value not in known:
            raise ClipRefused(f"--{name} is {value!r}; expected one of {', '.join(known)}.")
    said = {
        "form": form,
        "tolerance": tolerance,
        "quantize": quantize,
        "sparse": sparse,
        "level": level,
    }
    return {name: value for name, value in said.items() if value is not None}


def render_one(source: Path, output: Path, wanted: Wanted, show: Show) -> Rendered:
    """Render a timeline, a tracker's file or a clip to a GLB file.

    Args:
        source: Told apart by name.
        output: GLB file to write.
        wanted: How.
        show: Told what is being done, and the share of the work done.

    Raises:
        ClipRefused: If the file cannot be read, played or written.
    """
    truth = truth_of(output) if wanted.csv else None
    if wanted.url:
        return _by_service(source, output, wanted, show)
    report: TrackReport | None = None
    if is_clip(source):
        if wanted.rig is not None or wanted.fps is not None:
            raise ClipRefused("A clip is rendered again as it is: leave --rig and --fps out.")
        if wanted.told:
            named = " and ".join(f"--{name}" for name in wanted.told)
            raise ClipRefused(f"A clip is rendered again as it is: leave {named} out.")
        if source.resolve() == output.resolve():
            raise ClipRefused(f"{source} would be written over; name another file with -o.")
        made = render_again(source, output, show=show, csv=truth)
    elif is_track(source):
        made, report = render_track_file(
            source, output, options=wanted.options, show=show, csv=truth, **wanted.common()
        )
    else:
        made = render_file(source, output, show=show, csv=truth, **wanted.common())
    line = made.line
    if wanted.png:
        picture = output.with_suffix(".png")
        draw_clip(output, picture, show)
        line += f"\n{picture}: its frames, drawn"
    return Rendered(line, made.figures, report)


def _by_service(source: Path, output: Path, wanted: Wanted, show: Show) -> Rendered:
    if is_clip(source):
        raise ClipRefused("A clip is rendered here: leave --url out.")
    if wanted.csv or wanted.png:
        raise ClipRefused("Ground truth and pictures are made here: leave --url out.")
    where = {"url": wanted.url, "key": wanted.key, "show": show, **wanted.common()}
    if is_track(source):
        made, report = render_track_by_service(source, output, options=wanted.options, **where)
        return Rendered(made.line, made.figures, report)
    made = render_by_service(source, output, **where)
    return Rendered(made.line, made.figures)


def files_of(given: Sequence[Path]) -> list[Path]:
    """Return the files that files, folders and patterns name, each once.

    Of a folder these are its timelines and trackers' files, in order of name; ground truth that
    was written there before is none.

    Raises:
        ClipRefused: If one names none.
    """
    found: dict[Path, None] = {}
    for path in given:
        named = _named(path)
        if not named:
            kinds = ", ".join((_TIMELINE, *SUFFIXES))
            raise ClipRefused(f"{path} names no file; expected timelines or tracks: {kinds}.")
        found.update(dict.fromkeys(named))
    return list(found)


def _named(path: Path) -> list[Path]:
    if path.is_dir():
        suffixes = (_TIMELINE, *SUFFIXES)
        return sorted(
            file
            for file in path.iterdir()
            if file.suffix.lower() in suffixes and not file.name.endswith(_TRUTH)
        )
    if not path.exists() and any(sign in str(path) for sign in _PATTERN):
        return [Path(name) for name in sorted(glob.glob(str(path), recursive=True))]
    return [path]


def outputs_of(sources: Sequence[Path], folder: Path) -> list[Path]:
    """Return the GLB file of each source in a folder, which is made if it is not there.

    Raises:
        ClipRefused: If two would be one, or the folder cannot be made.
    """
    outputs = [folder / f"{source.stem}.glb" for source in sources]
    for index, output in enumerate(outputs):
        first = outputs.index(output)
        if first != index:
            raise ClipRefused(
                f"{sources[first]} and {sources[index]} would both be {output}; rename one."
            )
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ClipRefused(f"The folder {folder} cannot be made: {error.strerror}.") from error
    return outputs


def render_many(
    sources: Sequence[Path], outputs: Sequence[Path], wanted: Wanted, *, jobs: int
) -> Iterator[tuple[int, Rendered | ClipRefused]]:
    """Render files side by side, and yield the number of each and what became of it, once done.

    Args:
        sources: As `render_one` takes them.
        outputs: A GLB file for each.
        wanted: How.
        jobs: How many at a time, each in a process of its own.
    """
    work = [(*pair, wanted) for pair in zip(sources, outputs, strict=True)]
    for number, rendered in side_by_side(_render, work, jobs=jobs):
        if isinstance(rendered, BrokenProcessPool):
            message = f"{sources[number]} cannot be rendered: its process ended, for want of memory"
            yield number, ClipRefused(f"{message} perhaps; try fewer --jobs.")
        else:
            yield number, rendered


def _render(work: tuple[Path, Path, Wanted]) -> Rendered | ClipRefused:
    try:
        return render_one(*work, show=lambda _stage, _share: None)
    except ClipRefused as refused:
        return refused
    except EngineError as error:
        return ClipRefused(f"{work[0]} cannot be rendered: {error}.")
