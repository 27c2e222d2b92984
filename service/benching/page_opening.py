"""How long a visitor waits for the face: the viewer's page in headless Chromium, part by part.

Each time in a context of its own, so that nothing is cached, on a service that is warm. What waits
and what works is told apart: beside the times stands what Chromium's processes have computed.
"""

from __future__ import annotations

import os
import statistics
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..browser import NoBrowser, chromium
from ..settings import Settings
from ..soak_client import own_service
from ..stage import NOT_BUILT

if TYPE_CHECKING:
    from playwright.sync_api import Browser

MOMENTS = ("script", "stage", "session", "hello", "surface", "first-frame", "complete")
"""In order: what the page marks on its way."""
_SIZE = (1280, 800)
_TIMEOUT_MS = 240_000
_MARKS = """() => Object.fromEntries(performance.getEntriesByType('mark')
    .filter(({name}) => name.startsWith('risorius.'))
    .map(({name, startTime}) => [name.slice(9), startTime]))"""


def measure_page_opening(*, pages: int) -> dict[str, Any]:
    """Return when each moment was, counted from navigation [ms]; the median page of some.

    Args:
        pages: How many are opened, after one that does not count.

    Raises:
        SoakRefused: If the service does not start.
    """
    if not (Settings().viewer_dir / "index.html").is_file():
        return {"unavailable": NOT_BUILT}
    try:
        with chromium() as browser, own_service() as url:
            opened = [_opened(browser, url) for _ in range(pages + 1)][1:]
    except NoBrowser as missing:
        return {"unavailable": str(missing)}
    return {
        "pages": pages,
        "milliseconds": {
            moment: round(statistics.median(page[moment] for page in opened)) for moment in MOMENTS
        },
        "processor_seconds": round(statistics.median(page["processor"] for page in opened), 2),
    }


def _opened(browser: Browser, url: str) -> dict[str, float]:
    """Return the moments of one page, and the processor time until its first frame [s]."""
    wide, high = _SIZE
    before = _processor_seconds()
    context = browser.new_context(viewport={"width": wide, "height": high})
    try:
        page = context.new_page()
        page.set_default_timeout(_TIMEOUT_MS)
        page.goto(f"{url.rstrip('/')}/?idle=0", wait_until="commit")
        page.wait_for_function("() => performance.getEntriesByName('risorius.first-frame').length")
        processor = _processor_seconds() - before
        page.wait_for_function("() => performance.getEntriesByName('risorius.complete').length")
        moments: dict[str, float] = page.evaluate(_MARKS)
    finally:
        context.close()
    return {**moments, "processor": processor}


def _processor_seconds() -> float:
    """Return what the processes under this one have computed so far; 0 where nobody tells."""
    parents: dict[int, tuple[int, float]] = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        ticks = int(fields[11]) + int(fields[12])
        parents[int(folder.name)] = (int(fields[1]), ticks / os.sysconf("SC_CLK_TCK"))
    total = 0.0
    for process, (_, seconds) in parents.items():
        above = parents[process][0]
        while above in parents and above != os.getpid():
            above = parents[above][0]
        total += seconds if above == os.getpid() else 0.0
    return total
