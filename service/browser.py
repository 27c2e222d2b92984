"""Headless Chromium, for pictures of what the viewer draws."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

# WebGL in software: slow and the same everywhere. The rest keeps Chromium off the network.
FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
_SYSTEM_NAMES = ("chromium", "chromium-browser", "google-chrome")


class NoBrowser(RuntimeError):
    """Chromium, or Playwright, is not installed; the message says how to get it."""


@contextmanager
def chromium() -> Iterator[Browser]:
    """Start the system's Chromium, else Playwright's own.

    Raises:
        NoBrowser: If there is none.
    """
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError as error:
        raise NoBrowser("Playwright is not installed: pip install 'risorius[sheet]'.") from error
    system = next(filter(None, map(shutil.which, _SYSTEM_NAMES)), None)
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(executable_path=system, args=list(FLAGS))
        except Error as error:
            raise NoBrowser(
                "Chromium does not start: install it with `apt install chromium` or "
                "`playwright install chromium`."
            ) from error
        try:
            yield browser
        finally:
            browser.close()
