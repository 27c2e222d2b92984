"""axe finds no serious fault: every tab, bright and dark, on a desk and on a phone."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser
AXE = Path(__file__).parents[2] / "static" / "node_modules" / "axe-core" / "axe.min.js"
TABS = ("Action units", "Person", "Pose", "Muscles", "Tissue", "Inside")


def faults(page: playwright_api.Page, where: str) -> list[str]:
    """Return what axe calls serious or critical, each with its place."""
    found = page.evaluate("() => axe.run(document, {resultTypes: ['violations']})")
    return [
        f"{where}: {fault['id']} at {node['target']}: {node['failureSummary']}"
        for fault in found["violations"]
        if fault["impact"] in ("serious", "critical")
        for node in fault["nodes"]
    ]


@pytest.mark.parametrize("scheme", ["dark", "light"])
@pytest.mark.parametrize("size", [(1200, 800), (390, 844)], ids=["desk", "phone"])
def test_axe_finds_no_serious_fault(
    page: playwright_api.Page, url: str, scheme: str, size: tuple[int, int]
) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed: run `npm ci` in static/")
    page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.goto(f"{url}/?idle=0&level=low&dpr=0.3&draw=sketch")
    settle(page)
    page.add_script_tag(path=AXE)
    found: list[str] = []
    page.get_by_role("button", name="Happiness").click()
    page.get_by_role("button", name="Key", exact=True).click()
    for tab in TABS:
        page.get_by_role("tab", name=tab).click()
        found += faults(page, tab)
    tabs = page.get_by_role("tablist", name="Controls")
    assert tabs.evaluate("tabs => tabs.clientHeight >= tabs.scrollHeight"), "the tabs are cut off"
    page.get_by_role("button", name="Plane").click()
    page.get_by_role("button", name="Light and stage").click()
    found += faults(page, "light and stage")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Share").click()
    found += faults(page, "share")
    page.keyboard.press("Escape")
    if size[0] < size[1]:  # And the phone on its side: nothing lies over anything else.
        page.set_viewport_size({"width": size[1], "height": size[0]})
        page.get_by_role("button", name="Faces").click()
        page.get_by_role("button", name="Surprise").click(trial=True)
        page.get_by_role("tab", name="Inside").click(trial=True)
        page.set_viewport_size({"width": size[0], "height": size[1]})
    page.keyboard.press("?")
    found += faults(page, "keys")
    assert found == []
