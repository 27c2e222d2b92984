"""Contact sheets: people, action units and emotions, as the viewer draws them, on one picture."""

from __future__ import annotations

import io
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image, ImageDraw, ImageFont

from engine import UnknownName, resolve_label

from .app import create_app
from .browser import NoBrowser, chromium
from .server import running
from .settings import Settings
from .sheet_edits import Edit
from .stage import ABOVE, CLOSE_UPS, NOT_BUILT, ROOM, TIMEOUT_MS, VIEWS, CallRefused, call

if TYPE_CHECKING:
    from playwright.sync_api import FloatRect, Page

Show = Callable[[str, float], None]
PICTURES = (".png", ".jpg", ".jpeg", ".webp")
_LABEL_SHARE = 0.09
_NO_LIMIT = 1000.0
"""Share of a tick that faces may take: nobody watches these live."""
_BACKGROUND = (24, 25, 28)
_INK = (226, 226, 222)
_QUALITY = 88
"""Of JPEG and WebP pictures."""
_COLORS = 256
"""Of pictures that are cut out, as many as a palette holds."""
_SETTLED = """t => window.__viewer.ready && window.__viewer.textured !== false
    && window.__viewer.asleep && window.__viewer.tick > t"""


class SheetRefused(Exception):
    """A sheet that cannot be drawn; the message is one sentence."""


@dataclass(frozen=True)
class Pose:
    """One picture: its label, and what is asked of the face.

    Attributes:
        label: Written under the picture.
        controls: Body of a PUT to the puppet layer.
        emotion: Label of an emotion instead.
        intensity: Of the emotion.
    """

    label: str
    controls: dict[str, Any]
    emotion: str | None = None
    intensity: float = 1.0


@dataclass(frozen=True)
class Plan:
    """What a sheet shows: each rig in each pose from each view.

    Attributes:
        rigs: Names or ids; empty for all the people that come with the service.
        views: Of `VIEWS`, or degrees to the side such as "25" and "-50".
        only: Labels of the poses; all when empty.
        size: Side of a picture [pixels].
        whole: Show the head with its hair and neck, not the face alone.
        cut_out: Leave the ground out, as PNG in a folder: whatever lies behind a picture is seen.
        edits: Each shown on a rig derived from every one of `rigs`, after the rig itself.
    """

    rigs: Sequence[str]
    views: Sequence[str]
    only: Sequence[str]
    size: int
    whole: bool = False
    cut_out: bool = False
    edits: Sequence[Edit] = ()


def draw_sheet(output: Path, plan: Plan, *, columns: int, show: Show) -> int:
    """Write the sheet and return how many pictures it has.

    Args:
        output: A file of one of `PICTURES`, or a folder that takes a file for each picture.
        plan: What to draw.
        columns: Pictures in a row.
        show: Told what is being done, and the share of the work done.

    Raises:
        SheetRefused: If the viewer or Chromium is missing, or a name is not known.
    """
    for view in plan.views:
        if view not in VIEWS and not re.fullmatch(r"-?\d{1,3}", view):
            raise SheetRefused(
                f"There is no view {view!r}; it is one of {', '.join(VIEWS)}, or degrees."
            )
    if not output.is_dir() and output.suffix.lower() not in PICTURES:
        raise SheetRefused(f"{output} is no folder, and no file of {', '.join(PICTURES)}.")
    if not output.resolve().parent.is_dir():
        raise SheetRefused(f"The folder {output.parent} does not exist; make it first.")
    if not (Settings().viewer_dir / "index.html").is_file():
        raise SheetRefused(NOT_BUILT)
    with tempfile.TemporaryDirectory(prefix="risorius-sheet-") as folder:
        settings = Settings(
            data_dir=Path(folder), host="127.0.0.1", api_keys=(), capacity_share=_NO_LIMIT
        )
        try:
            with running(create_app(settings), settings) as url, chromium() as browser:
                side = plan.size if plan.whole else round(plan.size * ROOM)
                page = browser.new_page(viewport={"width": side, "height": side})
                pictures = list(_photograph(page, url, plan, show))
        except NoBrowser as error:
            raise SheetRefused(str(error)) from error
        except CallRefused as error:
            raise SheetRefused(f"This cannot be drawn: {error}.") from error
    if output.is_dir():
        for label, png in pictures:
            picture = Image.open(io.BytesIO(png)).resize((plan.size, plan.size))
            if plan.cut_out:
                picture.convert("RGBA").quantize(_COLORS).save(output / f"{_slug(label)}.png")
            else:
                picture.convert("RGB").save(output / f"{_slug(label)}.jpg", quality=_QUALITY)
    else:
        tile(pictures, columns=columns, size=plan.size).save(output, quality=_QUALITY)
    return len(pictures)


def _slug(label: str) -> str:
    """Return a label as the stem of a file's name."""
    spelled = re.sub(r" -(?=\d)", " minus ", label.lower())
    return re.sub(r"[^a-z0-9]+", "-", spelled).strip("-")


def tile(pictures: Sequence[tuple[str, bytes]], *, columns: int, size: int) -> Image.Image:
    """Return one picture of labelled pictures, row by row."""
    columns = min(columns, max(1, len(pictures)))
    label_height = max(14, round(size * _LABEL_SHARE))
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (columns * size, rows * (size + label_height)), _BACKGROUND)
    draw = ImageDraw.Draw(sheet)
    largest = round(label_height * 0.55)
    for index, (label, png) in enumerate(pictures):
        left, top = index % columns * size, index // columns * (size + label_height)
        sheet.paste(Image.open(io.BytesIO(png)).convert("RGB").resize((size, size)), (left, top))
        middle = (left + size / 2, top + size + label_height / 2)
        draw.text(middle, label, fill=_INK, font=_fitting(label, largest, size), anchor="mm")
    return sheet


