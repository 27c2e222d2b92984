"""Labelled clips in a folder: made side by side, to the bit the same, and taken up again.

DIR/dataset.json      what all of it follows from
DIR/manifest.jsonl    a line of JSON a clip, in order of number
DIR/000042.glb        its face, moving
DIR/000042.csv        its ground truth, a line a frame
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from pathlib import Path
from typing import Any

from engine import ENGINE_HASH, EngineError, builtin_rig, version

from .bodies import NewClip
from .commands import clip_timeline, how_told, live_model
from .dataset_plan import DatasetPlan
from .deriving import made_from
from .errors import Refused
from .idle import seed_of, with_life
from .render_process import Order, carry_out
from .rendering import Show, maps_of
from .side_by_side import side_by_side

PLAN, MANIFEST = "dataset.json", "manifest.jsonl"
_HALF = re.compile(r"\d{6,}\.(glb|csv)\.\d+")
"""What a process that was killed leaves of a file."""
_FILES = ("glb", "csv")
Line = Mapping[str, Any]


class DatasetRefused(Exception):
    """A data set that cannot be made; the message is one sentence."""


def make_dataset(
    folder: Path, plan: DatasetPlan, *, count: int, jobs: int, show: Show
) -> tuple[int, list[str]]:
    """Make the clips of a data set that are not there yet.

    Args:
        folder: Where; it is made if it is not there.
        plan: What they follow from.
        count: How many there are to be.
        jobs: How many are made at a time, each in a process of its own.
        show: Told what is being done, and the share of the work done.

    Returns:
        How many were made, and a sentence about each that could not be: the next call tries again.

    Raises:
        DatasetRefused: If the folder holds something else, or cannot be written.
    """
    try:
        for name in plan.people:
            builtin_rig(name)
        _begin(folder, plan)
        show("looking at what is there", 0.0)
        lines = {line["number"]: line for line in _whole(folder)}
        before = len(lines)
        _write_manifest(folder, lines.values())
        missing = [number for number in range(count) if number not in lines]
        failed: list[str] = []
        # Those of one person together: to build a face takes longer than to have it play.
        missing.sort(key=lambda number: (repr(plan.person(number)), number))
        work = [(folder, plan, number) for number in missing]
        with (folder / MANIFEST).open("a", encoding="utf-8") as manifest:
            for done, (index, made) in enumerate(side_by_side(_make, work, jobs=jobs)):
                if isinstance(made, BrokenProcessPool):
                    failed.append(f"clip {missing[index]}: a process ended; try fewer --jobs")
                    break  # The others ended with it.
                if isinstance(made, str):
                    failed.append(f"clip {missing[index]}: {made}")
                else:
                    lines[made["number"]] = made
                    manifest.write(_text(made))
                    manifest.flush()
                show(f"clip {len(lines)} of {count}", (done + 1) / len(missing))
        _write_manifest(folder, lines.values())
    except OSError as error:
        raise DatasetRefused(f"{folder} cannot be written: {error.strerror}.") from error
    except EngineError as error:
        raise DatasetRefused(f"The data set cannot be made: {error}.") from error
    return len(lines) - before, failed


def _begin(folder: Path, plan: DatasetPlan) -> None:
    """Write down what a data set follows from, or check that it is the same.

    Raises:
        DatasetRefused: If it is not, or the folder holds something else.
    """
    folder.mkdir(exist_ok=True)
    path, asked = folder / PLAN, plan.to_json()
    if path.is_file():
        try:
            there = json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise DatasetRefused(f"{path} is not what a data set follows from: {error}.") from error
        other = [name for name in asked if not _same(there, name, asked)]
        if other:
            raise DatasetRefused(
                f"{folder} was begun with another {' and '.join(other)}; "
                "go on with the same, or make a new one in another folder."
            )
        return
    if any(folder.iterdir()):
        raise DatasetRefused(f"{folder} is not empty and holds no data set; name another folder.")
    _write(path, json.dumps(asked, indent=2) + "\n")


def _same(there: object, name: str, asked: Mapping[str, Any]) -> bool:
    return isinstance(there, Mapping) and there.get(name) == asked[name]


def _whole(folder: Path) -> Iterator[Line]:
    """Yield the lines of clips whose files are there as they were written; tidy up the others."""
    for path in folder.iterdir():
        if _HALF.fullmatch(path.name):
            path.unlink(missing_ok=True)
    with suppress(FileNotFoundError):
        for text in (folder / MANIFEST).read_text(encoding="utf-8").splitlines():
            with suppress(ValueError, KeyError, TypeError):  # The last line may be cut short.
                line = json.loads(text)
                if all(line[f"{kind}_sha256"] == _digest(folder / line[kind]) for kind in _FILES):
                    yield line


def _make(work: tuple[Path, DatasetPlan, int]) -> Line | str:
    """Make a clip and return its line, or why it cannot be made."""
    folder, plan, number = work
    try:
        return _made(folder, plan, number)
    except (EngineError, Refused) as error:
        return f"{error}"


def _made(folder: Path, plan: DatasetPlan, number: int) -> Line:
    person = plan.person(number)
    rig = made_from(person.root, person.steps)
    shown = plan.shown(number, rig)
    clip = NewClip.model_validate({**shown.clip, "rig": person.root})
    timeline, _ = clip_timeline(clip, rig)
    paths = {kind: folder / f"{number:06d}.{kind}" for kind in _FILES}
    order = Order(
        root=person.root,
        steps=person.steps,
        timeline=with_life(timeline, clip, rig),
        fps=clip.fps,
        model=live_model(clip.model, rig),
        start=clip.start,
        level=clip.level,
        textures=maps_of(rig, _nobody) if clip.textures else {},
        glb=paths["glb"],
        csv=paths["csv"],
        seed=seed_of(clip),
        **how_told(clip),
    )
    figures = carry_out(order, lambda _share: None)
    return {
        "number": number,
        "seed": plan.seed,
        "rig": rig.id,
        "person": None if person.steps else person.root,
        "recipe": rig.recipe.to_json() if rig.recipe else None,
        **shown.label,
        "idle_seed": order.seed,
        "fps": clip.fps,
        "frames": figures["frames"],
        "level": clip.level,
        "version": version(),
        "engine": ENGINE_HASH,
        **{kind: path.name for kind, path in paths.items()},
        **{f"{kind}_sha256": _digest(path) for kind, path in paths.items()},
    }


def _nobody(_stage: str, _share: float) -> None:
    """Tell nobody what is being done."""


def _write_manifest(folder: Path, lines: Iterable[Line]) -> None:
    ordered = sorted(lines, key=lambda line: line["number"])
    _write(folder / MANIFEST, "".join(map(_text, ordered)))


def _text(line: Line) -> str:
    return json.dumps(line, allow_nan=False) + "\n"


def _write(path: Path, text: str) -> None:
    """Write a file that is there as a whole or not at all."""
    part = path.with_name(f"{path.name}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


def _digest(path: Path) -> str:
    """Return the SHA-256 of a file; of one that is not there, nothing's."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except FileNotFoundError:
        return ""
