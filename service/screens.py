"""Pictures of the viewer as people see it, in headless Chromium."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from .browser import NoBrowser
from .explaining import did_you_mean
from .scenes import SCENES, Scene
from .studio import NoViewer, visited_service

if TYPE_CHECKING:
    from playwright.sync_api import Browser

Show = Callable[[str, float], None]

_TIMEOUT_MS = 240_000
_SETTLING_MS = 1500
_QUALITY = 86
_SHARP = "&dpr=1"
"""Without a graphics processor a page draws what it can in time; a picture is waited for."""
_SHOWN = "() => window.__viewer?.ready && window.__viewer.textured !== false"


class ScreensRefused(Exception):
    """Pictures that cannot be taken; the message is one sentence."""


def photograph(folder: Path, names: Sequence[str], *, show: Show, jpeg: bool = False) -> int:
    """Take pictures of scenes, `NAME.png` each, and return how many.

    Args:
        folder: To write into; it is made.
        names: Of scenes; none takes all.
        show: Told what is being taken, and the share that is done.
        jpeg: Write `NAME.jpg`, a fifth as large.

    Raises:
        ScreensRefused: If a scene is unknown, a script of the page failed, or there is no browser,
            no built viewer or no such folder.
    """
    for name in names:
        if name not in SCENES:
            hint = did_you_mean(name, list(SCENES)) or "; there are " + ", ".join(SCENES)
            raise ScreensRefused(f"There is no scene {name!r}{hint}.")
    chosen = names or tuple(SCENES)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with visited_service() as (browser, url):
            for number, name in enumerate(chosen):
                show(name, number / len(chosen))
                _write(_taken(browser, url, name, SCENES[name]), folder / name, jpeg=jpeg)
    except (NoBrowser, NoViewer) as error:
        raise ScreensRefused(str(error)) from error
    except OSError as error:
        raise ScreensRefused(f"The folder {folder} cannot be written: {error}.") from error
    return len(chosen)


def _write(picture: bytes, place: Path, *, jpeg: bool) -> None:
    if not jpeg:
        place.with_suffix(".png").write_bytes(picture)
        return
    with Image.open(io.BytesIO(picture)) as taken:
        taken.convert("RGB").save(place.with_suffix(".jpg"), quality=_QUALITY)


def _taken(browser: Browser, url: str, name: str, scene: Scene) -> bytes:
    wide, high = scene.size
    page = browser.new_page(
        viewport={"width": wide, "height": high},
        color_scheme=scene.scheme,
        reduced_motion="reduce",
    )
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    try:
        page.set_default_timeout(_TIMEOUT_MS)
        viewer = scene.address.startswith("/?")
        page.goto(url + scene.address + (_SHARP if viewer else ""))
        if viewer:
            page.wait_for_function(_SHOWN)
        scene.play(page)
        page.wait_for_timeout(_SETTLING_MS)
        if viewer:
            page.wait_for_function("() => window.__viewer.asleep")
            page.evaluate("() => window.__viewer.render()")
            page.wait_for_timeout(_SETTLING_MS)
        picture = page.screenshot()
    finally:
        page.close()
    if errors:
        raise ScreensRefused(f"A script failed while {name} was drawn: {errors[0]}")
    return picture