def _fitting(label: str, largest: int, width: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """Return the greatest font, up to `largest`, in which `label` keeps within `width`, pixels."""
    for size in range(largest, 6, -1):
        font = ImageFont.load_default(size=size)
        if font.getlength(label) <= 0.94 * width:
            return font
    return ImageFont.load_default(size=6)


def poses_of(rig: dict[str, Any], only: Sequence[str]) -> list[Pose]:
    """Return the poses to draw: rest, each action unit at 1, each emotion; or those of `only`.

    Args:
        rig: What the API says of the rig.
        only: Names of units, FACS strings, labels of emotions, these also weakened:
            "happiness@0.4".
    """
    poses = {"rest": Pose("rest", {})}
    for unit in rig["action_units"]:
        label = f"{unit['name']} {unit['title']}"
        poses[unit["name"]] = Pose(label, {"action_units": {unit["name"]: 1.0}})
    for emotion in rig["emotions"]:
        label = f"{emotion['name']} {emotion['recipe']}"
        poses[emotion["name"]] = Pose(label, {}, emotion["name"])
    if not only:
        return list(poses.values())
    words = {word: emotion["name"] for emotion in rig["emotions"] for word in emotion["synonyms"]}
    return [_pose_of(name, poses, words) for name in only]


def _pose_of(name: str, poses: dict[str, Pose], words: dict[str, str]) -> Pose:
    asked, at, weakened = name.partition("@")
    pose = poses.get(words.get(asked, asked)) or _labelled(asked)
    if not at:
        return pose or Pose(name, {"facs": name})
    try:
        intensity = float(weakened)
    except ValueError:
        intensity = float("nan")
    if pose is None or pose.emotion is None or not 0.0 < intensity <= 1.0:
        raise SheetRefused(
            f"{name!r} is no emotion with an intensity above 0 and up to 1, such as happiness@0.4."
        )
    return replace(pose, label=f"{pose.emotion} {weakened}", intensity=intensity)


def _labelled(name: str) -> Pose | None:
    """Return the pose of a label of any vocabulary, None if there is none."""
    try:
        plays = resolve_label(name)
    except UnknownName:
        return None
    return Pose(f"{name} {plays.facs}", {}, name)


def _photograph(page: Page, url: str, plan: Plan, show: Show) -> Iterator[tuple[str, bytes]]:
    """Put each pose on each face, and take its pictures once it has settled."""
    page.set_default_timeout(TIMEOUT_MS)
    rigs = plan.rigs or _people(page, url)
    faces = [(rig, edit) for rig in rigs for edit in (None, *plan.edits)]
    for number, (rig, edit) in enumerate(faces):
        name = name_of(rig, edit, several=len(rigs) > 1)
        show(f"building {name}", number / len(faces))
        if edit is None:
            shown = call(page, "GET", f"{url}/api/rigs/{rig}")
        else:
            shown = call(page, "POST", f"{url}/api/rigs", {**edit.changes, "base": rig})
        poses = poses_of(shown, plan.only)
        session = call(page, "POST", f"{url}/api/sessions", {"rig": shown["id"]})["id"]
        ground = "&embed=1&level=high" if plan.cut_out else ""
        page.goto(f"{url}/?session={session}&bare=1&still=1&dpr=1{ground}")
        page.wait_for_function(_SETTLED, arg=-1)
        for index, pose in enumerate(poses):
            show(f"{name}: {pose.label}", (number + index / len(poses)) / len(faces))
            tick = _command(page, f"{url}/api/sessions/{session}", pose)
            page.wait_for_function(_SETTLED, arg=tick)
            for view in plan.views:
                page.evaluate("view => window.__viewer.setView(view)", view)
                page.evaluate("() => window.__viewer.render()")
                named = [name] * (len(faces) > 1) + [view] * (len(plan.views) > 1)
                if len(poses) > 1 or not named:
                    named.insert(len(faces) > 1, pose.label)
                whole = plan.whole or view in CLOSE_UPS
                label = (", " if plan.edits else " ").join(named)
                clip = _frame_of(_side(page), whole)
                yield label, page.screenshot(clip=clip, omit_background=plan.cut_out)
        call(page, "DELETE", f"{url}/api/sessions/{session}")


def name_of(rig: str, edit: Edit | None, *, several: bool) -> str:
    """Return what a sheet calls a face: the rig, or what was done to it, or both of several."""
    if edit is None:
        return rig
    return f"{rig}, {edit.label}" if several else edit.label


def _side(page: Page) -> float:
    return float((page.viewport_size or {"width": 0})["width"])


def _frame_of(side: float, whole: bool) -> FloatRect:
    """Return the part of a square page that is the picture: all, or from hairline to chin."""
    if whole:
        return {"x": 0.0, "y": 0.0, "width": side, "height": side}
    shown = side / ROOM
    return {"x": (side - shown) / 2.0, "y": ABOVE * side, "width": shown, "height": shown}


def _people(page: Page, url: str) -> list[str]:
    listed = call(page, "GET", f"{url}/api/people")
    return [person["name"] for person in listed["people"]]


def _command(page: Page, session: str, pose: Pose) -> int:
    """Ask the pose of the face, and return the tick of the command."""
    held = {"fade": 0.15}
    emptied = call(page, "PUT", f"{session}/controls", {**held, "layer": "emotion"})
    answer = call(page, "PUT", f"{session}/controls", {**held, **pose.controls})
    if pose.emotion is not None:
        body = {
            "label": pose.emotion,
            "fade_in": 0.15,
            "intensity": pose.intensity,
            "seed": 0,
        }
        answer = call(page, "POST", f"{session}/emotions", body)
    return int(max(emptied["tick"], answer["tick"]))
