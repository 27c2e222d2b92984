"""A service of its own with a browser before it, for pictures; nobody else is served by it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .app import create_app
from .browser import chromium
from .server import running
from .settings import Settings
from .stage import NOT_BUILT, Stage

if TYPE_CHECKING:
    from playwright.sync_api import Browser

_NO_LIMIT = 1000.0
"""Share of a tick that faces may take: nobody watches these live."""
_LARGE = 2**30


class NoViewer(RuntimeError):
    """The viewer is not built; the message says how to."""


@contextmanager
def studio(*, cache_dir: Path | None = None, viewer_dir: Path | None = None) -> Iterator[Stage]:
    """Open a studio, with a stage in it; see `visited_service`."""
    with visited_service(cache_dir=cache_dir, viewer_dir=viewer_dir) as (browser, url):
        yield Stage(browser, url)


@contextmanager
def visited_service(
    *, cache_dir: Path | None = None, viewer_dir: Path | None = None
) -> Iterator[tuple[Browser, str]]:
    """Start a service and a browser, and yield the browser and the service's address.

    Args:
        cache_dir: Where files that can be made again are kept; the usual folder if None.
        viewer_dir: Of the built viewer; the usual one if None.

    Raises:
        NoBrowser: If there is no Chromium.
        NoViewer: If the viewer is not built.
    """
    folders = {"cache_dir": cache_dir, "viewer_dir": viewer_dir}
    given: dict[str, Any] = {name: each for name, each in folders.items() if each is not None}
    with tempfile.TemporaryDirectory(prefix="risorius-studio-") as data, chromium() as browser:
        settings = Settings(
            **given,
            data_dir=Path(data),
            database_url="",
            host="127.0.0.1",
            api_keys=(),
            capacity_share=_NO_LIMIT,
            simulation_threads=1,
            max_body_bytes=_LARGE,
            max_rigs=_LARGE,
        )
        if not (settings.viewer_dir / "index.html").is_file():
            raise NoViewer(NOT_BUILT)
        with running(create_app(settings), settings) as url:
            yield browser, url
