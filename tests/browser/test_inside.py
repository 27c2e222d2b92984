"""The muscles drawn over the face."""

from __future__ import annotations

import io

import pytest
from PIL import Image, ImageChops
from playwright import sync_api as playwright_api
from viewer_page import settle

pytestmark = pytest.mark.browser


def redness(page: playwright_api.Page) -> float:
    """Return by how much red stands over blue in the middle of the face, 0 to 255."""
    page.evaluate("() => window.__viewer.render()")
    with Image.open(io.BytesIO(page.locator("#face").screenshot())) as taken:
        red, _, blue = taken.convert("RGB").split()
    wide, high = red.size
    middle = (int(0.4 * wide), int(0.3 * high), int(0.6 * wide), int(0.75 * high))
    difference = ImageChops.subtract(red, blue).crop(middle)
    shades = difference.histogram()
    return sum(shade * count for shade, count in enumerate(shades)) / sum(shades)


def test_muscles_are_seen_and_glow_as_they_contract(page: playwright_api.Page, url: str) -> None:
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(f"{url}/?idle=0&level=low&dpr=0.5")
    # A first sketch, as software draws it, has other colours.
    page.wait_for_function("() => window.__viewer?.textured")
    settle(page)
    bare = redness(page)
    page.get_by_role("button", name="Light and stage").click()
    switch = page.get_by_role("switch", name="Muscles")
    switch.click()
    playwright_api.expect(switch).to_be_checked()
    slack = redness(page)
    assert slack > bare + 5
    page.keyboard.press("Escape")
    tick = page.evaluate("() => window.__viewer.tick")
    page.get_by_role("button", name="Happiness").click()
    settle(page, tick)
    page.wait_for_timeout(600)
    assert redness(page) > slack + 2
    page.keyboard.press("m")
    hidden = page.get_by_role("switch", name="Muscles", include_hidden=True)
    playwright_api.expect(hidden).not_to_be_checked()
